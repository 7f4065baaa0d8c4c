//! How a surface bends away from its tangent plane, to second order.
//!
//! With the unit vector `v` in the tangent plane and the outward unit normal `n`, the
//! surface passes through `p + s v + s² h(v) n`, up to third order of `s`. All solids are
//! convex, so `h` is at most 0. Every surface here has its principal directions along
//! and around an axis:
//!
//! ```text
//! h(v) = -(κ_around (v·around)² + κ_along (v·along)²) / 2                      (1)
//! ```
//!
//! Where a sphere continues a wall (a seam of a rounded cone) the curvature along the axis
//! differs between the two sides, so `κ_along` depends on the sign of `v·along`.

use glam::DVec3;
use smallvec::SmallVec;

/// The curvatures of a surface at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    around: DVec3,
    along: DVec3,
    curvature_around: f64,
    /// For negative `v·along`, and for others.
    curvature_along: [f64; 2],
}

/// Directions in the tangent plane, as angles from its first axis.
pub(super) type Angles = SmallVec<[f64; 8]>;

impl Bend {
    /// The bend of a plane.
    pub const FLAT: Self = Self {
        around: DVec3::ZERO,
        along: DVec3::ZERO,
        curvature_around: 0.0,
        curvature_along: [0.0; 2],
    };

    /// The bend of a sphere, or of a wall whose tangent plane `around` and `along` span.
    pub fn new(
        around: DVec3,
        along: DVec3,
        curvature_around: f64,
        curvature_along: [f64; 2],
    ) -> Self {
        Self {
            around,
            along,
            curvature_around,
            curvature_along,
        }
    }

    /// The greatest curvature.
    pub fn greatest(&self) -> f64 {
        let [below, above] = self.curvature_along;
        self.curvature_around.max(below).max(above)
    }

    /// The curvature around the axis.
    pub fn curvature_around(&self) -> f64 {
        self.curvature_around
    }

    /// `h` of (1).
    pub fn height(&self, v: DVec3) -> f64 {
        let (around, along) = (v.dot(self.around), v.dot(self.along));
        let curvature_along = self.curvature_along[usize::from(along >= 0.0)];
        -0.5 * (self.curvature_around * around * around + curvature_along * along * along)
    }

    /// Adds the directions `cos φ x + sin φ y` of a seam.
    pub fn add_seam(&self, [x, y]: [DVec3; 2], angles: &mut Angles) {
        if self.curvature_along[0] != self.curvature_along[1] {
            let seam = libm::atan2(self.around.dot(y), self.around.dot(x));
            angles.extend([seam, seam + std::f64::consts::PI]);
        }
    }

    /// Adds the directions in which one surface may change from above to below another. `sign`
    /// is -1 if the normal of the other is opposite.
    ///
    /// Each height is `A + B cos 2φ + C sin 2φ` on either side of a seam. The roots of the
    /// difference are added for all combinations of sides: a superfluous direction does no
    /// harm.
    pub fn add_crossings(&self, other: &Self, sign: f64, [x, y]: [DVec3; 2], angles: &mut Angles) {
        for one in self.harmonics(x, y) {
            for two in other.harmonics(x, y) {
                let [a, b, c] = std::array::from_fn(|i| one[i] - sign * two[i]);
                let amplitude = libm::hypot(b, c);
                if amplitude == 0.0 {
                    continue;
                }
                // Where surfaces only touch, rounding may lose a double root; the clamp keeps
                // it.
                let cosine = (-a / amplitude).clamp(-1.0, 1.0);
                let (middle, half) = (libm::atan2(c, b), libm::acos(cosine));
                for angle in [middle + half, middle - half] {
                    angles.extend([0.5 * angle, 0.5 * angle + std::f64::consts::PI]);
                }
            }
        }
    }

    /// `A`, `B` and `C` on either side of a seam.
    fn harmonics(&self, x: DVec3, y: DVec3) -> SmallVec<[[f64; 3]; 2]> {
        let [below, above] = self.curvature_along;
        let sides = if below == above { 1 } else { 2 };
        [below, above][..sides]
            .iter()
            .map(|&curvature_along| {
                let mut sum = [0.0; 3];
                for (curvature, axis) in [
                    (self.curvature_around, self.around),
                    (curvature_along, self.along),
                ] {
                    let (p, q) = (axis.dot(x), axis.dot(y));
                    let factor = -0.25 * curvature;
                    sum[0] += factor * (p * p + q * q);
                    sum[1] += factor * (p * p - q * q);
                    sum[2] += factor * (2.0 * p * q);
                }
                sum
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossed_walls_change_places_on_the_diagonals() {
        let along_x = Bend::new(DVec3::Y, DVec3::X, 1.0, [0.0; 2]);
        let along_y = Bend::new(DVec3::X, DVec3::Y, 1.0, [0.0; 2]);
        assert_eq!(along_x.height(DVec3::Y), -0.5);
        assert_eq!(along_x.height(DVec3::X), 0.0);
        let mut angles = Angles::new();
        along_x.add_crossings(&along_y, 1.0, [DVec3::X, DVec3::Y], &mut angles);
        assert_eq!(angles.len(), 4);
        for angle in angles {
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            assert!((sine.abs() - cosine.abs()).abs() < 1e-15, "{angle}");
        }
    }

    #[test]
    fn seam_bends_on_the_side_of_its_sphere_only() {
        let seam = Bend::new(DVec3::X, DVec3::Y, 0.5, [0.5, 0.0]);
        assert_eq!(seam.height(DVec3::Y), 0.0);
        assert_eq!(seam.height(DVec3::NEG_Y), -0.25);
        assert_eq!(seam.greatest(), 0.5);
    }
}
