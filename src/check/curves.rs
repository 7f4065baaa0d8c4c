//! Embree's own cone curves as a witness: another solver of the same shape.
//!
//! It proves nothing. It is f32, of unknown error, and wrong in known ways
//! (`tests/rival_defects.rs`): directions are made unit length for it, and a
//! disagreement beyond the tolerance is a [`Verdict::Suspect`], which only the
//! oracle can turn against the answer. What it tells is how often two programs
//! that share no code agree.
//!
//! # Which solids
//! Those that are circular cylinders in the mesh, too. With `G = MᵀM` of the
//! map's matrix M and e the unit axis, the image is one if and only if
//! `G = α eeᵀ + β (I - eeᵀ)`; so placements may stretch along the axis and
//! mirror. The defect, the Frobenius norm of what is left of G, is allowed up to
//! `2^-22 min(α, β)`, which changes lengths in the solid by at most 2^-23.
//!
//! # Tolerance
//! Let u = 2^-24. O is the origin's distance from the mesh's origin, P the
//! farther end's, T the way to the hit, `L = length + radius` of the solid hit,
//! r its radius; all lengths in the mesh. To first order:
//!
//! - The ends, the unit direction and the radius are rounded, the origin is
//!   moved next to the segment's middle, and the way there added to `t` again:
//!   each displaces the ray against the solid by a few u of O, P or T, together
//!   at most `4u (O + P + T)`. The map's defect adds at most `2u L`.
//! - From there on Embree solves `A t² + 2 B t + C = 0`, over |a|⁴ an equation
//!   for the squared distance from the axis, with terms of at most L², since the
//!   solid is within L of its own middle. Sixteen roundings in each of A, B and C
//!   make `16u (|t| + L)² <= 64u L²`, and the root some `8u L²` more: the wall is
//!   met where the squared radius differs by 72u L², the radius by `36u L²/r`.
//!   This is the one that grows with L/r and loses long thin cylinders. On a disc
//!   it is `16u L`, which is less.
//!
//! ```text
//! ε = 4u (O + P + T) + 2u L + 36u L² / r
//! ```
//!
//! Where the radius is off by ε, half a chord `s = r cos` is off by at most
//! `2 r ε / s`. So two hits agree if they are apart by at most `2ε` along the
//! normal: `|Δt| |n·d| <= 2ε`. A hit and a miss never agree; near silhouettes
//! the oracle clears them.

use glam::{DAffine3, DMat3, DVec3};

use crate::embree::{Device, Error, GREATEST_COORDINATE, NativeHit, Ray32, Scene, SceneBuilder};
use crate::math::power_of_two;
use crate::solid::{Caps, Cylinder};

/// Half an ulp of 1 in f32.
const U: f64 = power_of_two(-24);

/// The greatest share of `min(α, β)` that the map's defect may be.
const MOST_DEFECT: f64 = power_of_two(-22);

/// A circular cylinder in the space of the meshes, in Embree's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    ends: [[f32; 3]; 2],
    radius: f32,
    neighbours: u8,
}

impl Segment {
    /// The image of a solid; `None` if that is no circular cylinder, or none
    /// that f32 holds.
    pub fn new(cylinder: &Cylinder, mesh_from_object: &DAffine3) -> Option<Self> {
        let axis = (cylinder.p1() - cylinder.p0()).normalize();
        let matrix = mesh_from_object.matrix3;
        let squared = matrix.transpose() * matrix;
        let along = axis.dot(squared * axis);
        let trace = squared.x_axis.x + squared.y_axis.y + squared.z_axis.z;
        let across = (trace - along) / 2.0;
        let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        let circular = DMat3::IDENTITY * across + outer * (along - across);
        let rest = squared - circular;
        let defect = libm::sqrt(
            [rest.x_axis, rest.y_axis, rest.z_axis]
                .map(DVec3::length_squared)
                .iter()
                .sum(),
        );
        let ends = [cylinder.p0(), cylinder.p1()]
            .map(|end| mesh_from_object.transform_point3(end).as_vec3().to_array());
        let radius = (cylinder.radius() * libm::sqrt(across)) as f32;
        let is_held = ends
            .as_flattened()
            .iter()
            .all(|x| x.abs() < GREATEST_COORDINATE)
            && ends[0] != ends[1]
            && (f32::MIN_POSITIVE..GREATEST_COORDINATE).contains(&radius);
        (is_held && defect <= MOST_DEFECT * along.min(across)).then(|| Self {
            ends,
            radius,
            neighbours: neighbours(cylinder.caps()),
        })
    }

