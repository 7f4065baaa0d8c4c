//! The scenes that rays are traced through.

use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::math::Random;
use crate::scene::{
    self, Camera, CylinderRecord, Film, Frame, MaterialIndex, Projection, Prototype, Scene,
};
use crate::solid::{Caps, Cylinder};

/// A scene of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SceneName {
    /// 10^4 random sticks.
    Sticks1e4,
    /// 10^5 random sticks.
    Sticks1e5,
    /// 10^6 random sticks.
    Sticks1e6,
    /// The block of octet truss of `lattice.toml`.
    Lattice,
    /// The trees of `forest.toml`.
    Forest,
}

impl SceneName {
    /// All, in the order of tables.
    pub const ALL: [Self; 5] = [
        Self::Sticks1e4,
        Self::Sticks1e5,
        Self::Sticks1e6,
        Self::Lattice,
        Self::Forest,
    ];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sticks1e4 => "sticks_1e4",
            Self::Sticks1e5 => "sticks_1e5",
            Self::Sticks1e6 => "sticks_1e6",
            Self::Lattice => "lattice",
            Self::Forest => "forest",
        }
    }

    /// Makes the scene, or reads its file from `directory`. The error is why it
    /// is not there.
    pub(super) fn make(self, directory: &Path, seed: u64) -> Result<Scene, String> {
        let file: PathBuf = match self {
            Self::Sticks1e4 => return Ok(sticks(10_000, seed)),
            Self::Sticks1e5 => return Ok(sticks(100_000, seed)),
            Self::Sticks1e6 => return Ok(sticks(1_000_000, seed)),
            Self::Lattice => directory.join("lattice.toml"),
            Self::Forest => directory.join("forest.toml"),
        };
        if !file.exists() {
            return Err(format!("{} is not there", file.display()));
        }
        scene::load(&file).map_err(|error| error.to_string())
    }

    /// How many rays of a kind the oracle judges. In the forest a ray passes
    /// hundreds of trees, each of which is searched by brute force.
    pub(super) fn judged(self) -> usize {
        if self == Self::Forest { 304 } else { 1008 }
    }
}

/// `count` sticks with their middles uniform in the unit cube and uniform
/// directions, closed, in f32 numbers.
///
/// They are `length = 2 count^(-1/3)` long, twice the mean distance of
/// neighbours, and `radius = length / 20` thick: a thicket. A line meets
/// `π/2 radius length count` sticks in a unit of its length, `0.63 / length`, and
/// the boxes of some five times as many: so a ray goes some 1.6 lengths and
/// passes by a few sticks before it hits one, whatever their number, and a
/// picture is full of them.
#[must_use]
pub fn sticks(count: usize, seed: u64) -> Scene {
    let length = 2.0 / libm::cbrt(count as f64);
    let radius = f64::from((0.05 * length) as f32);
    let rounded = |point: DVec3| point.as_vec3().as_dvec3();
    let stick = |number: u32| {
        let mut random = Random::new(seed, u64::from(number));
        let middle = DVec3::new(random.unit(), random.unit(), random.unit());
        let half = random.direction() * (0.5 * length);
        let cylinder = Cylinder::new(
            rounded(middle - half),
            rounded(middle + half),
            radius,
            Caps::Both,
        );
        let cylinder = cylinder.expect("a stick is longer than f32 rounds");
        CylinderRecord::new(&cylinder, number, MaterialIndex::default())
    };
    let mut sticks = Prototype {
        cylinders: (0..count as u32).map(stick).collect(),
        ..Prototype::default()
    };
    // As a scene file's are when they are loaded.
    sticks.cylinders.arrange();
    Scene {
        camera: CAMERA,
        film: FILM,
        ..Scene::new(vec![sticks])
    }
}

/// Before the cube of sticks, which fills the picture: rays that miss everything
/// say nothing of solids.
const CAMERA: Camera = Camera {
    projection: Projection::Perspective { fov_degrees: 36.0 },
    frame: Frame::LookAt {
        position: DVec3::new(0.5, -1.2, 0.5),
        look_at: DVec3::new(0.5, 0.5, 0.5),
        up: DVec3::Z,
    },
};

/// As many pixels as usual pictures have, and square as the cube is.
const FILM: Film = Film {
    width: 1024,
    height: 1024,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_are_in_f32_numbers_and_of_their_length() {
        let scene = sticks(1000, 3);
        let cylinders = &scene.prototypes[0].cylinders;
        assert_eq!(cylinders.len(), 1000);
        for record in cylinders {
            let cylinder = record.cylinder();
            for point in [cylinder.p0(), cylinder.p1()] {
                assert_eq!(point, point.as_vec3().as_dvec3());
            }
            let length = (cylinder.p1() - cylinder.p0()).length();
            assert!((length - 0.2).abs() < 1e-6, "{length}");
            assert!((cylinder.radius() - 0.01).abs() < 1e-9);
        }
    }

    #[test]
    fn make_absent_file_is_named() {
        let absent = SceneName::Forest.make(Path::new("nowhere"), 0);
        let reason = absent.expect_err("there is no such directory");
        assert!(reason.contains("forest.toml is not there"), "{reason}");
    }
}
