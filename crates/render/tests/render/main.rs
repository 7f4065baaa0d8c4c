//! Light, and pictures that are the same on all paths.

mod colors;
mod lens;
mod light;
mod path;
mod same_pictures;
mod samplers;
mod stage;
mod until_error;
