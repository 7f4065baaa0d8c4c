//! Meshes of a scene's solids, compared with the exact hits.

use std::ops::ControlFlow;

use cyltrace::solid::tessellation::Mesh;
use cyltrace::tracer::Tracer;
use cyltrace_check::{Deviation, Outcome, Row, TracedMesh, compare_mesh, rays_around};

/// Progress of a comparison that is never stopped.
pub fn go_on(_: u64, _: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The only row of a comparison, whose wrong answers are printed for a test that fails.
pub fn row(outcome: Option<Outcome>) -> Row {
    let Outcome {
        mut rows,
        violations,
        ..
    } = outcome.expect("an end");
    println!("{violations:?}");
    rows.remove(0)
}

/// Compares meshes of a scene's solids, as one mesh with this deviation, on `rays` seeded
/// rays around the scene.
pub fn compared_with(
    tracer: &Tracer,
    meshes: &[Mesh],
    (seed, rays): (u64, u64),
    deviation: f64,
) -> Row {
    let mut whole = Mesh::default();
    meshes.iter().for_each(|one| whole.append(one));
    let mesh = TracedMesh::new(&whole);
    let rays = rays_around(tracer, seed, rays);
    let tolerance = (Deviation::Everywhere(deviation), 0.0);
    row(compare_mesh(
        tracer,
        &mesh,
        ("around", &rays),
        tolerance,
        3,
        &go_on,
    ))
}
