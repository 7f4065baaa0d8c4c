//! The first point of a cylinder's surface on a ray, exactly.
//!
//! All points that can be the answer are listed, each is checked against the
//! definition of the surface, and the least is taken. With `a = p1 - p0`,
//! `x = o - p0`, a point of the line is at distance `radius` from the axis
//! where `A t² + 2 B t + C = 0`:
//!
//! ```text
//! A = a·a d·d - (a·d)²
//! B = a·a x·d - (a·x)(a·d)
//! C = a·a (x·x - radius²) - (a·x)²
//! ```
//!
//! These are the dot products of the textbook, which lose everything in
//! floating point and nothing here. A root is on the wall if
//! `0 <= a·x + t a·d <= a·a`; at equality it is on a rim, and belongs to the
//! disk if there is one. A disk is hit where `a·x + t a·d` is 0 or `a·a`, if
//! the point is within `radius` of the disk's middle. A ray within the plane of
//! a disk, or along the wall, touches the surface over an interval of `t`: its
//! ends and the start of the range are listed.

use std::cmp::Ordering;

use super::affine::ExactAffine;
use super::number::{Exact, ExactVector, Surd, exact, long, sign, to_f64, zero};
use super::ray::ExactRay;
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Crossing, Cylinder, Part};

/// The exact answer for one ray and one cylinder.
#[derive(Clone, Debug)]
pub struct CylinderTruth {
    /// The first hit, if there is one.
    pub hit: Option<TrueHit>,
    /// `(radius² - distance²) / radius²` in size, with `distance` that between
    /// the ray's line and the axis: how near the line comes to touching the
    /// infinite wall. Infinite for a line parallel to the axis.
    pub wall_gap: f64,
}

/// Where the ray meets the surface first.
#[derive(Clone, Debug)]
pub struct TrueHit {
    /// The parameter, to several hundred bits.
    pub t: Exact,
    /// The part of the surface.
    pub part: Part,
    /// The direction of the crossing.
    pub crossing: Crossing,
}

impl TrueHit {
    /// The f64 nearest to the parameter.
    #[must_use]
    pub fn t_f64(&self) -> f64 {
        to_f64(&self.t)
    }
}

/// A point that may be the answer.
struct Candidate {
    t: Surd,
    part: Part,
    crossing: Crossing,
}

/// The line and the cylinder in exact numbers, in any unit of length.
struct Problem {
    caps: Caps,
    a: ExactVector,
    x: ExactVector,
    d: ExactVector,
    aa: Exact,
    ax: Exact,
    ad: Exact,
    rr: Exact,
}

/// The least `t` in the ray's range on the surface of the cylinder.
///
/// # Panics
/// When the ray is not valid ([`Ray::is_valid`]).
#[must_use]
pub fn first_hit(cylinder: &Cylinder, ray: &Ray) -> CylinderTruth {
    truth(cylinder, &ExactRay::new(ray))
}

/// The same for a cylinder that is placed in the ray's space.
///
/// # Panics
/// When the ray is not valid, or the placement's matrix is singular.
#[must_use]
pub fn placed_first_hit(
    cylinder: &Cylinder,
    world_from_object: &ExactAffine,
    ray: &Ray,
) -> CylinderTruth {
    truth(cylinder, &ExactRay::through(world_from_object, ray))
}

fn truth(cylinder: &Cylinder, ray: &ExactRay) -> CylinderTruth {
    let a = &ray.point(cylinder.p1()) - &ray.point(cylinder.p0());
    let x = ray.origin_from(cylinder.p0());
    let (d, radius) = (ray.direction.clone(), ray.length(cylinder.radius()));
    let problem = Problem {
        caps: cylinder.caps(),
        aa: a.dot(&a),
        ax: a.dot(&x),
        ad: a.dot(&d),
        rr: &radius * &radius,
        a,
        x,
        d,
    };
    problem.solve(ray)
}

/// Of two candidates at one `t`, the disk and the entry come first.
fn rank(candidate: &Candidate) -> (bool, Crossing) {
    (candidate.part == Part::Side, candidate.crossing)
}

