//! The rays: coherent ones of a camera, those from there to the sun, and
//! incoherent ones.
//!
//! All numbers are f32, so that all contenders get the same ray, and
//! directions are of unit length as near as f32 has it, which Embree's cone
//! curves want.

use glam::{DVec2, DVec3};

use super::flat::Flat;
use crate::rivals::ray_for_embree;
use cyltrace::embree::Ray32;
use cyltrace::math::{Bounds, Random, Ray};
use cyltrace::scene::{AimedCamera, Scene};
use cyltrace::solid::SolidKind;
use cyltrace::tracer::Tracer;

/// Neighbouring rays of one kind form tiles of this size: 4 by 4 pixels.
pub const TILE: usize = 16;

/// The side of a tile.
const SIDE: u32 = 4;

/// The side of the squares of pixels that are traced of a picture: a renderer's
/// tile.
const SQUARE: u32 = 16;

const PIXELS_OF_SQUARE: usize = (SQUARE * SQUARE) as usize;

/// 2^64 over the golden ratio.
const GOLDEN_RATIO: u64 = 0x9E37_79B9_7F4A_7C15;

/// The distribution and the query of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Kind {
    /// From the camera, in tiles, for the first hit.
    Coherent,
    /// From the hits of the coherent rays to the sun, for occlusion.
    Shadow,
    /// From anywhere in any direction, for the first hit.
    Incoherent,
}

impl Kind {
    /// All, in the order of tables.
    pub const ALL: [Self; 3] = [Self::Coherent, Self::Shadow, Self::Incoherent];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct Rays {
    /// Their kind.
    pub kind: Kind,
    /// The rays.
    pub wide: Vec<Ray>,
    /// The same numbers as Embree takes them.
    pub narrow: Vec<Ray32>,
}

impl Rays {
    /// Rays whose numbers are f32 already.
    ///
    /// # Panics
    /// When a number is beyond Embree's limit.
    #[must_use]
    pub fn new(kind: Kind, wide: Vec<Ray>) -> Self {
        let narrow = wide.iter().map(|ray| {
            ray_for_embree(ray).expect("scenes and directions of usual size are within f32")
        });
        Self {
            kind,
            narrow: narrow.collect(),
            wide,
        }
    }

    /// `count` rays of each kind. Incoherent ones start in the box of what is
    /// placed where anything is: such scenes stand on a ground that is far
    /// wider. There are fewer shadow rays where fewer camera rays hit anything.
    #[must_use]
    pub fn of_scene(flat: &Flat, tracer: &Tracer, count: usize, seed: u64) -> [Self; 3] {
        let coherent = camera_rays(&flat.scene, &tracer.bounds(), count);
        let shadow = shadow_rays(flat, tracer, &coherent);
        let within = if flat.has_placements() {
            placed_bounds(flat)
        } else {
            tracer.bounds()
        };
        let incoherent = random_rays(&within, count, seed);
        [
            Self::new(Kind::Coherent, coherent),
            Self::new(Kind::Shadow, shadow),
            Self::new(Kind::Incoherent, incoherent),
        ]
    }
}

fn narrow_ray(origin: DVec3, direction: DVec3) -> Ray {
    let rounded = |vector: DVec3| vector.as_vec3().as_dvec3();
    Ray::new(rounded(origin), rounded(direction.normalize()))
}

/// `count` rays through the middles of pixels of the scene's picture, in its full
/// size, for what neighbours have in common depends on it: squares of 16 by 16
/// pixels that are spread evenly over the picture, and in each all 4 by 4 tiles.
#[must_use]
pub fn camera_rays(scene: &Scene, bounds: &Bounds, count: usize) -> Vec<Ray> {
    let film = scene.film;
    let camera = AimedCamera::new(&scene.camera, bounds, film);
    let (across, down) = (film.width.div_ceil(SQUARE), film.height.div_ceil(SQUARE));
    let squares = u64::from(across) * u64::from(down);
    let wanted = count.div_ceil(PIXELS_OF_SQUARE) as u64;
    let square = |number: u64| {
        // The golden ratio's multiples spread any number of squares evenly.
        let turn = ((number.wrapping_mul(GOLDEN_RATIO) >> 32) * squares) >> 32;
        let (column, row) = (turn % u64::from(across), turn / u64::from(across));
        (column as u32 * SQUARE, row as u32 * SQUARE)
    };
    let ray = |(left, top): (u32, u32), pixel: u32| {
        let (tile, within) = (pixel / TILE as u32, pixel % TILE as u32);
        let tiles_across = SQUARE / SIDE;
        let x = left + (tile % tiles_across) * SIDE + within % SIDE;
        let y = top + (tile / tiles_across) * SIDE + within / SIDE;
        let ray = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        narrow_ray(ray.origin, ray.direction)
    };
    (0..wanted)
        .flat_map(|number| (0..PIXELS_OF_SQUARE as u32).map(move |pixel| (number, pixel)))
        .map(|(number, pixel)| ray(square(number), pixel))
        .take(count)
        .collect()
}

/// The direction of the sun if the scene has none.
const SUN: DVec3 = DVec3::new(0.3, -0.5, 0.8);

/// From every hit towards the sun. Rounding to f32 may put a start below its
/// surface, so it is first lifted by sixteen times of what that rounds.
fn shadow_rays(flat: &Flat, tracer: &Tracer, coherent: &[Ray]) -> Vec<Ray> {
    let sun = flat.scene.sun.map_or(SUN, |sun| sun.direction);
    let hits = coherent
        .iter()
        .filter_map(|ray| Some((ray, tracer.closest(ray)?)));
    hits.map(|(ray, hit)| {
        let lift = 16.0 * f64::from(f32::EPSILON) * hit.point.abs().max_element();
        // A disk is seen from behind as well: the start is on the side that is seen.
        let is_behind = hit.solid == SolidKind::Disk && hit.normal.dot(ray.direction) > 0.0;
        let seen = if is_behind { -hit.normal } else { hit.normal };
        narrow_ray(hit.point + seen * lift, sun)
    })
    .collect()
}

/// Origins uniform in a box, directions uniform on the sphere.
#[must_use]
pub fn random_rays(within: &Bounds, count: usize, seed: u64) -> Vec<Ray> {
    (0..count as u64)
        .map(|number| {
            let mut random = Random::new(seed, number);
            let place = DVec3::new(random.unit(), random.unit(), random.unit());
            let origin = within.lower + place * within.extent();
            narrow_ray(origin, random.direction())
        })
        .collect()
}

fn placed_bounds(flat: &Flat) -> Bounds {
    let of_prototype: Vec<Bounds> = flat
        .scene
        .prototypes
        .iter()
        .map(|prototype| {
            let solids = prototype.singles();
            solids.fold(Bounds::EMPTY, |all, (_, solid)| all.union(&solid.bounds()))
        })
        .collect();
    let placed = flat.placed.iter();
    placed
        .filter(|placed| placed.prototype.0 != 0)
        .map(|placed| {
            of_prototype[placed.prototype.0 as usize].transformed(&placed.world_from_object)
        })
        .fold(Bounds::EMPTY, |all, one| all.union(&one))
}
