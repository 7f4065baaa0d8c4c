//! Cones and rounded cones as rays are aimed at them.

use glam::DVec3;

use super::{TaperCase, TaperSolid};
use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cone, RoundedCone};

/// A solid as rays are aimed at it.
pub(super) struct Target {
    pub p0: DVec3,
    pub p1: DVec3,
    pub radius0: f64,
    pub radius1: f64,
    pub solid: TaperSolid,
}

impl Target {
    pub fn axis(&self) -> DVec3 {
        (self.p1 - self.p0).normalize()
    }

    pub fn radius(&self) -> f64 {
        self.radius0.max(self.radius1)
    }

    pub fn size(&self) -> f64 {
        (self.p1 - self.p0).length() + self.radius()
    }

    /// A unit vector across the axis.
    pub fn across(&self, random: &mut Random) -> DVec3 {
        loop {
            let across = self.axis().cross(random.direction());
            if across.length_squared() > 1e-6 {
                return across.normalize();
            }
        }
    }

    /// The point of the wall at a share of the way, and unit vectors: outward,
    /// and along the wall.
    pub fn wall(&self, share: f64, outward: DVec3) -> [DVec3; 3] {
        let (axis, length) = (self.axis(), (self.p1 - self.p0).length());
        let delta = self.radius1 - self.radius0;
        let (middle, radius) = (self.p0.lerp(self.p1, share), self.radius0 + delta * share);
        match self.solid {
            TaperSolid::Cone => {
                let slant = libm::hypot(length, delta);
                let normal = (outward * length - axis * delta) / slant;
                let along = (axis * length + outward * delta) / slant;
                [middle + outward * radius, normal, along]
            }
            TaperSolid::RoundedCone => {
                let sine = (delta / length).clamp(-1.0, 1.0);
                let cosine = (1.0 - sine * sine).sqrt();
                let normal = outward * cosine - axis * sine;
                [
                    middle + normal * radius,
                    normal,
                    axis * cosine + outward * sine,
                ]
            }
        }
    }

    pub fn inside(&self, random: &mut Random) -> DVec3 {
        let outward = self.across(random);
        let share = random.uniform(0.02, 0.98);
        let radius = self.radius0 + (self.radius1 - self.radius0) * share;
        let off = outward * (0.95 * radius * random.unit().sqrt());
        self.p0.lerp(self.p1, share) + off
    }

    pub fn case(&self, ray: Ray) -> Option<TaperCase> {
        let Self {
            p0,
            p1,
            radius0,
            radius1,
            solid,
        } = *self;
        match solid {
            TaperSolid::Cone => drop(Cone::new(p0, p1, radius0, radius1, Caps::Both).ok()?),
            TaperSolid::RoundedCone => drop(RoundedCone::new(p0, p1, radius0, radius1).ok()?),
        }
        Some(TaperCase {
            p0,
            p1,
            radius0,
            radius1,
            ray,
        })
    }
}
