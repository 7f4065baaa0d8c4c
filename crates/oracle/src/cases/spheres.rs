//! Spheres and rays that are hard for them.

use glam::DVec3;

use super::Inputs;
use super::aiming::{Aim, whole};
use super::any::HardCases;
use super::shapes::{Round, scale_and_speed};
use cyltrace::math::{Random, Ray};
use cyltrace::solid::Sphere;

/// A family of spheres and rays that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SphereFamily {
    /// Seen from 1 to 20 radii away, at up to 1.3 radii from the center.
    Uniform,
    /// At `1 ∓ 1e-16..1e-3` radii from the center.
    Graze,
    /// Tangents to the last bit, in whole numbers.
    Tangent,
    /// Seen from 1e2 to 1e7 radii away.
    Far,
    /// 1e4 to 1e7 radii from the scene's origin.
    Offset,
    /// From a point within.
    Inside,
    /// From a point of the surface.
    Surface,
    /// All lengths times 1e-20 to 1e20, directions times 1e-10 to 1e10.
    Scale,
}

impl SphereFamily {
    /// All families.
    pub const ALL: [Self; 8] = [
        Self::Uniform,
        Self::Graze,
        Self::Tangent,
        Self::Far,
        Self::Offset,
        Self::Inside,
        Self::Surface,
        Self::Scale,
    ];

    /// Case `index`, unless its rounded numbers are no sphere and ray.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Option<(Sphere, Ray)> {
        let mut random = Random::new(seed, (0x0BA1 << 48) | ((self as u64) << 40) | index);
        if self == Self::Tangent {
            return tangent(&mut random);
        }
        let (scale, speed) = scale_and_speed(&mut random, self == Self::Scale);
        let Round { center, radius } =
            Round::draw(&mut random, inputs, scale, self == Self::Offset);
        let sphere = Sphere::new(center, radius).ok()?;
        let heading = random.direction();
        let across = heading.cross(random.direction()).try_normalize()?;
        let share = match self {
            Self::Graze => 1.0 + random.uniform(-1.0, 1.0) * random.log_uniform(1e-16, 1e-3),
            _ => 1.3 * random.unit(),
        };
        let ray = match self {
            Self::Inside => {
                let off = random.direction() * (radius * 0.98 * libm::cbrt(random.unit()));
                Aim::new(center + off, heading).unaimed_ray(0.0, speed, inputs)
            }
            Self::Surface => {
                let off = random.direction() * radius;
                Aim::new(center + off, heading).unaimed_ray(0.0, speed, inputs)
            }
            _ => {
                let distance = radius
                    * match self {
                        Self::Far => random.log_uniform(1e2, 1e7),
                        _ => random.uniform(1.0, 20.0),
                    };
                let aim = Aim::new(center + across * (radius * share), heading);
                aim.ray(distance, speed, inputs)
            }
        };
        Some((sphere, ray?))
    }
}

/// A line past the center at a right angle to a Pythagorean triple's hypotenuse, in
/// any of the coordinate planes.
fn tangent(random: &mut Random) -> Option<(Sphere, Ray)> {
    const TRIPLES: [[f64; 3]; 4] = [
        [3.0, 4.0, 5.0],
        [5.0, 12.0, 13.0],
        [8.0, 15.0, 17.0],
        [7.0, 24.0, 25.0],
    ];
    let [a, b, hypotenuse] = TRIPLES[random.below(4) as usize];
    let (i, times) = (random.below(3) as usize, 1.0 + random.below(4) as f64);
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let mut touch = DVec3::ZERO;
    (touch[i], touch[j]) = (a * times, b * times);
    let mut along = DVec3::ZERO;
    // Across the way to the point of contact, with any part along the third axis.
    (along[i], along[j], along[k]) = (-b, a, random.below(9) as f64 - 4.0);
    let center = whole(random, 50);
    let steps = random.below(64) as f64 - 16.0;
    let sphere = Sphere::new(center, hypotenuse * times).ok()?;
    Some((sphere, Ray::new(center + touch - along * steps, along)))
}

impl HardCases for Sphere {
    type Family = SphereFamily;

    const FAMILIES: &'static [SphereFamily] = &SphereFamily::ALL;

    fn draw(family: SphereFamily, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        family.case(seed, index, inputs)
    }
}
