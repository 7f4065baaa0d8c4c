//! `exact`: hit and part as exact arithmetic has them, in f64.
//!
//! The solver and its three stages are [`crate::solid::exact`]. `exact` answers
//! with the `t` of the stage that was certain; `exact-rounded` rounds every
//! `t` correctly, which the library does for the final hit alone, so its time
//! less that of `exact` is what that rounding costs. There is no f32 form:
//! what is certain does not depend on the precision it is asked in.

use super::adapter::Solver;
use super::triple_product::TripleProduct;
use crate::math::{Ray, RayOf};
use crate::solid::{Cylinder, Part, exact};

/// The exact solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    /// Whether `t` is the f64 nearest to the true one.
    pub rounds_t: bool,
}

impl Solver<f64> for Exact {
    type Record = Cylinder;

    fn name(&self) -> &'static str {
        if self.rounds_t {
            "exact-rounded"
        } else {
            "exact"
        }
    }

    fn record(&self, cylinder: &Cylinder) -> Cylinder {
        *cylinder
    }

    #[inline(always)]
    fn first(&self, cylinder: &Cylinder, ray: &RayOf<f64>) -> Option<(f64, Part)> {
        let ray = Ray {
            origin: ray.origin,
            direction: ray.direction,
            t_min: ray.t_min,
            t_max: ray.t_max,
        };
        let hit = exact::first(cylinder, &ray).0?;
        let t = if self.rounds_t {
            exact::rounded_t(cylinder, &ray, &hit)
        } else {
            hit.t
        };
        Some((t, hit.part))
    }

    fn normal(&self, cylinder: &Cylinder, ray: &RayOf<f64>, t: f64, part: Part) -> glam::DVec3 {
        let record = Solver::<f64>::record(&TripleProduct, cylinder);
        TripleProduct.normal(&record, ray, t, part)
    }
}
