//! Formulations, families of cases, rivals, and batches as large as benchmarks trace.

mod families;
mod formulations;
mod invariance;
mod large_batches;
mod rival_defects;
