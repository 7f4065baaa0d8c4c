//! What a regularised set has at a point, and what a line meets of it, from samples.
//!
//! Shares nothing with the library but the statement of the solids. Around a point the
//! formula of the operations is evaluated at many places `p + ε v + ε² w`: for `v` all
//! around, in the tangent planes of all leaves there and where two of them cross, and
//! for `w` across `v`. Surfaces of whole numbers of this size that leave an open cell at
//! the point leave one at that scale: slivers between surfaces that touch are as thick
//! as the difference of curvatures times ε² / 2.

use cyltrace::math::Random;
use cyltrace::solid::{AnySolid, Composition, Crossing, Location, Part};
use glam::DVec3;

/// The distance ε of the samples. ε² is far above the roundings, and ε far below the square
/// of the distance of features, which is how near a surface comes that a line touches there.
const NEAR: f64 = 3e-5;

/// Below this distance surfaces count as passing through a point: roundings are 1e-14.
const TOUCHES: f64 = 1e-10;

/// `side * (distance beyond)` of each surface of a leaf with its part; negative inside.
fn beyond(solid: &AnySolid, point: DVec3) -> Vec<(Part, f64)> {
    let cone = |p0: DVec3, p1: DVec3, r0: f64, r1: f64| {
        let (a, x) = (p1 - p0, point - p0);
        let length = a.length();
        let height = x.dot(a) / length;
        let distance = x.cross(a).length() / length;
        let slope = (r1 - r0) / length;
        let wall = (distance - r0 - slope * height) / (1.0 + slope * slope).sqrt();
        vec![
            (Part::Cap0, -height),
            (Part::Cap1, height - length),
            (Part::Side, wall),
        ]
    };
    match solid {
        AnySolid::Cylinder(one) => cone(one.p0(), one.p1(), one.radius(), one.radius()),
        AnySolid::Cone(one) => cone(one.p0(), one.p1(), one.radius0(), one.radius1()),
        AnySolid::Sphere(one) => {
            vec![(Part::Side, (point - one.center()).length() - one.radius())]
        }
        AnySolid::Cuboid(one) => {
            let x = point - one.center();
            let h = one.half_widths();
            vec![
                (Part::XMin, -x.x - h.x),
                (Part::XMax, x.x - h.x),
                (Part::YMin, -x.y - h.y),
                (Part::YMax, x.y - h.y),
                (Part::ZMin, -x.z - h.z),
                (Part::ZMax, x.z - h.z),
            ]
        }
        other => unreachable!("{other:?} is not drawn"),
    }
}

fn is_within(solid: &AnySolid, point: DVec3) -> bool {
    beyond(solid, point).iter().all(|(_, beyond)| *beyond < 0.0)
}

/// The formula at a point that is on no boundary.
fn holds(composition: &Composition, point: DVec3) -> bool {
    let mut parts = match composition {
        Composition::Solid(solid) => return is_within(solid, point),
        Composition::Union(parts) => return parts.iter().any(|part| holds(part, point)),
        Composition::Intersection(parts) => return parts.iter().all(|part| holds(part, point)),
        Composition::Difference(parts) => parts.iter(),
    };
    parts.next().is_some_and(|first| holds(first, point)) && !parts.any(|part| holds(part, point))
}

/// The gradient of a surface of a leaf, by differences that are exact enough for a plane.
fn normal(solid: &AnySolid, part: Part, point: DVec3) -> DVec3 {
    let step = 1e-5;
    let value = |point: DVec3| {
        let all = beyond(solid, point);
        all.into_iter()
            .find(|one| one.0 == part)
            .expect("the part")
            .1
    };
    let along = |axis: DVec3| value(point + axis * step) - value(point - axis * step);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)).normalize()
}

/// The surfaces of leaves that pass through a point, as leaf, part and normal.
fn surfaces(solids: &[AnySolid], point: DVec3) -> Vec<(u32, Part, DVec3)> {
    let mut found = Vec::new();
    for (leaf, solid) in (0..).zip(solids) {
        let all = beyond(solid, point);
        if all.iter().any(|one| one.1 > TOUCHES) {
            continue;
        }
        for (part, distance) in all {
            if distance.abs() <= TOUCHES {
                found.push((leaf, part, normal(solid, part, point)));
            }
        }
    }
    found
}

/// Some unit vector across another.
fn across(v: DVec3, random: &mut Random) -> DVec3 {
    loop {
        let w = random.direction();
        let w = w - v * w.dot(v);
        if w.length() > 0.1 {
            return w.normalize();
        }
    }
}

