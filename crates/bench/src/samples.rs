//! Small problems and contenders for the tests of this layer.

use glam::DVec3;

use crate::formulations::{Answer, Batch, Formulation, Precision, Problem};
use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cylinder, triple_product};

/// Cylinders of about unit size and rays aimed at them, all in f32 numbers.
pub fn problems(seed: u64, count: u64) -> Vec<Problem> {
    (0..count).map(|index| problem(seed, index)).collect()
}

fn problem(seed: u64, index: u64) -> Problem {
    let mut random = Random::new(seed, index);
    let rounded = |point: DVec3| point.as_vec3().as_dvec3();
    let length = random.uniform(1.0, 4.0);
    let p0 = random.direction();
    let p1 = p0 + random.direction() * length;
    let radius = f64::from(random.uniform(0.2, 0.6) as f32);
    let caps = [Caps::Both, Caps::None, Caps::P0, Caps::P1][random.below(4) as usize];
    let target = p0.lerp(p1, random.unit()) + random.direction() * (1.5 * radius);
    let origin = target + random.direction() * random.uniform(5.0, 10.0);
    let direction = (target - origin).normalize();
    Problem {
        cylinder: Cylinder::new(rounded(p0), rounded(p1), radius, caps).unwrap(),
        ray: Ray::new(rounded(origin), rounded(direction)),
    }
}

/// The triple product, with `t` too great by a constant.
pub struct Shifted(pub f64);

impl Formulation for Shifted {
    fn name(&self) -> &'static str {
        "shifted"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn bytes(&self) -> usize {
        57
    }

    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
        let answer = |problem: &Problem| {
            let Problem { cylinder, ray } = problem;
            let chord = triple_product::chord(cylinder, ray.origin - cylinder.p0(), ray.direction)?;
            let intersection = chord.first(cylinder.caps(), 0.0, ray.t_min, ray.t_max)?;
            Some(Answer {
                t: intersection.t + self.0,
                part: intersection.part,
                normal: DVec3::Z,
            })
        };
        problems.iter().map(answer).collect()
    }

    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
        Box::new(Counted(self.answers(problems).len() as u64))
    }
}

/// Sees nothing.
pub struct Blind;

impl Formulation for Blind {
    fn name(&self) -> &'static str {
        "blind"
    }

    fn precision(&self) -> Precision {
        Precision::F32
    }

    fn bytes(&self) -> usize {
        0
    }

    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
        vec![None; problems.len()]
    }

    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
        Box::new(Counted(problems.len() as u64))
    }
}

/// Work without work.
struct Counted(u64);

impl Batch for Counted {
    fn run(&self) -> u64 {
        self.0
    }
}
