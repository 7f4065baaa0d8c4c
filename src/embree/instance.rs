//! Embree's own instances: a committed scene placed in another by an f32 map.
//!
//! Embree inverts the map in f32, takes its f32 ray through it, and traces the scene
//! with that; callbacks within get [`Reached::instance`](super::Reached). One level of
//! instances is what every build of Embree has.

use std::sync::Arc;

use super::error::Error;
use super::geometry::GeometryHandle;
use super::query::Query;
use super::ray::is_inside;
use super::scene::{Scene, SceneBuilder};
use super::sys;
use super::types::GeometryId;

impl<Q: Query> SceneBuilder<Q> {
    /// Adds an instance of `scene`, which it keeps. The map takes the scene's
    /// space to this one; it is three rows of three coefficients and a shift.
    ///
    /// A ray enters the scene with its `t` unchanged, so its direction there has
    /// another length wherever the map scales.
    ///
    /// # Errors
    /// When the map has a number that is not finite or too large, or a
    /// determinant that is zero or beyond the range of f32; when `scene` contains
    /// instances itself; when it is of another device, or Embree refuses.
    pub fn attach_instance(
        &mut self,
        scene: &Arc<Scene<Q>>,
        parent_from_scene: &[[f32; 4]; 3],
    ) -> Result<GeometryId, Error> {
        let instance = self.new_instance(scene, parent_from_scene)?;
        self.attach(&instance)
    }

    /// As [`attach_instance`](Self::attach_instance), with a number that the caller
    /// chooses. Embree's memory grows with the greatest number.
    ///
    /// # Errors
    /// Likewise, and when the number is taken.
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
        // Before Embree knows of it, hence also kept after an error.
        self.keep(Arc::clone(scene));
        // SAFETY: invariants 1 and 5: the scene is committed and only read.
        unsafe { sys::rtcSetGeometryInstancedScene(instance.raw(), scene.raw()) };
        self.device().check("set an instance's scene")?;
        // SAFETY: invariants 1 and 5; the format is that of twelve numbers by
        // rows, which Embree copies.
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

/// Embree inverts the map in f32, by its determinant.
fn check_map(map: &[[f32; 4]; 3]) -> Result<(), Error> {
    let [x, y, z] = map.map(|row| [row[0], row[1], row[2]].map(f64::from));
    let determinant = x[0] * (y[1] * z[2] - y[2] * z[1])
        + x[1] * (y[2] * z[0] - y[0] * z[2])
        + x[2] * (y[0] * z[1] - y[1] * z[0]);
    let held = f64::from(f32::MIN_POSITIVE)..f64::from(f32::MAX);
    if map.iter().all(|row| is_inside(row)) && held.contains(&determinant.abs()) {
        return Ok(());
    }
    Err(Error::InstanceMap { map: *map })
}
