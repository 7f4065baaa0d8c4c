//! The cuboid as users define it.

mod chord;
mod reject;

use glam::DVec3;

use super::exact::{Expression, Number, difference, dot, sign, vector};
use super::quick::{Quick, Range};
use super::surface::FirstParameter;
use super::{Chord, ConvexSolid, Cylinder, Location, Part, RayOrigin, SolidKind, SurfacePoint};
use crate::math::{Bounds, Orientation, UNIT_ROUNDOFF, power_of_two};

/// A box in any orientation: its center, half of its width along each of its own axes, and its
/// orientation, all taken as exact numbers.
///
/// With `f` the columns of [`Orientation::world_from_object`], the solid is `{x : |f_i · (x -
/// center)| <= half_widths_i}`. The surface is its boundary, six faces named by their own axis
/// and side. The columns of a turned cuboid are orthonormal to within roundings, and are taken
/// as they are.
///
/// A point on an edge or a corner belongs to the face that is first of x, y, z, for every ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    center: DVec3,
    half_widths: DVec3,
    orientation: Orientation,
}

/// Why numbers do not define a cuboid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CuboidError {
    /// A coordinate of the center is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the center is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", center.x, center.y, center.z, Cylinder::GREATEST)]
    Center {
        /// The center as given.
        center: DVec3,
    },
    /// A half width is not in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "the half width along {axis} is {half_width:?}: it must be a positive number between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    HalfWidth {
        /// `"x"`, `"y"` or `"z"`, an axis of the cuboid.
        axis: &'static str,
        /// The half width as given.
        half_width: f64,
    },
}

impl Cuboid {
    /// The cuboid around `center` with these half widths along its own axes.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(
        center: DVec3,
        half_widths: DVec3,
        orientation: Orientation,
    ) -> Result<Self, CuboidError> {
        if !Cylinder::is_in_range(center) {
            return Err(CuboidError::Center { center });
        }
        for (axis, half_width) in ["x", "y", "z"].into_iter().zip(half_widths.to_array()) {
            if !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&half_width) {
                return Err(CuboidError::HalfWidth { axis, half_width });
            }
        }
        Ok(Self::from_valid(center, half_widths, orientation))
    }

    /// The cuboid of numbers that [`Cuboid::new`] has accepted before.
    #[inline]
    pub(crate) fn from_valid(center: DVec3, half_widths: DVec3, orientation: Orientation) -> Self {
        Self {
            center,
            half_widths,
            orientation,
        }
    }

    /// The center.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Half of the width along each of its own axes, positive.
    #[must_use]
    pub fn half_widths(&self) -> DVec3 {
        self.half_widths
    }

    /// The orientation.
    #[must_use]
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }

    /// An axis of the cuboid as it is stored, a unit vector to within roundings.
    #[inline(always)]
    fn axis(&self, axis: usize) -> DVec3 {
        self.orientation.world_from_object().col(axis)
    }
}

impl ConvexSolid for Cuboid {
    const KIND: SolidKind = SolidKind::Cuboid;

    /// A corner is `center + F⁻¹ y`, `F` the matrix of the rows `f_i` and `|y_i| = h_i`. With
    /// `M` the transpose of `F`, `F⁻¹` is `M` except for its deviation from orthonormality, at
    /// most 6 u of the length of y ([`Orientation`]); products and sums add 4 u. If the axes
    /// are the world's, these errors are zero.
    fn bounds(&self) -> Bounds {
        let half_widths = self.half_widths;
        let reach = self.orientation.world_from_object().abs() * half_widths;
        let off = if self.orientation.is_axis_aligned() {
            0.0
        } else {
            16.0 * UNIT_ROUNDOFF * half_widths.element_sum()
        };
        Bounds {
            lower: self.center - (reach + off),
            upper: self.center + (reach + off),
        }
        .rounded_outward()
    }

    fn anchor(&self) -> DVec3 {
        self.center
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn radius(&self) -> f64 {
        self.half_widths.min_element()
    }

    #[inline]
    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        chord::chord(self, from_anchor, direction)
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        chord::chord(self, origin.offset_from(self.center), direction)
    }

    #[inline(always)]
    fn quick_first(&self, from_anchor: DVec3, direction: DVec3, range: &Range) -> Quick {
        chord::quick_first(self, from_anchor, direction, range)
    }