    /// `ε` for a ray from `origin` with a hit after `way`.
    fn tolerance(&self, origin: f64, way: f64) -> f64 {
        let [p0, p1] = self.ends.map(wide);
        let radius = f64::from(self.radius);
        let length = (p1 - p0).length() + radius;
        let farther = p0.length().max(p1.length());
        4.0 * U * (origin + farther + way) + 2.0 * U * length + 36.0 * U * length * length / radius
    }
}

/// Embree's flags: an end without a disc is one that a neighbour continues.
fn neighbours(caps: Caps) -> u8 {
    u8::from(!caps.at_p0()) | u8::from(!caps.at_p1()) << 1
}

fn wide(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

/// A hit that an intersector tells of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Told {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// The solid's number in the window, if it is told.
    pub solid: Option<u32>,
}

/// What the curves say of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// They agree within the tolerance.
    Agrees,
    /// The answer may be of a solid that has no curve.
    Unwitnessed,
    /// They do not: the oracle is to be asked. `seen` is the curves' hit, in
    /// lengths of the ray's direction.
    Suspect {
        /// The curves' hit.
        seen: Option<f64>,
    },
}

/// The solids of a window as cone curves in one Embree scene.
pub(crate) struct ConeCurves {
    scene: Scene<()>,
    segments: Vec<Segment>,
    /// Whether the window's solid has a curve.
    has_curve: Vec<bool>,
}

impl ConeCurves {
    /// Builds the curves of a window's solids, `None` for those without.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(device: &Device, solids: &[Option<Segment>]) -> Result<Self, Error> {
        let segments: Vec<Segment> = solids.iter().copied().flatten().collect();
        let vertices: Vec<[f32; 4]> = segments
            .iter()
            .flat_map(|segment| segment.ends.map(|[x, y, z]| [x, y, z, segment.radius]))
            .collect();
        let first: Vec<u32> = (0..segments.len() as u32).map(|index| 2 * index).collect();
        let neighbours: Vec<u8> = segments.iter().map(|segment| segment.neighbours).collect();
        let mut builder = SceneBuilder::new(device)?;
        builder.attach_cone_curves(&vertices, &first, Some(&neighbours))?;
        Ok(Self {
            scene: builder.commit()?,
            segments,
            has_curve: solids.iter().map(Option::is_some).collect(),
        })
    }

    /// How many of the solids have a curve.
    pub fn witnessed_solids(&self) -> usize {
        self.segments.len()
    }

    /// Holds an answer for a ray of the meshes' space against the curves.
    pub fn compare(&self, ray: &Ray32, answer: Option<Told>) -> Verdict {
        if let Some(Told {
            solid: Some(solid), ..
        }) = answer
            && !self.has_curve[solid as usize]
        {
            return Verdict::Unwitnessed;
        }
        let speed = wide(ray.direction).length();
        let hit = self
            .scene
            .closest_native(&with_unit_direction(ray, speed), &mut ());
        let seen = hit.map(|hit| f64::from(hit.t) / speed);
        let is_one = match (&answer, &hit) {
            (None, None) => true,
            (Some(told), Some(hit)) => self.is_one_hit(ray, told.t * speed, hit),
            _ => false,
        };
        let all_have_curves = self.segments.len() == self.has_curve.len();
        match answer {
            _ if is_one => Verdict::Agrees,
            // Of a solid without curve, for all that is known.
            Some(Told { t, solid: None })
                if !all_have_curves && seen.is_none_or(|seen| t < seen) =>
            {
                Verdict::Unwitnessed
            }
            _ => Verdict::Suspect { seen },
        }
    }

    /// Whether a hit after `way` is the curves' one.
    fn is_one_hit(&self, ray: &Ray32, way: f64, hit: &NativeHit) -> bool {
        let seen = f64::from(hit.t);
        let segment = &self.segments[hit.primitive as usize];
        let tolerance = segment.tolerance(wide(ray.origin).length(), way.max(seen));
        let slope = wide(hit.normal)
            .normalize_or_zero()
            .dot(wide(ray.direction).normalize())
            .abs();
        (way - seen).abs() * slope <= 2.0 * tolerance
    }
}

