//! Validates hits on analytic solids: a regression check with a proof instead of a tolerance.
//!
//! For N sides, the *inscribed* mesh of a solid lies inside it and the *circumscribed* mesh
//! contains it. The crossings of a ray with the three are therefore
//! ordered, and an intersector whose answer violates that order
//! is wrong, for any number of sides. The folders, each of which uses only those before it:
//!
//! - `solids`: each kind of solid as the check needs it;
//! - `bounding_meshes`: every solid of a window of the scene, with its placements composed
//!   exactly (without the tracer's placement code); meshes grown or
//!   shrunk by the rounding of f32, and the exact proof that they contain or are
//!   contained; crossings of rays with them in Embree;
//! - `rays`: classes of rays that reach the hard cases;
//! - `verdict`: bounds of the first hit from the crossings of both meshes; part and
//!   normal; suspects judged exactly on the f32 triangles; and, on a sample,
//!   the same bounds with exact solids in place of meshes;
//! - `external`: hits of another program or of a mesh from a file;
//! - `report`: text, JSON and the page;
//! - `run`: all of it over many rays, and one ray again.
//!
//! ```no_run
//! use cyltrace_check::{Settings, compare, verdict};
//! # fn check(tracer: &cyltrace::tracer::Tracer) -> Result<(), cyltrace_check::CheckError> {
//! let outcome = compare(tracer.scene(), tracer, &Settings::default())?;
//! println!("{}", verdict(&outcome));
//! # Ok(())
//! # }
//! ```

mod bounding_meshes;
mod external;
mod outcome;
mod partial_outcome;
mod rays;
mod replay;
mod report;
mod reported_hit;
mod run;
mod settings;
mod solids;
mod tally;
mod verdict;

pub use external::compare::{compare_hits, compare_mesh};
pub use external::deviation::Deviation;
pub use external::tolerance::F32_TOLERANCE;
pub use external::traced_mesh::{TracedMesh, TriangleHit};
pub use outcome::{
    Convergence, Expected, Outcome, Row, RowTolerance, Shortfall, Violation, Witness,
};
pub use partial_outcome::{NotTheseTallies, PartialOutcome};
pub use rays::around::rays_around;
pub use replay::Replay;
pub use report::page::{Checked, page};
pub use report::pictures::PicturesError;
pub use report::text::{summary, verdict, violation_text};
pub use reported_hit::{Intersector, Place, ReportedHit};
pub use run::compare::{compare, compare_rays, compare_with};
pub use run::plan::{Plan, plan};
pub use run::replay::{Replayed, replay};
pub use settings::{CheckError, Class, Settings};
pub use tally::Progress;