    #[inline(always)]
    fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        reject::rejects(self, from_anchor, direction)
    }

    /// `u` and `v` are the two coordinates of the face, from 0 at the least to 1: y and z for a
    /// face of x, z and x for a face of y, x and y for a face of z.
    ///
    /// Let `y` be the point in own coordinates: one of them is `±h`, the others are within
    /// `±h`. The true point of the face is `center + F⁻¹ y`. `M y` is off by 6 u of the length
    /// of `y` for `M` (see [`Cuboid::bounds`]) and by 6 u for its products and sums, and the
    /// sum with the center by u of the point.
    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        let (axis, is_upper) = face(part);
        let half_widths = self.half_widths;
        let mut own = self
            .orientation
            .to_object(from_anchor)
            .clamp(-half_widths, half_widths);
        let side = if is_upper { 1.0 } else { -1.0 };
        own[axis] = side * half_widths[axis];
        let point = self.center + self.orientation.to_world(own);
        let share = |axis: usize| 0.5 + 0.5 * (own[axis] / half_widths[axis]);
        SurfacePoint {
            point,
            error: UNIT_ROUNDOFF * (point.length() + 16.0 * half_widths.element_sum()),
            normal: self.axis(axis) * side,
            v: share((axis + 2) % 3),
            first: FirstParameter::Share(share((axis + 1) % 3)),
        }
    }

    fn locate(&self, point: DVec3) -> Location {
        if !point.is_finite() {
            return Location::Outside;
        }
        (0..3).fold(Location::Inside, |least, axis| match least {
            Location::Outside => least,
            _ => least.min(self.locate_along(axis, point)),
        })
    }

    fn is_on(&self, part: Part, point: DVec3) -> bool {
        let (axis, is_upper) = face(part);
        sign(&Height {
            cuboid: self,
            axis,
            side: if is_upper { 1.0 } else { -1.0 },
            point,
        })
        .is_eq()
    }

    fn size(&self) -> f64 {
        // The diagonal, and the growth of `bounds`.
        2.0 * self.half_widths.length() * (1.0 + 64.0 * UNIT_ROUNDOFF)
    }
}

impl Cuboid {
    /// The location of a point relative to the planes of an axis. Rounded numbers are off by
    /// less than 6 u of their terms; they decide beyond 2^-48 of them.
    fn locate_along(&self, axis: usize, point: DVec3) -> Location {
        let (terms, half_width) = (
            self.axis(axis) * (point - self.center),
            self.half_widths[axis],
        );
        let height = (terms.x + terms.y + terms.z).abs();
        let size = terms.abs().element_sum() + half_width;
        if (height - half_width).abs() > power_of_two(-48) * size && size.is_finite() {
            return if height < half_width {
                Location::Inside
            } else {
                Location::Outside
            };
        }
        let within = [1.0, -1.0].map(|side| {
            let height = Height {
                cuboid: self,
                axis,
                side,
                point,
            };
            Location::of_sign(sign(&height).reverse())
        });
        within[0].min(within[1])
    }
}

/// `h - side f·(point - center)`: the depth of a point below a plane.
struct Height<'a> {
    cuboid: &'a Cuboid,
    axis: usize,
    side: f64,
    point: DVec3,
}

impl Expression for Height<'_> {
    fn value<N: Number>(&self) -> N {
        let f = vector::<N>(self.cuboid.axis(self.axis) * self.side);
        let x = difference(self.point, self.cuboid.center);
        N::of(self.cuboid.half_widths[self.axis]).minus(&dot(&f, &x))
    }
}

/// The lower and the upper face across each axis.
pub(super) const FACES: [[Part; 2]; 3] = [
    [Part::XMin, Part::XMax],
    [Part::YMin, Part::YMax],
    [Part::ZMin, Part::ZMax],
];

/// The axis of a face, and whether it is the upper one.
fn face(part: Part) -> (usize, bool) {
    match part {
        Part::XMin => (0, false),
        Part::XMax => (0, true),
        Part::YMin => (1, false),
        Part::YMax => (1, true),
        Part::ZMin => (2, false),
        Part::ZMax => (2, true),
        Part::Side | Part::Cap0 | Part::Cap1 | Part::Cut => {
            unreachable!("a cuboid has no part {}", part.name())
        }
    }
}
