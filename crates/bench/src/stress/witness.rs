//! All that is known of a case without asking a contender.

use std::cell::OnceCell;

use glam::DVec3;

use super::contender::solver;
use cyltrace::math::{DoubleDouble, Ray, UNIT_ROUNDOFF};
use cyltrace::solid::{AnySolid, Cylinder, Part};
use cyltrace_oracle::TrueHit;
use cyltrace_oracle::cases::{Case, Inputs};

/// A case and the truth about it.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The case.
    pub case: Case,
    /// Its number in its family.
    pub index: u64,
    /// The first hit, if there is one.
    pub truth: Option<TrueAnswer>,
    /// The length that errors of the position are measured in: the radius of a
    /// cylinder, half the size of another solid.
    pub length: f64,
    /// How near another answer may be for hit and part still to be promised, in units
    /// of u.
    least_gap: f64,
    /// Whether the ray is far enough from a tangent for that.
    is_apart: bool,
    gap: OnceCell<f64>,
}

/// The true first hit.
#[derive(Clone, Copy, Debug)]
pub struct TrueAnswer {
    /// The parameter to about 106 bits.
    pub t: DoubleDouble,
    /// The part.
    pub part: Part,
    /// The outward unit normal, where there is one.
    pub normal: Option<DVec3>,
    /// What bounds the error of the triple-product solver's `t`, (4) to (6) of
    /// `docs/derivations.md`; other solvers have no such bound.
    pub t_bound: Option<f64>,
}

/// The least gap, in units of u, at which answers are promised for f64 inputs:
/// a solver that answers for inputs displaced by at most 32 u of the sizes
/// it sees (`docs/derivations.md`, section 5) is right beyond 32 for inputs
/// of like sizes; twice that covers what a first-order gap leaves out.
const LEAST_GAP: f64 = 64.0;

/// The same for other solids than cylinders. Their solvers decide exactly about the
/// rounded differences of the origin and of the ends to the anchor. Those are exact
/// for numbers that are off by u each, twice where both differences have the same
/// end; twice that again for what is of second order.
const LEAST_GAP_OF_EXACT_SIGNS: f64 = 4.0;

impl Witness {
    /// Asks the oracle about a case.
    ///
    /// The library promises every answer for f32 inputs. For f64 inputs it
    /// promises those whose distance from a tangent is above (3) of
    /// `docs/derivations.md` and whose [`cyltrace_oracle::gap`] is above 64 u; of other solids
    /// than cylinders all whose gap is above 4 u.
    #[must_use]
    pub fn new(case: Case, index: u64, inputs: Inputs) -> Self {
        let mut witness = Self {
            case,
            index,
            truth: None,
            length: solver(&case.solid).half_size(),
            least_gap: match inputs {
                Inputs::F32 => 0.0,
                Inputs::F64 => LEAST_GAP_OF_EXACT_SIGNS,
            },
            is_apart: true,
            gap: OnceCell::new(),
        };
        let (solid, ray) = (&case.solid, &case.ray);
        match solid {
            AnySolid::Cylinder(cylinder) => witness.ask_about_cylinder(cylinder, ray, inputs),
            _ => {
                let hit = cyltrace_oracle::first_hit_of_any(solid, ray);
                witness.truth = hit.map(|hit| TrueAnswer::new(solid, ray, &hit, None));
            }
        }
        witness
    }

    fn ask_about_cylinder(&mut self, cylinder: &Cylinder, ray: &Ray, inputs: Inputs) {
        let truth = cyltrace_oracle::first_hit(cylinder, ray);
        let (a, d) = (cylinder.p1() - cylinder.p0(), ray.direction);
        let (x, r) = ((ray.origin - cylinder.p0()).length(), cylinder.radius());
        let n = a.cross(d).length();
        // A ray along the axis hits disks only, where k does not enter.
        let k = if n > 0.0 {
            a.length() * d.length() / n
        } else {
            0.0
        };
        self.length = r;
        if inputs == Inputs::F64 {
            self.least_gap = LEAST_GAP;
            self.is_apart = truth.wall_gap > 20.0 * UNIT_ROUNDOFF * (1.0 + x / r + k);
        }
        self.truth = truth.hit.as_ref().map(|hit| {
            let t = hit.t_f64().abs();
            let bound = if hit.part == Part::Side {
                let reach = k / (d.length() * truth.wall_gap.sqrt());
                match inputs {
                    Inputs::F32 => 8.0 * (t + (r + x) * reach),
                    Inputs::F64 => 10.0 * (t * k + (r + x + t * d.length()) * reach),
                }
            } else {
                let along = a.dot(d).abs() / a.length();
                8.0 * (t * d.length() + x + a.length()) / along
            };
            TrueAnswer::new(&self.case.solid, ray, hit, Some(UNIT_ROUNDOFF * bound))
        });
    }

    /// The relative distance to another answer, [`cyltrace_oracle::gap_of_any`]. It is worked
    /// out at its first use: it takes longer than the answer.
    #[must_use]
    pub fn gap(&self) -> f64 {
        let Case { solid, ray } = &self.case;
        *self
            .gap
            .get_or_init(|| cyltrace_oracle::gap_of_any(solid, ray))
    }

    /// Whether hit and part are promised: see [`Witness::new`].
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.is_apart && (self.least_gap == 0.0 || self.gap() > self.least_gap * UNIT_ROUNDOFF)
    }
}

impl TrueAnswer {
    fn new(solid: &AnySolid, ray: &Ray, hit: &TrueHit, t_bound: Option<f64>) -> Self {
        let high = hit.t_f64();
        let low = cyltrace_oracle::to_f64(&(&hit.t - cyltrace_oracle::exact(high)));
        Self {
            t: DoubleDouble { high, low },
            part: hit.part,
            normal: cyltrace_oracle::outward_normal_of_any(solid, ray, hit),
            t_bound,
        }
    }

    /// `t` minus the true parameter.
    #[must_use]
    pub fn error_of(&self, t: f64) -> f64 {
        (t - self.t.high) - self.t.low
    }
}
