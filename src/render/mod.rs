//! From a scene to a picture: camera, samples, light and image files.

mod camera;
mod film;
mod lights;
mod output;
mod sampler;
mod srgb;
mod workers;

pub use camera::Camera;
pub use film::Film;
pub use lights::{Lights, SunLight};
pub use output::{Format, Output, OutputError};
pub use sampler::PixelSampler;
pub use srgb::encode as srgb_encode;
pub use workers::workers;