/// The set as samples see it.
pub struct Reference<'a> {
    composition: &'a Composition,
    pub solids: Vec<AnySolid>,
}

impl<'a> Reference<'a> {
    pub fn new(composition: &'a Composition) -> Self {
        Self {
            composition,
            solids: composition.solids(),
        }
    }

    /// What the set has at a point.
    pub fn locate(&self, point: DVec3) -> Location {
        let surfaces = surfaces(&self.solids, point);
        if surfaces.is_empty() {
            return if holds(self.composition, point) {
                Location::Inside
            } else {
                Location::Outside
            };
        }
        let mut random = Random::new(17, point.x.to_bits() ^ point.y.to_bits().rotate_left(21));
        let mut values = [false; 2];
        let near: Vec<&AnySolid> = (0..)
            .zip(&self.solids)
            .filter(|(leaf, _)| surfaces.iter().any(|one| one.0 == *leaf))
            .map(|(_, solid)| solid)
            .collect();
        let mut sample = |at: DVec3| {
            // Not on a surface itself.
            let all = near.iter().flat_map(|solid| beyond(solid, at));
            if all.into_iter().all(|(_, beyond)| beyond.abs() > 1e-13) {
                values[usize::from(holds(self.composition, at))] = true;
            }
        };
        for _ in 0..100 {
            sample(point + random.direction() * NEAR);
        }
        let mut special = Vec::new();
        for (leaf, ..) in &surfaces {
            // Into an apex, and what is beside its wall.
            if let AnySolid::Cone(cone) = &self.solids[*leaf as usize] {
                let axis = (cone.p1() - cone.p0()).normalize();
                for _ in 0..60 {
                    let v = axis + across(axis, &mut random) * random.uniform(0.0, 2.0);
                    special.extend([v.normalize(), -v.normalize()]);
                }
            }
        }
        for (index, (_, _, n)) in surfaces.iter().enumerate() {
            for _ in 0..16 {
                special.push(across(*n, &mut random));
            }
            for (_, _, m) in &surfaces[..index] {
                let edge = n.cross(*m);
                if edge.length() > 1e-3 {
                    special.extend([edge.normalize(), -edge.normalize()]);
                }
            }
        }
        for v in special {
            for _ in 0..12 {
                let w = across(v, &mut random) * random.uniform(0.0, 1.0);
                sample(point + v * NEAR + w * (NEAR * NEAR));
            }
            for (_, _, n) in &surfaces {
                for share in [-0.75, -0.3, -0.2, -0.1, -0.03, -0.01, 0.01, 0.1] {
                    sample(point + v * NEAR + *n * (share * NEAR * NEAR));
                }
            }
        }
        match values {
            [true, true] => Location::Boundary,
            [false, true] => Location::Inside,
            _ => Location::Outside,
        }
    }

    /// Whether a leaf's part is the surface of the set at a point, with the set on the side
    /// from which `outward` points.
    pub fn has_face(&self, point: DVec3, leaf: u32, part: Part, outward: DVec3) -> bool {
        let solid = &self.solids[leaf as usize];
        let mut random = Random::new(19, leaf.into());
        if let AnySolid::Cone(cone) = solid
            && [(Part::Cap0, cone.radius0()), (Part::Cap1, cone.radius1())].contains(&(part, 0.0))
        {
            // An apex: the wall around it, represented by the axis.
            let axis = (cone.p1() - cone.p0()) * if part == Part::Cap0 { -1.0 } else { 1.0 };
            let is_reversed = axis.dot(outward) < 0.0;
            return (0..400).any(|_| {
                let at = point + random.direction() * NEAR;
                let wall = beyond(solid, at)[2].1;
                let [inner, outer] =
                    [1.01, 0.99].map(|share| at - normal(solid, Part::Side, at) * (wall * share));
                is_within(solid, inner) != is_within(solid, outer)
                    && holds(self.composition, inner) != is_reversed
                    && holds(self.composition, outer) == is_reversed
            });
        }
        let n = normal(solid, part, point);
        let sign = n.dot(outward).signum();
        // A place of this surface itself near the point, by Newton's method.
        let onto = |mut at: DVec3| {
            for _ in 0..3 {
                let all = beyond(solid, at);
                let off = all.iter().find(|one| one.0 == part).expect("the part").1;
                at -= normal(solid, part, at) * off;
            }
            at
        };
        // All around, and beside the directions in which another surface crosses this one.
        let mut ways: Vec<DVec3> = (0..400).map(|_| across(n, &mut random) * NEAR).collect();
        for (_, _, other) in surfaces(&self.solids, point) {
            let edge = n.cross(other);
            if edge.length() > 1e-3 {
                for _ in 0..100 {
                    let side = random.uniform(-1.0, 1.0).signum();
                    let w = across(edge.normalize(), &mut random) * random.uniform(0.0, 1.0);
                    ways.push(edge.normalize() * (side * NEAR) + w * (NEAR * NEAR));
                }
            }
        }
        ways.into_iter().any(|way| {
            let at = onto(point + way);
            let step = normal(solid, part, at) * (1e-3 * NEAR * NEAR);
            let [inner, outer] = [at - step * sign, at + step * sign];
            holds(self.composition, inner)
                && !holds(self.composition, outer)
                && is_within(solid, inner) != is_within(solid, outer)
        })
    }