impl Problem {
    fn solve(&self, ray: &ExactRay) -> CylinderTruth {
        let mut candidates = Vec::new();
        let wall_gap = self.list_wall(ray, &mut candidates);
        if sign(&self.ad) != Ordering::Equal {
            self.list_disk(Part::Cap0, &mut candidates);
            self.list_disk(Part::Cap1, &mut candidates);
        }
        let in_range = |candidate: &Candidate| {
            candidate.t.cmp_f64(ray.t_min) != Ordering::Less
                && candidate.t.cmp_f64(ray.t_max) != Ordering::Greater
        };
        let first = candidates
            .into_iter()
            .filter(in_range)
            .min_by(|one, other| one.t.cmp_exact(&other.t).then(rank(one).cmp(&rank(other))));
        let hit = first.map(|first| TrueHit {
            t: first.t.value(),
            part: first.part,
            crossing: first.crossing,
        });
        CylinderTruth { hit, wall_gap }
    }

    fn has(&self, part: Part) -> bool {
        match part {
            Part::Side => true,
            Part::Cap0 => self.caps.at_p0(),
            Part::Cap1 => self.caps.at_p1(),
            part => not_of_a_cylinder(part),
        }
    }

    /// The part of the surface at a point of the closed wall at which
    /// `a·x + t a·d` compares with 0 and with `a·a` as given.
    fn part_at(&self, to_p0: Ordering, to_p1: Ordering) -> Option<Part> {
        match (to_p0, to_p1) {
            (Ordering::Less, _) | (_, Ordering::Greater) => None,
            (Ordering::Equal, _) if self.has(Part::Cap0) => Some(Part::Cap0),
            (_, Ordering::Equal) if self.has(Part::Cap1) => Some(Part::Cap1),
            _ => Some(Part::Side),
        }
    }

    /// Lists where the line meets the wall and answers with the gap.
    fn list_wall(&self, ray: &ExactRay, candidates: &mut Vec<Candidate>) -> f64 {
        let dd = self.d.dot(&self.d);
        let xd = self.x.dot(&self.d);
        let a = &self.aa * &dd - &self.ad * &self.ad;
        let b = &self.aa * &xd - &self.ax * &self.ad;
        let c = &self.aa * (self.x.dot(&self.x) - &self.rr) - &self.ax * &self.ax;
        if sign(&a) == Ordering::Equal {
            if sign(&c) == Ordering::Equal {
                self.list_line_on_wall(ray, candidates);
            }
            return f64::INFINITY;
        }
        let s = &b * &b - &a * &c;
        let gap = long(&s) / long(&(&self.aa * &self.rr * &a));
        if sign(&s) != Ordering::Less {
            let roots = [
                (exact(-1.0), Crossing::Enter),
                (exact(1.0), Crossing::Leave),
            ]
            .map(|(q, crossing)| {
                (
                    Surd {
                        p: -&b,
                        q,
                        s: s.clone(),
                        r: a.clone(),
                    },
                    crossing,
                )
            });
            self.list_line_in_disk(ray, &roots, candidates);
            for (t, crossing) in roots {
                let to_p0 = t.sign_of_line(&self.ax, &self.ad);
                let to_p1 = t.sign_of_line(&(&self.ax - &self.aa), &self.ad);
                if let Some(part) = self.part_at(to_p0, to_p1) {
                    candidates.push(Candidate { t, part, crossing });
                }
            }
        }
        to_f64(&gap).abs()
    }

    /// A line within the wall, parallel to the axis: from rim to rim.
    fn list_line_on_wall(&self, ray: &ExactRay, candidates: &mut Vec<Candidate>) {
        let at_p0 = Surd::quotient(-&self.ax, self.ad.clone());
        let at_p1 = Surd::quotient(&self.aa - &self.ax, self.ad.clone());
        let rim = |cap| if self.has(cap) { cap } else { Part::Side };
        let forward = sign(&self.ad) == Ordering::Greater;
        let ends = [(at_p0, Part::Cap0, forward), (at_p1, Part::Cap1, !forward)];
        self.list_start(ray, &ends[0].0, &ends[1].0, Part::Side, candidates);
        for (t, cap, enters) in ends {
            let crossing = if enters {
                Crossing::Enter
            } else {
                Crossing::Leave
            };
            candidates.push(Candidate {
                t,
                part: rim(cap),
                crossing,
            });
        }
    }

    /// A line within the plane of a disk touches the disk between the roots.
    fn list_line_in_disk(
        &self,
        ray: &ExactRay,
        roots: &[(Surd, Crossing); 2],
        candidates: &mut Vec<Candidate>,
    ) {
        if sign(&self.ad) != Ordering::Equal {
            return;
        }
        for (cap, height) in [(Part::Cap0, zero()), (Part::Cap1, self.aa.clone())] {
            if self.ax == height && self.has(cap) {
                self.list_start(ray, &roots[0].0, &roots[1].0, cap, candidates);
            }
        }
    }

