//! Light, and pictures that are the same on all paths.

mod clip;
mod colors;
mod illustration;
mod insets;
mod lens;
mod light;
mod path;
mod same_pictures;
mod samplers;
mod stage;
mod until_error;
