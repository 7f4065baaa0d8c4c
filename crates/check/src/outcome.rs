//! The outcome of a check: rows of counts, violations, and whether it passes.

use cyltrace::math::Ray;
use cyltrace::solid::tessellation::Fit;

/// What answers are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Witness {
    /// Inscribed and circumscribed meshes, traced by Embree.
    Prisms,
    /// The exact oracle, on a sample.
    Oracle,
    /// A mesh from a file.
    UserMesh,
    /// Hits of another program.
    UserHits,
}

impl Witness {
    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Prisms => "prisms",
            Self::Oracle => "oracle",
            Self::UserMesh => "user-mesh",
            Self::UserHits => "user-hits",
        }
    }
}

/// A class of rays against a witness.
#[derive(Clone, Debug)]
pub struct Row {
    /// The name of a [`Class`](crate::Class); `given` for rays from a table, `around` for
    /// rays around the scene that check a mesh.
    pub class: &'static str,
    /// What the answers were compared with.
    pub witness: Witness,
    /// Sides of the meshes.
    pub segments: Option<u32>,
    /// Rays.
    pub rays: u64,
    /// Rays whose answer is a hit; of external answers, rays whose exact answer is one.
    pub hits: u64,
    /// Rays whose answer the witness bounds on both sides: it must be a miss, or lie
    /// between two numbers. Of external answers, those that are proven right or wrong.
    pub witnessed: u64,
    /// Rays for which a hit and a miss are both allowed: they enter a circumscribed mesh
    /// before any certain hit. Of external answers, those near a silhouette, an edge or
    /// another solid, which are neither proven right nor wrong.
    pub band: u64,
    /// Rays without a bound. Of external answers, those whose exact hit is on a solid that
    /// is thinner than the tolerance.
    pub unwitnessed: u64,
    /// Answers that Embree's triangle test contradicts and exact arithmetic confirms.
    pub triangle_errors: u64,
    /// Wrong answers.
    pub violations: u64,
    /// Violations with a wrong part or normal.
    pub wrong_normals: u64,
    /// The greatest difference in `t` between the answer and the inscribed mesh, in units
    /// of the chord error along the ray.
    pub max_dt_over_chord: f64,
    /// The tolerance of external answers.
    pub tolerance: Option<RowTolerance>,
}

/// By how much the external answers of a row may be off.
#[derive(Clone, Copy, Debug)]
pub struct RowTolerance {
    /// The greatest length of any ray.
    pub greatest: f64,
    /// The least radius of the scene's solids; infinite without solids.
    pub least_radius: f64,
    /// Whether the mesh of some solid may lack as much as its radius.
    pub is_any_lost: bool,
    /// The segments and the fit that determine the tolerance of each solid.
    pub tessellated: Option<(u32, Fit)>,
}

/// Why a row without violations proves too little.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// There is no ray.
    NoRays,
    /// No ray hits a solid, so the mesh was not checked.
    NoHits,
    /// The tolerance reaches the radius of a solid.
    Coarse,
    /// Fewer than half of the answers are proven right or wrong.
    Band,
    /// More than half of the rays have no bound.
    Unwitnessed,
}

impl Row {
    /// A row without rays.
    #[must_use]
    pub fn new(class: &'static str, witness: Witness, segments: Option<u32>) -> Self {
        Self {
            class,
            witness,
            segments,
            rays: 0,
            hits: 0,
            witnessed: 0,
            band: 0,
            unwitnessed: 0,
            triangle_errors: 0,
            violations: 0,
            wrong_normals: 0,
            max_dt_over_chord: 0.0,
            tolerance: None,
        }
    }

    /// Adds the counts of later rays of the same row.
    pub(crate) fn add(&mut self, later: &Self) {
        self.rays += later.rays;
        self.hits += later.hits;
        self.witnessed += later.witnessed;
        self.band += later.band;
        self.unwitnessed += later.unwitnessed;
        self.triangle_errors += later.triangle_errors;
        self.violations += later.violations;
        self.wrong_normals += later.wrong_normals;
        self.max_dt_over_chord = self.max_dt_over_chord.max(later.max_dt_over_chord);
        if let (Some(own), Some(later)) = (&mut self.tolerance, &later.tolerance) {
            own.greatest = own.greatest.max(later.greatest);
        }
    }

