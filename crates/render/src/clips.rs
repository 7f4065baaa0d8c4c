//! What clip planes leave of rays.
//!
//! All planes together leave a convex region, so that a ray has one part in it. A camera ray
//! starts where that part begins. If that is at a plane, and in a solid, it hits the cut face of
//! that solid; otherwise it hits what the part contains. A ray from a point of the region ends
//! where it leaves the region, as far as what is removed casts no shadows: nothing is behind.

use cyltrace::math::Ray;
use cyltrace::scene::Clip;
use cyltrace::solid::Part;
use cyltrace::tracer::{HitFields, PartialHit, Tracer};

/// The planes of a scene.
pub(super) struct Clips(Vec<Clip>);

impl Clips {
    pub fn new(clips: &[Clip]) -> Self {
        Self(clips.to_vec())
    }

    /// Whether a ray from the eye starts at a plane.
    pub fn start(&self, ray: &Ray) -> bool {
        !self.0.is_empty() && self.left(ray).1.is_some()
    }

    /// The first hits of camera rays. It shortens the rays.
    pub fn first_hits(
        &self,
        tracer: &Tracer,
        rays: &mut [Ray],
        fields: HitFields,
        hits: &mut Vec<Option<PartialHit>>,
    ) {
        if self.0.is_empty() {
            return tracer.closest_batch_with(rays, fields, hits);
        }
        let planes: Vec<Option<&Clip>> = rays
            .iter_mut()
            .map(|ray| {
                let ([t_min, t_max], plane) = self.left(ray);
                (ray.t_min, ray.t_max) = (t_min, t_max);
                plane
            })
            .collect();
        tracer.closest_batch_with(rays, fields, hits);
        for ((ray, plane), hit) in rays.iter().zip(planes).zip(hits) {
            if let Some(plane) = plane.filter(|_| ray.t_min <= ray.t_max)
                && let Some(cut) = tracer.cut(ray, ray.t_min, plane)
            {
                *hit = Some(cut);
            }
        }
    }

    /// The part of a ray in the region, and the plane that it starts at.
    fn left(&self, ray: &Ray) -> ([f64; 2], Option<&Clip>) {
        let (mut ray, mut plane) = (*ray, None);
        for clip in &self.0 {
            let ([t_min, t_max], starts) = clip.left(&ray);
            (ray.t_min, ray.t_max) = (t_min, t_max);
            if starts {
                plane = Some(clip);
            }
        }
        ([ray.t_min, ray.t_max], plane)
    }

    /// The cut face at which a ray within a solid leaves the region, if it ends there.
    pub fn at_end(&self, tracer: &Tracer, ray: &Ray) -> Option<PartialHit> {
        if ray.t_max.is_infinite() {
            return None;
        }
        let unlimited = Ray {
            t_max: f64::INFINITY,
            ..*ray
        };
        let mut clips = self.0.iter();
        let plane = clips.find(|clip| clip.left(&unlimited).0[1] == ray.t_max)?;
        tracer.cut(ray, ray.t_max, plane)
    }

    /// A ray from a hit, up to where it leaves the region.
    pub fn limited(&self, ray: Ray, hit: &PartialHit) -> Ray {
        let is_cut = hit.part() == Part::Cut;
        let clips = self.0.iter();
        clips
            .filter(|clip| is_cut || !clip.casts_shadows)
            .fold(ray, |ray, clip| {
                let ([_, t_max], _) = clip.left(&ray);
                Ray {
                    t_max: t_max.max(ray.t_min),
                    ..ray
                }
            })
    }
}
