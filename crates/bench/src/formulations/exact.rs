//! `exact`: hit and part as exact arithmetic has them.
//!
//! The solver and its three stages are [`cyltrace::solid::exact`], which solves
//! in f64 and longer numbers. `exact` answers with the `t` of the stage that was
//! certain; `exact-rounded` rounds every `t` correctly, which the library does
//! for the final hit alone, so its time less that of `exact` is what that
//! rounding costs. In f32, cylinder, ray and `t` are f32, and what is computed
//! between them is not: the `t` of `exact-rounded` is the f32 nearest to the
//! true one.

use super::adapter::Solver;
use super::triple_product::{StatedRecord, TripleProduct};
use cyltrace::math::RayOf;
use cyltrace::solid::exact::{self, Target};
use cyltrace::solid::{Cylinder, Part};

/// The exact solver; `ROUNDS` says whether `t` is the number nearest to the
/// true one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact<const ROUNDS: bool>;

impl<S: Target, const ROUNDS: bool> Solver<S> for Exact<ROUNDS> {
    type Record = StatedRecord<S>;

    fn name(&self) -> &'static str {
        if ROUNDS { "exact-rounded" } else { "exact" }
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        TripleProduct.record(cylinder)
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let (cylinder, ray) = (record.cylinder(), ray.to_f64());
        let hit = exact::first(&cylinder, &ray).0?;
        let t = if ROUNDS {
            exact::rounded_t(&cylinder, &ray, &hit)
        } else {
            S::from_f64(hit.t)
        };
        Some((t, hit.part))
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        TripleProduct.normal(record, ray, t, part)
    }
}