    /// Why the row proves too little, if it does. The oracle judges only a sample, so its
    /// rows prove what they prove.
    #[must_use]
    pub fn shortfall(&self) -> Option<Shortfall> {
        let Some(tolerance) = &self.tolerance else {
            let is_unwitnessed =
                self.witness == Witness::Prisms && 2 * self.unwitnessed > self.rays;
            return is_unwitnessed.then_some(Shortfall::Unwitnessed);
        };
        if self.rays == 0 {
            Some(Shortfall::NoRays)
        } else if self.hits == 0 && self.witness == Witness::UserMesh {
            Some(Shortfall::NoHits)
        } else if tolerance.is_any_lost || self.unwitnessed > 0 {
            Some(Shortfall::Coarse)
        } else {
            (2 * self.witnessed < self.rays).then_some(Shortfall::Band)
        }
    }
}

/// How close the inscribed mesh is for a number of sides, over the rays of
/// [`Class::Sphere`](crate::Class::Sphere).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Convergence {
    /// Sides.
    pub segments: u32,
    /// Share of the rays in the silhouette band.
    pub band_percent: f64,
    /// The 99th percentile of the difference in `t` to the inscribed mesh, as a length over
    /// the radius of the solid; 0 without a difference, as for compositions.
    pub p99_dt_r: f64,
}

/// A wrong answer.
#[derive(Clone, Debug)]
pub struct Violation {
    /// As [`Row::class`].
    pub class: &'static str,
    /// What contradicts the answer.
    pub witness: Witness,
    /// Sides of the meshes.
    pub segments: Option<u32>,
    /// The number of the ray in its class.
    pub index: u64,
    /// The ray.
    pub ray: Ray,
    /// The answer's `t`; `None` for a miss.
    pub t: Option<f64>,
    /// What would be right.
    pub expected: Expected,
    /// The file and the line that the answer was read from.
    pub source: Option<(String, u64)>,
}

impl Violation {
    /// A wrong answer in a row.
    pub(crate) fn new(row: &Row, index: u64, ray: Ray, t: Option<f64>, expected: Expected) -> Self {
        Self {
            class: row.class,
            witness: row.witness,
            segments: row.segments,
            index,
            ray,
            t,
            expected,
            source: None,
        }
    }
}

/// What would be right in place of a wrong answer.
#[derive(Clone, Debug)]
pub enum Expected {
    /// A hit between two numbers, infinite where a miss is right.
    Between {
        /// The least `t`.
        low: f64,
        /// The greatest `t`.
        high: f64,
        /// What is wrong, as a sentence.
        reason: String,
    },
    /// The exact answer to within a distance.
    Exact {
        /// The exact `t`; `None` for a miss.
        t: Option<f64>,
        /// The oracle's `t` for the solid that is hit, as a check of `t`; `None` for
        /// compositions.
        oracle: Option<f64>,
        /// The distance.
        allowance: f64,
    },
}

/// Everything that a check found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The rows, by witness, segments and class.
    pub rows: Vec<Row>,
    /// By segments.
    pub convergence: Vec<Convergence>,
    /// The first violations of each row.
    pub violations: Vec<Violation>,
    /// A sentence for each part of the scene that was checked.
    pub windows: Vec<String>,
}

impl Outcome {
    /// Rays of all rows; a ray is counted once for each of its rows.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.rows.iter().map(|row| row.rays).sum()
    }

    /// Wrong answers of all rows.
    #[must_use]
    pub fn violation_count(&self) -> u64 {
        self.rows.iter().map(|row| row.violations).sum()
    }

    /// Whether no answer is wrong and no row proves too little.
    #[must_use]
    pub fn holds(&self) -> bool {
        let mut rows = self.rows.iter();
        rows.all(|row| row.violations == 0 && row.shortfall().is_none())
    }
}

/// A part in percent; 0 of nothing.
pub(crate) fn percent(part: u64, whole: u64) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}
