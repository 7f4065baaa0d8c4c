//! All that is known of a case without asking a formulation.

use glam::DVec3;

use crate::cases::Inputs;
use crate::math::{DoubleDouble, UNIT_ROUNDOFF};
use crate::oracle;
use crate::solid::Part;
use crate::solid::formulations::Problem;

/// A case and the truth about it.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The case.
    pub problem: Problem,
    /// Its number in its family.
    pub index: u64,
    /// The first hit, if there is one.
    pub truth: Option<TrueAnswer>,
    /// The relative distance to another answer, [`oracle::gap`].
    pub gap: f64,
    /// Whether hit and part are promised: see [`Witness::new`].
    pub is_decided: bool,
}

/// The true first hit.
#[derive(Clone, Copy, Debug)]
pub struct TrueAnswer {
    /// The parameter to about 106 bits.
    pub t: DoubleDouble,
    /// The part.
    pub part: Part,
    /// The outward unit normal.
    pub normal: DVec3,
    /// What bounds the error of the triple-product solver's `t`, (4) to (6) of
    /// `docs/derivations.md`.
    pub t_bound: f64,
}

/// The least gap, in units of u, at which answers are promised for f64 inputs:
/// a solver that answers for inputs displaced by at most 32 u of the sizes
/// it sees (`docs/derivations.md`, section 5) is right beyond 32 for inputs
/// of like sizes; twice that is asked for what a first-order gap leaves out.
const LEAST_GAP: f64 = 64.0;

impl Witness {
    /// Asks the oracle about a case.
    ///
    /// The library promises every answer for f32 inputs. For f64 inputs it
    /// promises those whose distance from a tangent is above (3) of
    /// `docs/derivations.md` and whose [`oracle::gap`] is above 64 u.
    #[must_use]
    pub fn new(problem: Problem, index: u64, inputs: Inputs) -> Self {
        let Problem { cylinder, ray } = &problem;
        let truth = oracle::first_hit(cylinder, ray);
        let gap = oracle::gap(cylinder, ray, truth.hit.as_ref());

        let (a, d) = (cylinder.p1() - cylinder.p0(), ray.direction);
        let (x, r) = ((ray.origin - cylinder.p0()).length(), cylinder.radius());
        let n = a.cross(d).length();
        // A ray along the axis meets discs only, where k does not enter.
        let k = if n > 0.0 {
            a.length() * d.length() / n
        } else {
            0.0
        };
        let is_decided = match inputs {
            Inputs::F32 => true,
            Inputs::F64 => {
                truth.wall_gap > 16.0 * UNIT_ROUNDOFF * (1.0 + x / r + k)
                    && gap > LEAST_GAP * UNIT_ROUNDOFF
            }
        };
        let truth_answer = truth.hit.as_ref().map(|hit| {
            let high = hit.t_f64();
            let low = oracle::to_f64(&(&hit.t - oracle::exact(high)));
            let t = high.abs();
            let bound = if hit.part == Part::Side {
                let reach = k / (d.length() * truth.wall_gap.sqrt());
                match inputs {
                    Inputs::F32 => t + (r + x) * reach,
                    Inputs::F64 => t * k + (r + x + t * d.length()) * reach,
                }
            } else {
                let along = a.dot(d).abs() / a.length();
                (t * d.length() + x + a.length()) / along
            };
            TrueAnswer {
                t: DoubleDouble { high, low },
                part: hit.part,
                normal: oracle::outward_normal(cylinder, ray, hit),
                t_bound: 8.0 * UNIT_ROUNDOFF * bound,
            }
        });
        Self {
            problem,
            index,
            truth: truth_answer,
            gap,
            is_decided,
        }
    }
}

impl TrueAnswer {
    /// `t` minus the true parameter.
    #[must_use]
    pub fn error_of(&self, t: f64) -> f64 {
        (t - self.t.high) - self.t.low
    }
}