/// The ray with a direction of unit length, nearly the same line.
fn with_unit_direction(ray: &Ray32, speed: f64) -> Ray32 {
    Ray32 {
        origin: ray.origin,
        direction: (wide(ray.direction) / speed).as_vec3().to_array(),
        t_near: (f64::from(ray.t_near) * speed).min(f64::from(f32::MAX)) as f32,
        t_far: (f64::from(ray.t_far) * speed) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::DeviceOptions;
    use crate::math::{Random, Ray};
    use crate::oracle::{ExactAffine, placed_first_hit};

    const SEED: u64 = 92;

    fn random_cylinder(random: &mut Random, longest: f64) -> Cylinder {
        let middle = random.direction() * random.uniform(0.0, 1.0);
        let half = random.direction() * random.log_uniform(0.05, longest / 2.0);
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let radius = random.log_uniform(0.02, 0.2);
        Cylinder::new(middle - half, middle + half, radius, caps).unwrap()
    }

    /// A rotation, a mirror or not, and a uniform scale; then a shift.
    fn similarity(random: &mut Random) -> DAffine3 {
        let axis = random.direction();
        let aside = axis.cross(random.direction()).normalize();
        let turn = DMat3::from_cols(axis, aside, axis.cross(aside));
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        DAffine3 {
            matrix3: turn * (sign * random.uniform(0.5, 1.5)),
            translation: random.direction() * 0.5,
        }
    }

    /// The first hit of the placed solids, by the oracle.
    fn truth(solids: &[Cylinder], maps: &[ExactAffine], ray: &Ray) -> Option<Told> {
        let hits = solids
            .iter()
            .zip(maps)
            .zip(0..)
            .filter_map(|((solid, map), number)| {
                let hit = placed_first_hit(solid, map, ray).hit?;
                Some(Told {
                    t: hit.t_f64(),
                    solid: Some(number),
                })
            });
        hits.min_by(|one, other| one.t.total_cmp(&other.t))
    }

    fn ray(random: &mut Random) -> (Ray32, Ray) {
        let origin = (random.direction() * 3.0).as_vec3();
        let target = (random.direction() * random.uniform(0.0, 1.0)).as_vec3();
        let direction = (target - origin) * random.log_uniform(0.1, 10.0) as f32;
        let ray32 = Ray32 {
            origin: origin.to_array(),
            direction: direction.to_array(),
            t_near: 0.0,
            t_far: f32::INFINITY,
        };
        (ray32, Ray::new(origin.as_dvec3(), direction.as_dvec3()))
    }

    #[test]
    fn segment_takes_circular_images_only() {
        for case in 0..500 {
            let mut random = Random::new(SEED, case);
            let cylinder = random_cylinder(&mut random, 2.0);
            let similar = similarity(&mut random);
            let segment = Segment::new(&cylinder, &similar).unwrap();
            let [p0, p1] = segment.ends.map(wide);
            let ratio = f64::from(segment.radius) / (p1 - p0).length();
            let axis = cylinder.p1() - cylinder.p0();
            let expected = cylinder.radius() / axis.length();
            assert!((ratio / expected - 1.0).abs() < 1e-4, "case {case}");

            let axis = axis.normalize();
            let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
            let after = |first: DMat3| DAffine3 {
                matrix3: similar.matrix3 * first,
                ..similar
            };
            // Along the axis it stays a cylinder of the same radius.
            let stretched = Segment::new(&cylinder, &after(DMat3::IDENTITY + outer)).unwrap();
            let change = f64::from(stretched.radius) / f64::from(segment.radius);
            assert!((change - 1.0).abs() < 1e-6, "case {case}: {change}");
            let aside = axis.any_orthonormal_vector();
            let across = DMat3::from_cols(aside * aside.x, aside * aside.y, aside * aside.z);
            let shear = DMat3::from_cols(aside * axis.x, aside * axis.y, aside * axis.z);
            for small in [across * 1e-6, shear * 1e-6] {
                let map = after(DMat3::IDENTITY + small);
                assert_eq!(Segment::new(&cylinder, &map), None, "case {case}");
            }
        }
    }

    /// Solids of all caps, seen with true answers and with wrong ones.
    #[test]
    fn true_answers_agree_and_wrong_ones_are_suspects() {
        const SCENES: u64 = 40;
        const RAYS: u64 = 100;
        let device = Device::new(&DeviceOptions::default()).unwrap();
        let (mut hits, mut suspects, mut missed) = (0, 0, 0);
        for scene in 0..SCENES {
            let mut random = Random::new(SEED, 1_000 + scene);
            let solids: Vec<Cylinder> =
                (0..20).map(|_| random_cylinder(&mut random, 2.0)).collect();
            let maps: Vec<DAffine3> = (0..20).map(|_| similarity(&mut random)).collect();
            let exact: Vec<ExactAffine> = maps.iter().map(ExactAffine::new).collect();
            let segments: Vec<Option<Segment>> = solids
                .iter()
                .zip(&maps)
                .map(|(solid, map)| Segment::new(solid, map))
                .collect();
            let curves = ConeCurves::new(&device, &segments).unwrap();
            assert_eq!(curves.witnessed_solids(), 20);
            for _ in 0..RAYS {
                let (ray32, ray) = ray(&mut random);
                let told = truth(&solids, &exact, &ray);
                suspects += u64::from(curves.compare(&ray32, told) != Verdict::Agrees);
                let Some(told) = told else { continue };
                hits += 1;
                let behind = Told {
                    t: told.t + 0.01 / ray.direction.length(),
                    ..told
                };
                missed += u64::from(curves.compare(&ray32, Some(behind)) == Verdict::Agrees);
                assert!(matches!(
                    curves.compare(&ray32, None),
                    Verdict::Suspect { .. } | Verdict::Agrees
                ));
            }
        }
        println!("{hits} hits, {suspects} suspects; {missed} hits 0.01 behind agree");
        assert!(
            hits > 2_000 && suspects <= SCENES * RAYS / 500,
            "{suspects}"
        );
        assert!(missed <= hits / 50, "{missed}");
    }

    #[test]
    fn solid_without_curve_is_not_witnessed() {
        let device = Device::new(&DeviceOptions::default()).unwrap();
        let map = DAffine3::IDENTITY;
        let curved = Cylinder::new(DVec3::ZERO, DVec3::Z, 0.5, Caps::Both).unwrap();
        let curves = ConeCurves::new(&device, &[None, Segment::new(&curved, &map)]).unwrap();
        let ray = Ray32 {
            origin: [-3.0, 0.0, 0.5],
            direction: [0.5, 0.0, 0.0],
            t_near: 0.0,
            t_far: f32::INFINITY,
        };
        let told = |t, solid| Some(Told { t, solid });
        let seen = Some(5.0);
        assert_eq!(curves.compare(&ray, told(5.0, Some(1))), Verdict::Agrees);
        assert_eq!(curves.compare(&ray, told(5.0, None)), Verdict::Agrees);
        assert_eq!(
            curves.compare(&ray, told(4.0, Some(0))),
            Verdict::Unwitnessed
        );
        assert_eq!(curves.compare(&ray, told(4.0, None)), Verdict::Unwitnessed);
        assert_eq!(
            curves.compare(&ray, told(4.0, Some(1))),
            Verdict::Suspect { seen }
        );
        assert_eq!(
            curves.compare(&ray, told(6.0, None)),
            Verdict::Suspect { seen }
        );
        assert_eq!(curves.compare(&ray, None), Verdict::Suspect { seen });
    }
}
