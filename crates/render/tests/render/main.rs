//! Light, and pictures that are the same on all paths.

mod light;
mod same_pictures;
