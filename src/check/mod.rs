//! Analytic hits against meshes that Embree traces: a regression check with a
//! proof instead of a tolerance.
//!
//! For N sides, the *inscribed* prism lies inside the capped cylinder and the
//! *circumscribed* one holds it. What a ray meets of the three is therefore
//! ordered (`sandwich`), and an intersector that answers outside of that order
//! is wrong, whatever the number of sides. Here is what makes that true of the
//! meshes that Embree really holds:
//!
//! - `placed`: every solid of a window of the scene, with its placements composed
//!   exactly; the tracer's own placement code has no part in it;
//! - `mesh_frame`: the f32 space of the meshes, in which rays are exact;
//! - `mesh_solid`: a placed solid there, in f64 with bounds of its errors;
//! - `prism`, `containment`: prisms grown or shrunk by what f32 rounds, and the
//!   exact proof that they contain or are contained;
//! - `rays`: classes of rays that reach what is hard;
//! - `sandwich`: the bounds of the first hit from what a ray meets of both;
//! - `surface`, `judge`, `verdict`: an answer held against the bounds, its part and normal
//!   against what the bounds leave;
//! - `truth`: the same sandwich with exact cylinders in place of prisms, on a
//!   sample;
//! - `retrial`: suspects judged again, exactly, on the f32 triangles;
//! - `curves`, `curve_blocks`: how often Embree's own cone curves, another solver,
//!   agree; the oracle judges where they do not;
//! - `compare`: all of it over many rays, and the outcome;
//! - `agreement`: hits told from elsewhere, within a stated distance (`nearness`):
//!   those of another program (`user_hits`), or of a mesh from a file (`mesh_file`,
//!   `user_mesh`);
//! - `report`, `pictures`, `words`: tables, the page and what is said; `plan`: what it will take.

mod agreement;
mod compare;
mod containment;
mod curve_blocks;
mod curves;
mod finding;
mod judge;
mod mesh_file;
mod mesh_frame;
mod mesh_solid;
mod meshes;
mod nearness;
mod open_ends;
mod outcome;
mod pictures;
mod placed;
mod plan;
mod prism;
mod rays;
mod replay;
mod report;
mod retrial;
mod sandwich;
mod settings;
mod surface;
mod tally;
mod truth;
mod user_hits;
mod user_mesh;
mod verdict;
mod words;

pub use agreement::{Agreement, Disagreement, F32_TOLERANCE};
pub use compare::{Progress, compare, compare_with};
pub use finding::{Finding, Intersector, Place};
pub use mesh_file::{MeshFile, MeshFileError, read_mesh};
pub use outcome::{ClassRow, Convergence, Outcome, Violation, Witness};
pub use pictures::{Pictures, PicturesError, pictures};
pub use plan::{Plan, plan};
pub use replay::{Replay, Replayed, replay};
pub use report::{
    PageContent, TABLE_HEADINGS, TABLE_NAMES, disagreement_text, page, percent, table_rows,
    verdict, violation_text,
};
pub use settings::{CheckError, Class, Settings};
pub use user_hits::compare_hits;
pub use user_mesh::{TracedMesh, TriangleHit, compare_mesh, rays_around};
