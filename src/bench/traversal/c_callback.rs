//! The tracer's way of a ray with the callback in C: what a callback costs for
//! being in Rust.
//!
//! What happens once a ray (the frame, the sphere, the f32 ray) is the tracer's
//! own code; what happens once a candidate is `c_rival.c`.

use std::ops::Range;
use std::sync::Arc;

use super::flat::Flat;
use super::rays::{Kind, Rays};
use super::representation::{Met, Representative, SolidId};
use crate::embree::{Box32, CCylinder, CQuery, Device, DeviceOptions, Error, Scene, SceneBuilder};
use crate::math::{Bounds, Ray, f32_above, f32_below};
use crate::scene::{CylinderList, CylinderRecord};
use crate::tracer::{Frame, LocalRay};

/// Bytes that C keeps for a cylinder, its box among them.
pub const RECORD_BYTES: usize = size_of::<CCylinder>() + 2 * 16;

/// No primitive: while a query has no hit.
const NONE: u32 = u32::MAX;

/// A scene without placements whose callbacks are in C.
pub struct CCallback {
    device: Device,
    scene: Scene<CQuery>,
    frame: Frame,
    cylinders: usize,
}

impl CCallback {
    /// Builds the scene.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(flat: &Arc<Flat>, options: &DeviceOptions) -> Result<Self, Error> {
        let device = Device::new(options)?;
        let records = &flat.scene.prototypes[0].cylinders;
        let frame = Frame::new(&bounds_of(records));
        let boxes: Vec<Box32> = records
            .iter()
            .map(|record| frame.grown_box(&record.cylinder().bounds()))
            .collect();
        let mut builder = SceneBuilder::new(&device)?;
        builder.attach_c(c_cylinders(records), &boxes)?;
        Ok(Self {
            device,
            scene: builder.commit()?,
            frame,
            cylinders: records.len(),
        })
    }

    /// The state of a query and Embree's ray, if the ray comes near.
    #[inline]
    fn query(&self, ray: &Ray) -> Option<(CQuery, crate::embree::Ray32)> {
        if !ray.is_valid() {
            return None;
        }
        let (level, ray32) = self
            .frame
            .enter(&LocalRay::new(ray), ray.t_min, ray.t_max)?;
        let [nearest, start, rate] = level.window.terms();
        let query = CQuery {
            origin: level.ray.origin.to_array(),
            direction: level.ray.direction.to_array(),
            base: level.ray.base.to_array(),
            shift: level.ray.shift,
            t_min: ray.t_min,
            bound: ray.t_max,
            nearest,
            start,
            rate,
            t_local: 0.0,
            primitive: NONE,
            part: 0,
            crossing: 0,
        };
        Some((query, ray32))
    }

    #[inline]
    fn first(&self, ray: &Ray) -> Option<CQuery> {
        let (mut query, ray32) = self.query(ray)?;
        self.scene.closest(&ray32, &mut query);
        (query.primitive != NONE).then_some(query)
    }

    #[inline]
    fn any(&self, ray: &Ray) -> bool {
        let Some((mut query, ray32)) = self.query(ray) else {
            return false;
        };
        self.scene.any(&ray32, &mut query)
    }
}

fn bounds_of(records: &CylinderList) -> Bounds {
    records.iter().fold(Bounds::EMPTY, |all, record| {
        all.union(&record.cylinder().bounds())
    })
}

fn c_cylinders(records: &CylinderList) -> Vec<CCylinder> {
    let c_cylinder = |record: CylinderRecord| {
        let cylinder = record.cylinder();
        let caps = cylinder.caps();
        CCylinder {
            p0: cylinder.p0().to_array(),
            p1: cylinder.p1().to_array(),
            radius: cylinder.radius(),
            primitive: record.primitive(),
            caps: u32::from(caps.at_p0()) | u32::from(caps.at_p1()) << 1,
        }
    };
    records.iter().map(c_cylinder).collect()
}

/// Adds cylinders that C intersects with Embree's own ray. Their boxes grow by
/// a share of all of them, as the tracer's do.
pub fn attach_narrow(builder: &mut SceneBuilder<()>, records: &CylinderList) -> Result<(), Error> {
    let grow = 0.5 * bounds_of(records).extent().length() / f64::from(1 << 19);
    let box32 = |record: CylinderRecord| {
        let bounds = record.cylinder().bounds().grown(grow);
        Box32 {
            lower: bounds.lower.to_array().map(f32_below),
            upper: bounds.upper.to_array().map(f32_above),
        }
    };
    let boxes: Vec<Box32> = records.iter().map(box32).collect();
    builder.attach_c_narrow(c_cylinders(records), &boxes)?;
    Ok(())
}

impl Representative for CCallback {
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>> {
        let met = |query: CQuery| Met {
            t: query.bound,
            solid: SolidId {
                placed: 0,
                primitive: query.primitive,
            },
        };
        let rays = rays.wide[range].iter();
        rays.map(|ray| self.first(ray).map(met)).collect()
    }

    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool> {
        rays.wide[range].iter().map(|ray| self.any(ray)).collect()
    }

    fn run(&self, rays: &Rays, range: Range<usize>) -> u64 {
        let asked = rays.wide[range].iter();
        match rays.kind {
            Kind::Shadow => asked.fold(0, |sum, ray| sum + u64::from(self.any(ray))),
            Kind::Coherent | Kind::Incoherent => asked.fold(0, |sum: u64, ray| {
                let found = self.first(ray);
                sum.wrapping_add(found.map_or(0, |found| found.bound.to_bits()))
            }),
        }
    }

    fn bytes(&self) -> usize {
        self.device.memory_bytes() + self.cylinders * RECORD_BYTES
    }
}

#[cfg(test)]
mod tests {
    use super::super::ours;
    use super::super::random_scene::sticks;
    use super::*;
    use crate::tracer::Options;

    /// Every hit of C's is the tracer's, bit for bit.
    #[test]
    fn callbacks_in_c_answer_as_those_in_rust() {
        const SEED: u64 = 17;
        let flat = Arc::new(Flat::new(Arc::new(sticks(2000, SEED))));
        let [(_, ours, _), ..] = ours::modes(&flat, &Options::default()).unwrap();
        let in_c = CCallback::new(&flat, &DeviceOptions::default()).unwrap();
        for rays in Rays::of_scene(&flat, ours.tracer(), 4096, SEED) {
            let all = 0..rays.wide.len();
            let (found, expected) = (
                in_c.closest(&rays, all.clone()),
                ours.closest(&rays, all.clone()),
            );
            assert_eq!(found, expected, "seed {SEED}, {}", rays.kind.name());
            assert!(found.iter().flatten().count() > 100, "{}", rays.kind.name());
            assert_eq!(in_c.blocked(&rays, all.clone()), ours.blocked(&rays, all));
        }
    }
}