    /// Lists the start of the range if it is strictly between two points
    /// between which the line runs within `part`.
    fn list_start(
        &self,
        ray: &ExactRay,
        one: &Surd,
        other: &Surd,
        part: Part,
        candidates: &mut Vec<Candidate>,
    ) {
        let to_ends = [one.cmp_f64(ray.t_min), other.cmp_f64(ray.t_min)];
        if matches!(
            to_ends,
            [Ordering::Less, Ordering::Greater] | [Ordering::Greater, Ordering::Less]
        ) {
            let t = Surd::whole(exact(ray.t_min));
            candidates.push(Candidate {
                t,
                part,
                crossing: Crossing::Enter,
            });
        }
    }

    /// Lists where a line that is not parallel to the disks meets one.
    fn list_disk(&self, cap: Part, candidates: &mut Vec<Candidate>) {
        if !self.has(cap) {
            return;
        }
        // From the disk's middle: y = x or x - a, a·y + t a·d = 0.
        let (y, ay) = match cap {
            Part::Cap1 => (&self.x - &self.a, &self.ax - &self.aa),
            _ => (self.x.clone(), self.ax.clone()),
        };
        // The point times a·d, so that nothing is divided.
        let point = &y.times(&self.ad) - &self.d.times(&ay);
        if point.dot(&point) > &self.rr * &self.ad * &self.ad {
            return;
        }
        let enters = (cap == Part::Cap0) == (sign(&self.ad) == Ordering::Greater);
        let crossing = if enters {
            Crossing::Enter
        } else {
            Crossing::Leave
        };
        candidates.push(Candidate {
            t: Surd::quotient(-ay, self.ad.clone()),
            part: cap,
            crossing,
        });
    }
}

/// The panic where a part of a cylinder is expected and another is given.
#[cold]
pub(crate) fn not_of_a_cylinder(part: Part) -> ! {
    unreachable!("a cylinder has no part {}", part.name())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn answer(
        caps: Caps,
        origin: [f64; 3],
        direction: [f64; 3],
        t_min: f64,
    ) -> Option<(f64, Part)> {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * 2.0, 1.0, caps).unwrap();
        let ray = Ray {
            t_min,
            ..Ray::new(DVec3::from(origin), DVec3::from(direction))
        };
        first_hit(&cylinder, &ray)
            .hit
            .map(|hit| (hit.t_f64(), hit.part))
    }

    #[test]
    fn textbook_cases_have_their_known_answers() {
        let side = |t| Some((t, Part::Side));
        let cap0 = |t| Some((t, Part::Cap0));
        // Through the wall, from outside and from inside.
        assert_eq!(
            answer(Caps::Both, [-3.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.0),
            side(2.0)
        );
        assert_eq!(
            answer(Caps::Both, [0.0, 0.0, 1.0], [2.0, 0.0, 0.0], 0.0),
            side(0.5)
        );
        // Tangent to the wall, and just past it.
        assert_eq!(
            answer(Caps::Both, [-3.0, 1.0, 1.0], [1.0, 0.0, 0.0], 0.0),
            side(3.0)
        );
        assert_eq!(
            answer(
                Caps::Both,
                [-3.0, 1.0_f64.next_up(), 1.0],
                [1.0, 0.0, 0.0],
                0.0
            ),
            None
        );
        // Along the axis, with and without disks.
        assert_eq!(
            answer(Caps::Both, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0], 0.0),
            cap0(5.0)
        );
        assert_eq!(
            answer(Caps::P1, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0], 0.0),
            Some((7.0, Part::Cap1))
        );
        assert_eq!(
            answer(Caps::None, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0], 0.0),
            None
        );
        // Along the wall: the rim, then the wall from the start of the range.
        assert_eq!(
            answer(Caps::Both, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0], 0.0),
            cap0(5.0)
        );
        assert_eq!(
            answer(Caps::None, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0], 0.0),
            side(5.0)
        );
        assert_eq!(
            answer(Caps::Both, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0], 5.5),
            side(5.5)
        );
        // In the plane of a disk: its rim, the disk from the start, or the
        // edge of an open wall.
        assert_eq!(
            answer(Caps::Both, [-3.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0),
            cap0(2.0)
        );
        assert_eq!(
            answer(Caps::Both, [-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0),
            cap0(0.0)
        );
        assert_eq!(
            answer(Caps::None, [-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0),
            side(1.5)
        );
    }
}
