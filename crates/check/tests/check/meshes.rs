//! Meshes of a scene's solids, compared with the exact hits.

use std::ops::ControlFlow;

use cyltrace::solid::tessellation::Mesh;
use cyltrace::tracer::Tracer;
use cyltrace_check::{Agreement, Deviation, TracedMesh, compare_mesh, rays_around};

/// Progress of a comparison that is never stopped.
pub fn go_on(_: u64, _: u64, _: &str) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Compares `rays` seeded rays around a scene with meshes of its solids, which are as one
/// mesh with this deviation.
pub fn compared_with(
    tracer: &Tracer,
    meshes: &[Mesh],
    (seed, rays): (u64, u64),
    deviation: f64,
) -> Agreement {
    let mut whole = Mesh::default();
    meshes.iter().for_each(|one| whole.append(one));
    let mesh = TracedMesh::new(&whole);
    let rays = rays_around(tracer, seed, rays);
    let tolerance = (Deviation::Everywhere(deviation), 0.0);
    compare_mesh(tracer, &mesh, ("around", &rays), tolerance, 3, &go_on).expect("an end")
}
