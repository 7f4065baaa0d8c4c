//! Planes that cut a picture open.
//!
//! The plane through `p` with the normal `n` removes what lies on the side that `n` points to:
//! the points `x` with `n·(x - p) > 0`. A ray `o + t d` crosses the plane at
//! `t = n·(p - o) / (n·d)`. As the difference comes first, the point at that `t` is away from the
//! plane by at most a few units of 2^-53 of `|p - o|` and of the point's coordinates.

use glam::DVec3;

use super::record::MaterialIndex;
use crate::math::Ray;

/// A plane that removes one side of the scene from the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// A point of the plane.
    pub point: DVec3,
    /// The unit normal, which points to what is removed.
    pub normal: DVec3,
    /// The material of the cut faces, one with the same color everywhere; `None` for that of the
    /// solid that is cut.
    pub material: Option<MaterialIndex>,
    /// Whether what is removed still casts shadows and is seen in reflections. Cut faces are lit
    /// without it in any case.
    pub casts_shadows: bool,
}

impl Clip {
    /// The part `[t_min, t_max]` of a ray that the plane leaves, and whether it starts at the
    /// plane. It is empty, with `t_min` greater than `t_max`, if all is removed.
    #[must_use]
    pub fn left(&self, ray: &Ray) -> ([f64; 2], bool) {
        let (height, slope) = (
            self.normal.dot(self.point - ray.origin),
            self.normal.dot(ray.direction),
        );
        let t = height / slope;
        if slope == 0.0 {
            return match height < 0.0 {
                true => ([f64::INFINITY, f64::NEG_INFINITY], false),
                false => ([ray.t_min, ray.t_max], false),
            };
        }
        match slope < 0.0 {
            true if t > ray.t_min => ([t, ray.t_max], true),
            true => ([ray.t_min, ray.t_max], false),
            false => ([ray.t_min, ray.t_max.min(t)], false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(normal: DVec3) -> Clip {
        Clip {
            point: DVec3::new(0.0, 0.0, 2.0),
            normal,
            material: None,
            casts_shadows: true,
        }
    }

    #[test]
    fn planes_leave_the_side_that_the_normal_points_away_from() {
        let up = Ray::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 0.5));
        assert_eq!(clip(DVec3::Z).left(&up), ([0.0, 4.0], false));
        assert_eq!(clip(DVec3::NEG_Z).left(&up), ([4.0, f64::INFINITY], true));
        let down = Ray::new(DVec3::ZERO, DVec3::NEG_Z);
        assert_eq!(clip(DVec3::Z).left(&down), ([0.0, f64::INFINITY], false));
        let ([t_min, t_max], _) = clip(DVec3::NEG_Z).left(&down);
        assert!(t_min > t_max, "{t_min} {t_max}");
        let level = Ray::new(DVec3::ZERO, DVec3::X);
        assert_eq!(clip(DVec3::Z).left(&level), ([0.0, f64::INFINITY], false));
        let ([t_min, t_max], _) = clip(DVec3::NEG_Z).left(&level);
        assert!(t_min > t_max, "{t_min} {t_max}");
    }
}