    /// The parameters at which a line meets the surface of a leaf, extended or not.
    fn stations(&self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let mut all = Vec::new();
        let mut quadratic = |a: f64, b: f64, c: f64| {
            // a t² + 2 b t + c; a double root is found up to a rounding.
            let size = b * b + (a * c).abs();
            let mut discriminant = b * b - a * c;
            if discriminant.abs() < 1e-13 * size {
                discriminant = 0.0;
            }
            if a.abs() > 1e-13 && discriminant >= 0.0 {
                let root = discriminant.sqrt();
                all.extend([(-b - root) / a, (-b + root) / a]);
            } else if b.abs() > 1e-13 {
                all.push(-0.5 * c / b);
            }
        };
        for solid in &self.solids {
            let mut cone = |p0: DVec3, p1: DVec3, r0: f64, r1: f64| {
                let (a, x) = (p1 - p0, origin - p0);
                let length = a.length();
                let (y, s) = (x.dot(a) / length, direction.dot(a) / length);
                quadratic(0.0, 0.5 * s, y);
                quadratic(0.0, 0.5 * s, y - length);
                let k = (r1 - r0) / length;
                let tilt = 1.0 + k * k;
                let g = r0;
                quadratic(
                    direction.dot(direction) - s * s * tilt,
                    x.dot(direction) - y * s * tilt - g * k * s,
                    x.dot(x) - y * y * tilt - 2.0 * g * k * y - g * g,
                );
            };
            match solid {
                AnySolid::Cylinder(one) => cone(one.p0(), one.p1(), one.radius(), one.radius()),
                AnySolid::Cone(one) => cone(one.p0(), one.p1(), one.radius0(), one.radius1()),
                AnySolid::Sphere(one) => {
                    let (x, r) = (origin - one.center(), one.radius());
                    quadratic(direction.dot(direction), x.dot(direction), x.dot(x) - r * r);
                }
                AnySolid::Cuboid(one) => {
                    let x = origin - one.center();
                    for axis in 0..3 {
                        for side in [-1.0, 1.0] {
                            let height = x[axis] - side * one.half_widths()[axis];
                            quadratic(0.0, 0.5 * direction[axis], height);
                        }
                    }
                }
                other => unreachable!("{other:?} is not drawn"),
            }
        }
        all.sort_by(f64::total_cmp);
        all.dedup_by(|next, last| *next - *last < 1e-9);
        all
    }

    /// What a line meets of the set: its closed components, and the points of the
    /// boundary between stretches inside. `None` where two stations are too near for the
    /// samples.
    pub fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<Vec<(f64, Crossing)>> {
        use Crossing::{Enter, Leave};
        let stations = self.stations(origin, direction);
        let least = 5.0 * NEAR.sqrt() / direction.length();
        if stations.windows(2).any(|pair| pair[1] - pair[0] < least) {
            return None;
        }
        let at = |t: f64| self.locate(origin + direction * t);
        let mut found = Vec::new();
        let mut before = Location::Outside;
        for (index, &t) in stations.iter().enumerate() {
            let behind = stations
                .get(index + 1)
                // Not the middle, where symmetric models have more.
                .map_or(Location::Outside, |next| at(t + 0.4375 * (next - t)));
            match (before.is_held(), behind.is_held()) {
                (false, true) => found.push((t, Enter)),
                (true, false) => found.push((t, Leave)),
                (false, false) if at(t).is_held() => found.extend([(t, Enter), (t, Leave)]),
                (true, true)
                    if [before, behind] == [Location::Inside; 2] && at(t) != Location::Inside =>
                {
                    found.extend([(t, Leave), (t, Enter)]);
                }
                _ => {}
            }
            before = behind;
        }
        Some(found)
    }
}
