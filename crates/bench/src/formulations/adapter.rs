//! From a solver in one precision to a [`Formulation`] that tables can list.
//!
//! A formulation's file says how a cylinder is stored, where the ray first
//! hits it and the normal there, generic over the precision. Converting
//! problems and running over many of them is here, once. [`Solved::run`] is
//! compiled per solver, so its loop contains the solver inline: a record and a
//! ray in, a hit out, as in an intersector's callback.

use super::{Answer, Batch, Formulation, Precision, Problem};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::{Cylinder, Part};

/// A way of intersecting, in one precision.
pub(super) trait Solver<S: Real>: Copy + Send + Sync + 'static {
    /// What is stored of a cylinder.
    type Record: Copy + Send + Sync;

    /// The name in tables and on the command line.
    fn name(&self) -> &'static str;

    /// The cylinder as it is stored: computed in f64, then rounded.
    fn record(&self, cylinder: &Cylinder) -> Self::Record;

    /// The first hit in the ray's range.
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)>;

    /// The unit normal at a hit.
    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector;
}

/// The solver in one precision, as a formulation.
pub(super) fn in_precision<F: Solver<f32> + Solver<f64>>(
    solver: F,
    precision: Precision,
) -> Box<dyn Formulation> {
    match precision {
        Precision::F32 => Box::new(Adapter::<f32, F>::new(solver, precision)),
        Precision::F64 => Box::new(Adapter::<f64, F>::new(solver, precision)),
    }
}

struct Adapter<S: Real, F: Solver<S>> {
    solver: F,
    precision: Precision,
    scalar: std::marker::PhantomData<S>,
}

impl<S: Real, F: Solver<S>> Adapter<S, F> {
    fn new(solver: F, precision: Precision) -> Self {
        Self {
            solver,
            precision,
            scalar: std::marker::PhantomData,
        }
    }
}

impl<S: Real, F: Solver<S>> Formulation for Adapter<S, F> {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn precision(&self) -> Precision {
        self.precision
    }

    fn bytes(&self) -> usize {
        size_of::<F::Record>()
    }

    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
        problems
            .iter()
            .map(|problem| {
                let record = self.solver.record(&problem.cylinder);
                let ray = RayOf::<S>::rounded(&problem.ray);
                let (t, part) = self.solver.first(&record, &ray)?;
                Some(Answer {
                    t: t.to_f64(),
                    part,
                    normal: self.solver.normal(&record, &ray, t, part).to_f64(),
                })
            })
            .collect()
    }

    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
        Box::new(Solved {
            solver: self.solver,
            records: problems
                .iter()
                .map(|problem| self.solver.record(&problem.cylinder))
                .collect(),
            rays: problems
                .iter()
                .map(|problem| RayOf::<S>::rounded(&problem.ray))
                .collect(),
        })
    }
}

/// Records and rays, each in a row of their own.
struct Solved<S: Real, F: Solver<S>> {
    solver: F,
    records: Vec<F::Record>,
    rays: Vec<RayOf<S>>,
}

impl<S: Real, F: Solver<S>> Batch for Solved<S, F> {
    fn run(&self) -> u64 {
        let mut digest = 0_u64;
        for (record, ray) in self.records.iter().zip(&self.rays) {
            if let Some((t, part)) = self.solver.first(record, ray) {
                let bits = t.to_f64().to_bits().wrapping_add(part as u64 + 1);
                digest = digest.wrapping_add(bits);
            }
        }
        digest
    }
}
