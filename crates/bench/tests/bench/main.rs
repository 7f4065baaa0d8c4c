//! Formulations, rivals, and batches as large as benchmarks trace.

mod formulations;
mod invariance;
mod large_batches;
mod rival_defects;
