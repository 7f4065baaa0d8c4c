//! Analytic hits against meshes that Embree traces: a regression check with a
//! proof instead of a tolerance.
//!
//! For N sides, the *inscribed* prism lies inside the capped cylinder and the
//! *circumscribed* one holds it. What a ray meets of the three is therefore
//! ordered (`sandwich`), and an intersector that answers outside of that order
//! is wrong, whatever the number of sides. Here is what makes that true of the
//! meshes that Embree really holds:
//!
//! - `prisms`: every solid of a window of the scene, with its placements composed
//!   exactly (the tracer's own placement code has no part in it), prisms grown or
//!   shrunk by what f32 rounds, and the exact proof that they contain or are
//!   contained;
//! - `rays`: classes of rays that reach what is hard;
//! - `judging`: the sandwich, bounds of the first hit from what a ray meets of both;
//!   part and normal; suspects judged again, exactly, on the f32 triangles; and
//!   the same sandwich with exact cylinders in place of prisms, on a sample;
//! - `compare`: all of it over many rays, and the outcome; `replay`: one ray again;
//! - `elsewhere`: hits of another program or of a mesh from a file;
//! - `telling`: what it will take, tables and the page.

mod bounding_meshes;
mod compare;
mod external;
mod finding;
mod outcome;
mod rays;
mod replay;
mod report;
mod settings;
mod tally;
mod target;
mod verdict;

pub use compare::{Progress, compare, compare_with};
pub use external::agreement::{Agreement, Disagreement};
pub use external::deviation::Deviation;
pub use external::rays_around::rays_around;
pub use external::tolerance::F32_TOLERANCE;
pub use external::user_hits::compare_hits;
pub use external::user_mesh::{TracedMesh, TriangleHit, compare_mesh};
pub use finding::{Intersector, Place, ReportedHit};
pub use outcome::{ClassRow, Convergence, Outcome, Violation, Witness};
pub use replay::{Replay, Replayed, replay};
pub use report::figures::{class_figures, convergence_figures, violation_figures};
pub use report::pictures::{Pictures, PicturesError, pictures};
pub use report::plan::{Plan, plan};
pub use report::report::{
    PageContent, TABLE_HEADINGS, TABLE_NAMES, disagreement_text, page, percent, table_rows,
    tolerance_text, verdict, violation_text,
};
pub use settings::{CheckError, Class, Settings};
