//! Who answers the cases: the formulations for cylinders, and the solver of each
//! other kind of solid.

use glam::DVec3;

use super::family::StressFamily;
use crate::formulations::{self, Answer, Formulation, Precision, Problem};
use cyltrace::math::Ray;
use cyltrace::solid::{
    AnySolid, ConvexSolid, Intersection, Part, RayOrigin, SolidKind, SpawnMargin, SurfacePoint,
};
use cyltrace::{for_each_solid, with_solid};
use cyltrace_oracle::cases::Case;

/// Someone who answers cases of one kind of solid.
pub enum Contender {
    /// A formulation of the cylinder.
    Formulation(Box<dyn Formulation>),
    /// The library's solver of another kind.
    Solver(SolidKind),
    /// The library's solver with exact decisions, of any kind.
    ExactSolver(SolidKind),
    /// The library's solver of set operations, which `composed.rs` judges.
    Composition,
}

impl Contender {
    /// All, in the order of tables.
    #[must_use]
    pub fn all() -> Vec<Self> {
        // Those of cylinders are formulations.
        let mut kinds = SolidKind::SIMPLE.to_vec();
        kinds.sort_by_key(|kind| kind.code());
        let others = kinds
            .clone()
            .into_iter()
            .filter(|&kind| kind != SolidKind::Cylinder);
        let formulations = formulations::all().into_iter().map(Self::Formulation);
        formulations
            .chain(others.map(Self::Solver))
            .chain(kinds.into_iter().map(Self::ExactSolver))
            .chain([Self::Composition])
            .collect()
    }

    /// The name in tables and on the command line.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Formulation(formulation) => formulation.name(),
            Self::Solver(kind) => kind.name(),
            Self::ExactSolver(kind) => exact_name(*kind),
            Self::Composition => "set_operations",
        }
    }

    /// The precision it computes in.
    #[must_use]
    pub fn precision(&self) -> Precision {
        match self {
            Self::Formulation(formulation) => formulation.precision(),
            Self::Solver(_) | Self::ExactSolver(_) | Self::Composition => Precision::F64,
        }
    }

    /// The kind of single solids that it knows.
    #[must_use]
    pub fn kind(&self) -> Option<SolidKind> {
        match self {
            Self::Formulation(_) => Some(SolidKind::Cylinder),
            Self::Solver(kind) | Self::ExactSolver(kind) => Some(*kind),
            Self::Composition => None,
        }
    }

    /// Whether it solves the cases of a family.
    #[must_use]
    pub fn answers_about(&self, family: StressFamily) -> bool {
        match family {
            StressFamily::Solid(family) => self.kind() == Some(family.kind()),
            StressFamily::Composed(_) => matches!(self, Self::Composition),
        }
    }

    /// Whether the library itself traces with it and so promises something about it.
    #[must_use]
    pub fn is_own(&self) -> bool {
        let own = [
            "triple-product",
            "triple-product-prepared",
            "exact",
            "exact-rounded",
        ];
        match self {
            Self::Formulation(formulation) => {
                formulation.precision() == Precision::F64 && own.contains(&formulation.name())
            }
            Self::Solver(_) | Self::ExactSolver(_) | Self::Composition => true,
        }
    }

    /// The first hit of each case, which are of its kind.
    ///
    /// # Panics
    /// When a formulation is given another solid than a cylinder, or set operations
    /// a single solid.
    #[must_use]
    pub fn answers(&self, cases: &[Case]) -> Vec<Option<Answer>> {
        let problem = |case: &Case| match case.solid {
            AnySolid::Cylinder(cylinder) => Problem {
                cylinder,
                ray: case.ray,
            },
            other => unreachable!("a formulation of the cylinder was given {other:?}"),
        };
        match self {
            Self::Formulation(formulation) => {
                let problems: Vec<Problem> = cases.iter().map(problem).collect();
                formulation.answers(&problems)
            }
            Self::Solver(_) => cases.iter().map(first_answer).collect(),
            Self::ExactSolver(_) => cases.iter().map(exact_answer).collect(),
            Self::Composition => unreachable!("set operations were given single solids"),
        }
    }
}

/// The name of the solver of a kind with exact decisions.
fn exact_name(kind: SolidKind) -> &'static str {
    macro_rules! names {
        ($({ $type:ident $name:ident $($rest:tt)* })*) => {
            match kind {
                $(SolidKind::$type => concat!("exact_", stringify!($name)),)*
                _ => unreachable!("set operations have one solver"),
            }
        };
    }
    for_each_solid!(names)
}

fn first_answer(case: &Case) -> Option<Answer> {
    let first = solver(&case.solid).first(&case.ray)?;
    Some(answer_of(case, &first))
}

fn exact_answer(case: &Case) -> Option<Answer> {
    let first = solver(&case.solid).exact_first(&case.ray)?;
    Some(answer_of(case, &first))
}

fn answer_of(case: &Case, first: &Intersection) -> Answer {
    let (solid, ray) = (solver(&case.solid), &case.ray);
    let Intersection { t, part, .. } = *first;
    let on_ray = (ray.origin - solid.anchor()) + ray.direction * t;
    let normal = solid.surface_point(part, on_ray).normal;
    Answer { t, part, normal }
}

/// What is asked of a solid of any kind.
pub(super) trait Solver {
    /// The first point of a ray on the surface.
    fn first(&self, ray: &Ray) -> Option<Intersection>;
    /// The same, decided exactly.
    fn exact_first(&self, ray: &Ray) -> Option<Intersection>;
    /// As [`ConvexSolid::anchor`].
    fn anchor(&self) -> DVec3;
    /// As [`ConvexSolid::surface_point`].
    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint;
    /// What a ray that starts near a point of the surface may be displaced by.
    fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin;
    /// A length to measure errors in: half of its size.
    fn half_size(&self) -> f64;
}

impl<S: ConvexSolid> Solver for S {
    fn first(&self, ray: &Ray) -> Option<Intersection> {
        let x = ray.origin - ConvexSolid::anchor(self);
        ConvexSolid::first(self, x, ray.direction, 0.0, ray.t_min, ray.t_max)
    }

    fn exact_first(&self, ray: &Ray) -> Option<Intersection> {
        let origin = RayOrigin::at(ray.origin);
        ConvexSolid::exact_first(self, &origin, ray.direction, 0.0, [ray.t_min, ray.t_max])
    }

    fn anchor(&self) -> DVec3 {
        ConvexSolid::anchor(self)
    }

    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        ConvexSolid::surface_point(self, part, from_anchor)
    }

    fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        SpawnMargin::of_solid(self, surface)
    }

    fn half_size(&self) -> f64 {
        0.5 * self.size()
    }
}

/// The solid, of whichever kind.
pub(super) fn solver(solid: &AnySolid) -> &dyn Solver {
    with_solid!(solid, solid => solid)
}
