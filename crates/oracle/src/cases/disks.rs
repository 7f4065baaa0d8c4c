//! Disks and rays that are hard for them.

use glam::DVec3;

use super::Inputs;
use super::aiming::{Aim, sign, whole};
use super::any::HardCases;
use super::shapes::{Round, scale_and_speed};
use cyltrace::math::{Random, Ray};
use cyltrace::solid::Disk;

/// A family of disks and rays that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DiskFamily {
    /// Seen from 1 to 20 radii away, through and beside it.
    Uniform,
    /// Past the rim at up to 1e-16 to 1e-3 radii.
    Rim,
    /// Through a point of the rim to the last bit, in whole numbers.
    ExactRim,
    /// At 1e-7 to 1e-2 to the plane.
    Graze,
    /// Within the plane to the last bit, in whole numbers; some touch the rim.
    WithinPlane,
    /// Seen from 1e2 to 1e7 radii away.
    Far,
    /// 1e4 to 1e7 radii from the scene's origin.
    Offset,
    /// From a point of the disk.
    Surface,
    /// Lengths times 1e-20 to 1e20, directions and normals times 1e-10 to 1e10.
    Scale,
}

impl DiskFamily {
    /// All families.
    pub const ALL: [Self; 9] = [
        Self::Uniform,
        Self::Rim,
        Self::ExactRim,
        Self::Graze,
        Self::WithinPlane,
        Self::Far,
        Self::Offset,
        Self::Surface,
        Self::Scale,
    ];

    /// Case `index`, unless its rounded numbers are no disk and ray.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Option<(Disk, Ray)> {
        let mut random = Random::new(seed, (0x0D15 << 48) | ((self as u64) << 40) | index);
        match self {
            Self::ExactRim | Self::WithinPlane => self.whole_case(&mut random),
            _ => self.rounded_case(&mut random, inputs),
        }
    }

    fn rounded_case(self, random: &mut Random, inputs: Inputs) -> Option<(Disk, Ray)> {
        let (scale, speed) = scale_and_speed(random, self == Self::Scale);
        let Round { center, radius } = Round::draw(random, inputs, scale, self == Self::Offset);
        let normal = inputs.vector(random.direction() * speed);
        let disk = Disk::new(center, normal, radius).ok()?;
        let across = normal.cross(random.direction()).try_normalize()?;
        let share = match self {
            Self::Rim => 1.0 + random.uniform(-1.0, 1.0) * random.log_uniform(1e-16, 1e-3),
            Self::Surface => 0.98 * random.unit(),
            _ => 1.3 * random.unit(),
        };
        let heading = match self {
            Self::Graze => {
                let within = normal.cross(random.direction()).try_normalize()?;
                let up = normal.normalize() * random.log_uniform(1e-7, 1e-2);
                (within + up * sign(random)).normalize()
            }
            _ => random.direction(),
        };
        let distance = radius
            * match self {
                Self::Far => random.log_uniform(1e2, 1e7),
                Self::Surface => 0.0,
                _ => random.uniform(1.0, 20.0),
            };
        let aim = Aim::new(center + across * (radius * share), heading);
        let ray = if self == Self::Surface {
            aim.unaimed_ray(distance, speed, inputs)
        } else {
            aim.ray(distance, speed, inputs)
        };
        Some((disk, ray?))
    }

    fn whole_case(self, random: &mut Random) -> Option<(Disk, Ray)> {
        // Two vectors of one length at a right angle, whole, in a plane of any tilt.
        const FRAMES: [[[f64; 3]; 2]; 4] = [
            [[2.0, 2.0, 1.0], [1.0, -2.0, 2.0]],
            [[6.0, 3.0, 2.0], [2.0, -6.0, 3.0]],
            [[4.0, 8.0, 1.0], [4.0, -1.0, -8.0]],
            [[0.0, 5.0, 0.0], [4.0, 0.0, 3.0]],
        ];
        let [x, y] = FRAMES[random.below(4) as usize].map(DVec3::from_array);
        let center = whole(random, 20);
        let times = 1.0 + random.below(3) as f64;
        let disk = Disk::new(center, x.cross(y), x.length() * 5.0 * times).ok()?;
        // On the rim, by the triple 3, 4, 5.
        let rim = (x * 3.0 + y * (4.0 * sign(random))) * times;
        let steps = random.below(32) as f64 - 8.0;
        let (point, heading) = match self {
            Self::ExactRim => (rim, whole(random, 6)),
            // The tangent at a point of the rim.
            _ if random.below(4) == 0 => (x * (5.0 * times), y),
            _ => {
                let [a, b, c] = [(); 3].map(|()| random.below(13) as f64 - 6.0);
                (x * (a * times) + y * b, x * c + y)
            }
        };
        let ray = Ray::new(center + point - heading * steps, heading);
        ray.is_valid().then_some((disk, ray))
    }
}

impl HardCases for Disk {
    type Family = DiskFamily;

    const FAMILIES: &'static [DiskFamily] = &DiskFamily::ALL;

    fn draw(family: DiskFamily, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        family.case(seed, index, inputs)
    }
}
