//! What is checked: anything that finds the first hit of a ray.

use glam::DVec3;

use cyltrace::math::Ray;
use cyltrace::solid::Part;
use cyltrace::tracer::{HitFields, Tracer};

/// Rays that a thread takes at a time: enough to be worth a task, few enough to stop soon
/// after an interrupt.
pub(crate) const BLOCK: u64 = 512;

/// Finds the first hit of a ray with the scene that it is checked against, from
/// any number of threads.
pub trait Intersector: Sync {
    /// The hit with the least `t` in the ray's range; `None` for a miss.
    fn closest(&self, ray: &Ray) -> Option<ReportedHit>;

    /// The hit of each ray, in their order. A check calls this for all rays that it makes in
    /// bulk; an intersector that is faster with many rays overrides it.
    fn closest_of_each(&self, rays: &[Ray]) -> Vec<Option<ReportedHit>> {
        rays.iter().map(|ray| self.closest(ray)).collect()
    }

    /// The greatest number of rays of a call of [`Intersector::closest_of_each`], at least 1.
    /// It changes the speed of a check and not its outcome: more is faster if a call is
    /// expensive, less keeps more threads busy and stops sooner.
    fn batch(&self) -> u64 {
        BLOCK
    }
}

/// A hit as an intersector reports it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportedHit {
    /// The ray's parameter, in lengths of its direction.
    pub t: f64,
    /// The outward unit normal, if the intersector reports it.
    pub normal: Option<DVec3>,
    /// What is hit, if the intersector reports it. It makes the check stricter: the
    /// bounds are then those of this solid.
    pub place: Option<Place>,
}

/// A part of a solid in the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The placements from the root to the solid's prototype, outermost first.
    pub instance: Vec<u32>,
    /// The solid's number within its prototype.
    pub primitive: u32,
    /// The part of its surface.
    pub part: Part,
}

impl Intersector for Tracer {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        let first = self.first_hit(ray)?;
        let hit = self.hit_with(ray, &first, HitFields::NORMAL);
        Some(ReportedHit {
            t: hit.t(),
            normal: hit.normal(),
            place: Some(Place {
                instance: first.instance().to_vec(),
                primitive: hit.primitive(),
                part: hit.part(),
            }),
        })
    }
}
