//! What came of a check.

use cyltrace::math::Ray;

use super::{Class, ReportedHit};

/// What an answer is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Witness {
    /// Inscribed and circumscribed prisms as Embree's triangle meshes.
    Prisms,
    /// The exact oracle, on a sample.
    Oracle,
    /// A mesh of the user's.
    UserMesh,
    /// Hits of the user's.
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
pub struct ClassRow {
    /// How the rays were made.
    pub class: Class,
    /// What they were held against.
    pub witness: Witness,
    /// Sides of the prisms, where it has any.
    pub segments: Option<u32>,
    /// Rays.
    pub rays: u64,
    /// Rays that the intersector says hit.
    pub hits: u64,
    /// Rays whose answer the witness bounds on both sides: a miss, or a hit
    /// between two numbers.
    pub witnessed: u64,
    /// Rays in the silhouette band: they meet a circumscribed prism before any
    /// hit that is certain, so a hit and a miss are both allowed.
    pub band: u64,
    /// Rays of which the witness cannot tell a lower bound.
    pub unwitnessed: u64,
    /// Suspects that the f32 triangles, judged exactly, clear: Embree's own errors.
    pub triangle_errors: u64,
    /// Answers that are wrong.
    pub violations: u64,
    /// Violations in which the part, then the normal, was what was wrong.
    pub wrong_normals: u64,
    /// The greatest difference between the inscribed prism's `t` and the
    /// answer's, in units of the chord error along the ray.
    pub max_dt_over_chord: f64,
}

impl ClassRow {
    /// Whether more than half of the rays had no witness: such a row says
    /// nothing and fails. The oracle is given a few rays only.
    #[must_use]
    pub fn is_unwitnessed(&self) -> bool {
        self.witness == Witness::Prisms && 2 * self.unwitnessed > self.rays
    }
}

/// How near the prisms are for a number of sides, over the rays of class
/// [`Class::Sphere`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Sides.
    pub segments: u32,
    /// Share of the rays in the silhouette band.
    pub band_percent: f64,
    /// The 99th percentile of the difference in `t` to the inscribed prism, as
    /// a length over the radius of what is hit; 0 where no difference was taken, as of
    /// compositions.
    pub p99_dt_r: f64,
}

/// An answer that is wrong.
#[derive(Clone, Debug)]
pub struct Violation {
    /// How the ray was made.
    pub class: Class,
    /// What contradicts the answer.
    pub witness: Witness,
    /// Sides of the prisms, where the witness has any.
    pub segments: Option<u32>,
    /// The number of the ray in its class.
    pub index: u64,
    /// The ray.
    pub ray: Ray,
    /// The answer.
    pub answer: Option<ReportedHit>,
    /// The bounds that it breaks: a hit's `t` is at least and at most this;
    /// infinite where a miss is right.
    pub allowed: (f64, f64),
    /// What is wrong, in words.
    pub what: String,
}

/// Everything that a check found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The rows, by witness, segments and class.
    pub rows: Vec<ClassRow>,
    /// By segments.
    pub convergence: Vec<Convergence>,
    /// The first violations of each row.
    pub violations: Vec<Violation>,
    /// Parts of the scene that were checked and what each held, in words.
    pub windows: Vec<String>,
}

impl Outcome {
    /// Rays of all rows; a ray is counted once for each row that it is in.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.rows.iter().map(|row| row.rays).sum()
    }

    /// Wrong answers of all rows.
    #[must_use]
    pub fn violation_count(&self) -> u64 {
        self.rows.iter().map(|row| row.violations).sum()
    }

    /// Whether every row holds: no violation, and at least half of the rays
    /// with a witness.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.rows
            .iter()
            .all(|row| row.violations == 0 && !row.is_unwitnessed())
    }
}
