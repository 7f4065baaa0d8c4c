//! The rays of each class.
//!
//! Seed, window, class and number determine a ray: it is drawn from their own stream
//! of random numbers in the world, and moved to the nearest ray that
//! is exact in both spaces (`mesh_frame`). In a window that is not the whole
//! scene, a ray is clipped to the window's box, inward by more than the clipping
//! rounds, so that all its hits are in the window. Rays that miss the box
//! are drawn again.

pub(crate) mod around;
mod target;

use glam::{DVec2, DVec3};

use cyltrace::embree::Ray32;
use cyltrace::math::{Bounds, Random, Ray};
use cyltrace::scene::{AimedCamera, Scene};

use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::window::Window;
use crate::settings::Class;
use target::Target;

/// Draws of a ray before one is aimed at the window's box itself.
const MOST_DRAWS: u32 = 32;

/// The share of the range by which each end of a clipped ray is shortened: the
/// parameters are computed with a few roundings of f64 and rounded to f32.
const INWARD: f64 = 4.0 * f32::EPSILON as f64;

/// The rays of a window.
pub(crate) struct RaySource<'a> {
    window: &'a Window,
    frame: &'a MeshFrame,
    number: u64,
    seed: u64,
    view: AimedCamera,
    film: DVec2,
    center: DVec3,
    /// Half the diagonal of the extent.
    reach: f64,
}

impl<'a> RaySource<'a> {
    /// The source for window `number` of a scene.
    pub fn new(
        scene: &Scene,
        window: &'a Window,
        frame: &'a MeshFrame,
        number: u64,
        seed: u64,
    ) -> Self {
        let extent = window.extent();
        Self {
            window,
            frame,
            number,
            seed,
            view: AimedCamera::new(&scene.camera, &scene.scene_stats().bounds, scene.film),
            film: DVec2::new(f64::from(scene.film.width), f64::from(scene.film.height)),
            center: extent.center(),
            reach: 0.5 * extent.extent().length(),
        }
    }

    /// The ray `index` of a class, for Embree and in the world.
    pub fn ray(&self, class: Class, index: u64) -> (Ray32, Ray) {
        let class_number = Class::ALL.iter().position(|&one| one == class).unwrap_or(0);
        let family = Random::new(self.seed, 8 * self.number + class_number as u64).bits();
        let mut random = Random::new(family, index);
        for _ in 0..MOST_DRAWS {
            let (origin, direction) = self.draw(class, &mut random);
            if let Some(rays) = self.exact_ray(origin, direction) {
                return match class {
                    Class::Sphere => rays,
                    _ => self.in_part(rays, &mut random),
                };
            }
        }
        let origin = self.center + random.direction() * (1.5 * self.reach);
        let rays = self.exact_ray(origin, self.center - origin);
        rays.unwrap_or_else(|| self.point())
    }

    /// A ray of no length, which cannot be answered wrongly: for a window that rounded rays
    /// miss.
    fn point(&self) -> (Ray32, Ray) {
        self.frame.ray(self.center, DVec3::Z, 0.0, 0.0)
    }

    /// The exact ray near a drawn one, clipped to the window.
    pub fn exact_ray(&self, origin: DVec3, direction: DVec3) -> Option<(Ray32, Ray)> {
        let is_good = |v: DVec3| v.is_finite() && v.length_squared() > 0.0;
        if !origin.is_finite() || !is_good(direction) {
            return None;
        }
        let origin = self.nearer(origin, direction);
        let (mut ray32, mut ray) = self.frame.ray(origin, direction, 0.0, f64::INFINITY);
        if ray.direction == DVec3::ZERO {
            return None;
        }
        if let Some(bounds) = &self.window.bounds {
            let (near, far) = clipped(bounds, &ray)?;
            ray32.t_near = near;
            ray32.t_far = far;
            ray.t_min = f64::from(near);
            ray.t_max = f64::from(far);
        }
        Some((ray32, ray))
    }

    /// Limits one ray in four to a part of its range.
    fn in_part(&self, (mut ray32, mut ray): (Ray32, Ray), random: &mut Random) -> (Ray32, Ray) {
        let way = self.reach / ray.direction.length();
        let near = ray.t_min + random.uniform(0.0, 2.0) * way;
        let far = near + random.uniform(0.0, 2.0) * way;
        let range = (near as f32, (far as f32).min(ray32.t_far));
        if random.below(4) == 0 && range.0 <= range.1 {
            (ray32.t_near, ray32.t_far) = range;
            (ray.t_min, ray.t_max) = (f64::from(range.0), f64::from(range.1));
        }
        (ray32, ray)
    }

    /// An origin far outside moves along the ray to two diagonals before the
    /// middle: there f32 is finer, and the ray has not entered the window yet.
    fn nearer(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        let unit = (direction / direction.abs().max_element()).normalize();
        let before_middle = (self.center - origin).dot(unit);
        if before_middle > 5.0 * self.reach {
            origin + unit * (before_middle - 4.0 * self.reach)
        } else {
            origin
        }
    }

    fn draw(&self, class: Class, random: &mut Random) -> (DVec3, DVec3) {
        match class {
            Class::Camera => self.camera_ray(random),
            Class::Sphere => self.sphere_ray(random),
            Class::Inside => self.target(random).inside_ray(random),
            Class::Grazing => self.grazing(random),
            Class::Axial => self.target(random).along_axis(random),
        }
    }

    fn target(&self, random: &mut Random) -> Target<'a> {
        let number = random.below(self.window.solids.len() as u64);
        Target::new(&self.window.solids[number as usize])
    }

    /// From the camera through any point of the picture; in a part of the scene, through a
    /// point of one of its solids.
    fn camera_ray(&self, random: &mut Random) -> (DVec3, DVec3) {
        let mut position = DVec2::new(random.unit(), random.unit()) * self.film;
        if self.window.bounds.is_some() {
            let point = self.target(random).any_point(random);
            position = self.view.project(point).unwrap_or(position);
        }
        let ray = self.view.ray(position);
        (ray.origin, ray.direction)
    }

    fn sphere_ray(&self, random: &mut Random) -> (DVec3, DVec3) {
        let origin = self.center + random.direction() * (1.5 * self.reach);
        let point = self.target(random).point_around(random);
        (origin, point - origin)
    }

    /// Beside a wall or a rim, from close by or from up to the whole extent away.
    fn grazing(&self, random: &mut Random) -> (DVec3, DVec3) {
        let target = self.target(random);
        let (point, heading) = if random.below(3) == 0 {
            target.at_rim(random)
        } else {
            target.at_silhouette(random)
        };
        let unit = heading / heading.length();
        let size = target.size();
        let distance = if random.below(2) == 0 {
            size * random.uniform(1.0, 8.0)
        } else {
            random.log_uniform(size, (2.0 * self.reach).max(size * 1.5))
        };
        (point - unit * distance, unit)
    }
}

/// The part of a ray within a box, shortened by its rounding; `None` if little
/// or nothing is left.
fn clipped(bounds: &Bounds, ray: &Ray) -> Option<(f32, f32)> {
    let (mut near, mut far) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        let (lower, upper) = (bounds.lower[axis], bounds.upper[axis]);
        if direction == 0.0 {
            if origin < lower || origin > upper {
                return None;
            }
            continue;
        }
        let one = (lower - origin) / direction;
        let other = (upper - origin) / direction;
        near = near.max(one.min(other));
        far = far.min(one.max(other));
    }
    let inward = INWARD * (near.abs() + far.abs());
    let near = if near > 0.0 { near + inward } else { 0.0 };
    let far = far - inward;
    (near < far).then_some((near as f32, far as f32))
}
