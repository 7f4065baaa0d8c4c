//! The scene as the user states it, in f64, and the files it is read from.

mod census;
mod description;

pub use census::Census;
pub use description::{
    Camera, CylinderRecord, Film, Frame, Integrator, Material, MaterialIndex, Placement,
    Projection, Prototype, PrototypeIndex, RenderSettings, Scene, Sky, Sun,
};
