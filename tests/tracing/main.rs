//! Queries of the tracer: first hits, all hits, occlusion, containment; single rays and batches; placements, layouts and builds.

mod all_hits;
mod batches;
mod composed;
mod compositions;
mod extreme_rays;
mod extremes;
mod far_solids;
mod hit_fields;
mod instances;
mod lazy_builds;
mod memory_estimate;
mod mesh_hits;
mod mixed;
mod seams;
mod spawn;
mod traversal;
mod view;
