//! Embree's own instances: a committed scene placed in another by an f32 map.
//!
//! Embree inverts the map in f32, maps its f32 ray with the inverse, and traces the scene with
//! that ray. Callbacks within get [`Reached::instance`](super::Reached). Every build of Embree
//! supports one level of instances.

use std::sync::Arc;

use super::error::Error;
use super::geometry::GeometryHandle;
use super::query::Query;
use super::ray::is_inside;
use super::scene::{Scene, SceneBuilder};
use super::sys;
use super::types::GeometryId;

impl<Q: Query> SceneBuilder<Q> {
    /// Adds an instance of `scene`, which is kept alive. The map takes points of the instanced
    /// scene to points of this one: three rows, each with three coefficients and a translation.
    ///
    /// A ray keeps its `t` in the instanced scene. Its direction there has another length if
    /// the map scales.
    ///
    /// # Errors
    /// When the map has a number that is not finite or too large, or a determinant that is zero
    /// or out of the range of f32; when `scene` contains instances itself or is on another
    /// device; when Embree reports an error.
    pub fn attach_instance(
        &mut self,
        scene: &Arc<Scene<Q>>,
        parent_from_scene: &[[f32; 4]; 3],
    ) -> Result<GeometryId, Error> {
        let instance = self.new_instance(scene, parent_from_scene)?;
        self.attach(&instance)
    }

    /// As [`attach_instance`](Self::attach_instance), with a number chosen by the caller.
    /// Embree's memory grows with the greatest number.
    ///
    /// # Errors
    /// As [`attach_instance`](Self::attach_instance), and when the number is taken.
    pub fn attach_instance_as(
        &mut self,
        number: GeometryId,
        scene: &Arc<Scene<Q>>,
        parent_from_scene: &[[f32; 4]; 3],
    ) -> Result<(), Error> {
        let instance = self.new_instance(scene, parent_from_scene)?;
        self.attach_as(number, &instance)
    }

    fn new_instance(
        &mut self,
        scene: &Arc<Scene<Q>>,
        parent_from_scene: &[[f32; 4]; 3],
    ) -> Result<GeometryHandle, Error> {
        check_map(parent_from_scene)?;
        if !scene.is_of(self.device()) {
            return Err(Error::OtherDevice);
        }
        if scene.has_instances() {
            return Err(Error::NestedInstance);
        }
        let instance = GeometryHandle::new(self.device(), sys::RTC_GEOMETRY_TYPE_INSTANCE)?;
        // Kept before Embree gets it, so it is also kept after an error.
        self.keep(Arc::clone(scene));
        // SAFETY: invariants 1 and 5: the scene is committed and only read.
        unsafe { sys::rtcSetGeometryInstancedScene(instance.raw(), scene.raw()) };
        self.device().check("set an instance's scene")?;
        // SAFETY: invariants 1 and 5; the format is twelve numbers by rows, and Embree copies
        // them.
        unsafe {
            sys::rtcSetGeometryTransform(
                instance.raw(),
                0,
                sys::RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                parent_from_scene.as_ptr().cast(),
            );
        }
        self.device().check("set an instance's map")?;
        Ok(instance)
    }
}

/// Checks that Embree can invert the map in f32, which it does by the determinant.
fn check_map(map: &[[f32; 4]; 3]) -> Result<(), Error> {
    let [x, y, z] = map.map(|row| [row[0], row[1], row[2]].map(f64::from));
    let determinant = x[0] * (y[1] * z[2] - y[2] * z[1])
        + x[1] * (y[2] * z[0] - y[0] * z[2])
        + x[2] * (y[0] * z[1] - y[1] * z[0]);
    let range = f64::from(f32::MIN_POSITIVE)..f64::from(f32::MAX);
    if map.iter().all(|row| is_inside(row)) && range.contains(&determinant.abs()) {
        return Ok(());
    }
    Err(Error::InstanceMap { map: *map })
}
