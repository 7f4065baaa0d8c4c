//! The kinds of solids as the check sees them, one file a kind.
//!
//! A kind states its *shape*: the convex hull of two disks, of two balls, or a block. All
//! that the check computes of a solid follows from its shape (`disks`, `balls`, `block`), so a
//! new kind with one of these shapes is one file.

mod balls;
pub(crate) mod between;
mod block;
mod cone;
mod cuboid;
mod cylinder;
mod disk;
mod disks;
pub(crate) mod outline;
mod rounded_cone;
pub(crate) mod scene_solid;
mod sphere;
pub(crate) mod taper;

use glam::DVec3;

use cyltrace::solid::AnySolid;
use cyltrace_oracle::{Exact, ExactVector};

use balls::Balls;
use between::{Between, Parts};
use block::Block;
use disks::Disks;
use outline::Outline;

/// A kind of solid.
pub(crate) trait CheckedSolid {
    /// The shape that its numbers state.
    fn shape(&self) -> Shape;

    /// The solid with another shape; `None` if these numbers are no such solid.
    fn with_shape(&self, shape: &Shape) -> Option<AnySolid>;
}

/// The solid as its kind.
pub(crate) fn checked(solid: &AnySolid) -> &dyn CheckedSolid {
    cyltrace::with_solid!(solid, one => one)
}

/// The shape of a solid.
pub(crate) fn shape(solid: &AnySolid) -> Shape {
    checked(solid).shape()
}

/// The closed solid grown by a distance, or shrunk by a negative one; `None` if nothing is
/// left of it, or if it has no inside.
///
/// *Grown* by δ, the result contains every point within δ of the solid. *Shrunk*, the solid
/// contains every point within δ of the result. The results are rounded by a few u of the
/// solid's size, so δ must be far above that. A grown disk is a cylinder as thin as δ, whose
/// axis tilts by the rounding of its ends: the disk must be near the origin.
pub(crate) fn displaced(solid: &AnySolid, outward: f64) -> Option<AnySolid> {
    let solid = checked(solid);
    solid.with_shape(&solid.shape().get().displaced(outward)?)
}

/// The closed solid, moved so that its anchor is at the origin and rounded by a few u of its
/// own size.
pub(crate) fn at_origin(solid: &AnySolid) -> Option<AnySolid> {
    let solid = checked(solid);
    solid.with_shape(&solid.shape().get().at_origin())
}

/// What a solid is the convex hull of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    /// Disks about one or two points, across an axis.
    Disks(Disks),
    /// Balls about one or two points.
    Balls(Balls),
    /// A box.
    Block(Block),
}

impl Shape {
    /// The computations with it.
    pub fn get(&self) -> &dyn ConvexShape {
        match self {
            Self::Disks(disks) => disks,
            Self::Balls(balls) => balls,
            Self::Block(block) => block,
        }
    }

    /// The radius and the unit normal of a disk, which has no inside.
    pub fn flat(&self) -> Option<(f64, DVec3)> {
        match self {
            Self::Disks(disks) if disks.is_flat() => Some((disks.radii()[0], disks.unit())),
            _ => None,
        }
    }

    /// The ends of a solid that may be open, and whether they are. The disk at an apex is a
    /// point of the wall, so that end is closed.
    pub fn ends(&self) -> Option<[(DVec3, bool); 2]> {
        match self {
            Self::Disks(disks) if !disks.is_flat() => Some(disks.open_ends()),
            _ => None,
        }
    }

    /// The open ends: where each is, and the unit vector along the axis from there to the
    /// other end.
    pub fn open_ends(&self) -> impl Iterator<Item = (DVec3, DVec3)> + use<> {
        let ends = self.ends().into_iter().flat_map(|[start, end]| {
            let axis = (end.0 - start.0).normalize();
            [(start, axis), (end, -axis)]
        });
        ends.filter_map(|((end, is_open), inward)| is_open.then_some((end, inward)))
    }

    /// The shape with its radii scaled; `None` unless it has disks.
    pub fn with_radii_scaled(&self, scale: f64) -> Option<Self> {
        match self {
            Self::Disks(disks) => Some(Self::Disks(disks.with_radii_scaled(scale))),
            _ => None,
        }
    }

    /// The distance of a point from the surface, with open ends.
    pub fn surface_distance(&self, point: DVec3) -> f64 {
        match self {
            Self::Disks(disks) => disks.surface_distance(point),
            _ => self.get().depth(point).abs(),
        }
    }
}

/// A vector from the anchor in exact numbers, `scale` times too long.
pub(crate) struct Scaled {
    pub x: ExactVector,
    /// Positive.
    pub scale: Exact,
}

/// The computations with a shape.
///
/// Points and vectors are in the solid's own space. Bounds in f64 count 8 roundings for
/// products and sums, each of [`UNIT`](taper::UNIT); NaN fails.
pub(crate) trait ConvexShape {
    /// The two ends. The first is the solid's anchor; the solid's middle is halfway between
    /// them.
    fn end_points(&self) -> [DVec3; 2];

    /// The axis; of balls and disks about two points, the vector between them.
    fn axis(&self) -> DVec3;

    /// The closed shape with its anchor at the origin.
    fn at_origin(&self) -> Shape;

    /// As [`displaced`].
    fn displaced(&self, outward: f64) -> Option<Shape>;

    /// At most the distance from the middle to the surface; of a disk, to its rim.
    fn half_width(&self) -> f64;

    /// The length by which distances are measured.
    fn unit_length(&self) -> f64 {
        self.half_width()
    }

    /// True only if the point `y` from the anchor, off by at most `error`, is in the solid.
    fn surely_contains(&self, y: DVec3, error: f64) -> bool;

    /// True only if [`is_beyond`](ConvexShape::is_beyond) is true for `y`.
    fn is_surely_beyond(&self, y: DVec3, error: f64, m: DVec3) -> bool;

    /// Whether the closed solid contains a point.
    fn contains(&self, x: &Scaled) -> bool;

    /// Whether `m·x > h(m)`, with the support `h(m) = max m·s` over all points `s` of the
    /// solid. For a block, whether `x` is beyond the face whose normal is nearest to `m`.
    fn is_beyond(&self, x: &Scaled, m: DVec3) -> bool;

    /// The distance of a point of the closed solid from its surface, negative outside. It is
    /// a concave function along a line. A disk has no inside.
    ///
    /// The result is off by a few u of the solid's size and the point's distance.
    fn depth(&self, point: DVec3) -> f64;

    /// Adds the parts of the surface that a segment may cross.
    fn add_parts(&self, between: &Between, parts: &mut Parts);

    /// The shape about an axis.
    fn outline(&self) -> Outline;

    /// The distance of the wall from the axis of the outline at a height, in a unit direction
    /// from the axis, and the outward normal there.
    fn wall(&self, outline: &Outline, height: f64, outward: DVec3) -> (f64, DVec3);
}

#[cfg(test)]
pub(crate) mod tests;
