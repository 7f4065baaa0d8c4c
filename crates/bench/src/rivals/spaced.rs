//! A scene of cylinders that don't get in one another's way.
//!
//! A solver is timed on one cylinder a ray. A traversal needs a scene, so the
//! cylinders of the first problems are put on a grid, each in a ball that also
//! contains the start of its ray, and a ray ends where it leaves its ball: it can
//! meet its own cylinder only, and hits or misses as its problem does.
//!
//! More rays than cylinders come from turning a problem's ray about the
//! cylinder's axis, which changes nothing but the numbers: few cylinders keep
//! fine meshes small, many rays keep the processor from learning them by heart.

use glam::{DQuat, DVec3};

use crate::formulations::Problem;
use cyltrace::math::Ray;
use cyltrace::solid::Cylinder;

/// Balls are this much farther apart than they are wide, for the rounding to
/// f32 that follows.
const GAP: f64 = 1.1;

/// The angle between successive turns: the golden angle, which never comes
/// back to where it was.
const TURN: f64 = std::f64::consts::TAU * 0.381_966_011_250_105_1;

/// Cylinders apart from one another, and rays at them.
#[derive(Clone, Debug)]
pub struct Spaced {
    /// The cylinders, in f32 numbers.
    pub cylinders: Vec<Cylinder>,
    /// The rays, in f32 numbers; ray `i` is aimed at cylinder `i` modulo their
    /// number.
    pub rays: Vec<Ray>,
}

impl Spaced {
    /// At most `most` cylinders, and as many rays as there are problems.
    #[must_use]
    pub fn new(problems: &[Problem], most: usize) -> Self {
        let placed = &problems[..problems.len().min(most)];
        let reach = placed.iter().map(ball_radius).fold(0.0, f64::max);
        let side = (1..).find(|side| side * side * side >= placed.len());
        let side = side.unwrap_or(1);
        let shift = |index: usize| {
            let cell = DVec3::new(
                (index % side) as f64,
                (index / side % side) as f64,
                (index / side / side) as f64,
            );
            let grid = cell - 0.5 * (side - 1) as f64;
            grid * (2.0 * GAP * reach) - center(&placed[index])
        };
        let cylinders = placed
            .iter()
            .enumerate()
            .map(|(index, problem)| moved(&problem.cylinder, shift(index)))
            .collect();
        let rays = (0..problems.len())
            .map(|number| {
                let index = number % placed.len();
                let turned = turned(&placed[index], (number / placed.len()) as f64 * TURN);
                let t_max = leaves_ball(&turned, center(&placed[index]), reach);
                Ray {
                    origin: rounded(turned.origin + shift(index)),
                    direction: rounded(turned.direction),
                    t_min: turned.t_min,
                    t_max: f64::from(t_max.min(turned.t_max) as f32),
                }
            })
            .collect();
        Self { cylinders, rays }
    }
}

fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

fn center(problem: &Problem) -> DVec3 {
    0.5 * (problem.cylinder.p0() + problem.cylinder.p1())
}

/// The radius of a ball about the cylinder's center that contains the cylinder
/// and the ray's origin.
fn ball_radius(problem: &Problem) -> f64 {
    let cylinder = &problem.cylinder;
    let half_length = 0.5 * (cylinder.p1() - cylinder.p0()).length();
    let corner = (half_length * half_length + cylinder.radius() * cylinder.radius()).sqrt();
    corner.max((problem.ray.origin - center(problem)).length())
}

fn moved(cylinder: &Cylinder, shift: DVec3) -> Cylinder {
    Cylinder::new(
        rounded(cylinder.p0() + shift),
        rounded(cylinder.p1() + shift),
        cylinder.radius(),
        cylinder.caps(),
    )
    .expect("a cylinder of usual size stays one when it is moved")
}

/// The ray turned about the cylinder's axis.
fn turned(problem: &Problem, angle: f64) -> Ray {
    let cylinder = &problem.cylinder;
    let axis = (cylinder.p1() - cylinder.p0()).normalize();
    let (sin, cos) = libm::sincos(0.5 * angle);
    let turn = DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos);
    Ray {
        origin: cylinder.p0() + turn * (problem.ray.origin - cylinder.p0()),
        direction: turn * problem.ray.direction,
        ..problem.ray
    }
}

/// Where a ray that starts within the ball leaves it: the greater root of
/// `|origin + t direction - center|² = radius²`.
fn leaves_ball(ray: &Ray, center: DVec3, radius: f64) -> f64 {
    let (from, d) = (ray.origin - center, ray.direction);
    let (a, b) = (d.dot(d), from.dot(d));
    let c = from.dot(from) - radius * radius;
    (-b + (b * b - a * c).max(0.0).sqrt()) / a
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::Formulation;
    use crate::samples::{self, Shifted};

    #[test]
    fn spaced_rays_meet_their_own_cylinder_as_before_and_no_other() {
        const SEED: u64 = 4;
        let problems = samples::problems(SEED, 300);
        let spaced = Spaced::new(&problems, 40);
        assert_eq!((spaced.cylinders.len(), spaced.rays.len()), (40, 300));
        let (mut hits, mut changed) = (0, 0);
        for (number, ray) in spaced.rays.iter().enumerate() {
            let pairs: Vec<Problem> = spaced
                .cylinders
                .iter()
                .map(|&cylinder| Problem {
                    cylinder,
                    ray: *ray,
                })
                .collect();
            let met: Vec<usize> = Shifted(0.0)
                .answers(&pairs)
                .iter()
                .enumerate()
                .filter_map(|(index, answer)| answer.map(|_| index))
                .collect();
            let own = number % 40;
            assert!(
                met.is_empty() || met == [own],
                "seed {SEED}, ray {number} meets {met:?}, {ray:?}"
            );
            let before = Shifted(0.0).answers(&problems[own..=own])[0].is_some();
            hits += usize::from(before);
            changed += usize::from(before == met.is_empty());
        }
        // Rounding to f32 may move a ray over an edge, about one in a million.
        assert!(hits > 60 && hits < 240 && changed <= 1, "{hits} {changed}");
    }
}
