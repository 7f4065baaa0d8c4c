//! The cell of eight-bit coordinates, and rays relative to it.

use glam::DVec3;

use crate::embree::{Box32, Ray32};
use crate::math::{Bounds, LANES};
use crate::tracer::frame::Frame;

/// Corners are multiples of a unit of the frame over this number. That is finer than the least
/// cell, and leaves 16 bits for numbers up to 4 in size.
const GRID: f32 = (1 << 13) as f32;

/// The units of a cell that its solids' boxes may fill, of the 255 that eight bits represent. A
/// half axis along the whole cell can then be rounded up.
const FILLED: f64 = 250.0;

/// The greatest slack of the frame, in units. The ray's nearest point is off by up to 36 v O,
/// twice the slack, which is then below 64 units. A smaller unit would gain nothing, as
/// everything is uncertain by the slack.
const MOST_SLACK: f64 = 32.0;

/// The middle of a cell, along each axis.
const MIDDLE: f32 = 127.5;

/// The greatest distance along a ray that matters, in units. A point of the cell is within 221
/// of its middle, and the ray's nearest point is computed to within 64.
pub(super) const LONGEST: f32 = 320.0;

/// A cube of the frame, with a corner at a multiple of 1/[`GRID`], and sides of 255 units of
/// its own.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    corner: [i16; 3],
    /// The code of the number of units in a unit of the frame; see [`Cell::units`].
    scale: u8,
    /// Radii are multiples of two to the negative of this, in units.
    exponent: u8,
}

/// A ray in the units of a cell: its points are `origin + T direction`, for T from `start` to
/// `end`. The direction has the length 1, and the origin is the line's point nearest to the
/// middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearRay {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    pub start: f32,
    pub end: f32,
}

impl Cell {
    /// The least cell that contains boxes of a group's space, grown as in the frame.
    pub fn around(boxes: impl Iterator<Item = Bounds>, frame: &Frame) -> Self {
        let grown = boxes.map(|bounds| frame.grown_box(&bounds));
        let bounds = grown.fold(Box32::EMPTY, |sum, one| sum.union(&one));
        let slack = frame.slack();
        let corner = bounds.lower.map(|x| (x * GRID).floor());
        let extent = (0..3)
            .map(|axis| f64::from(bounds.upper[axis]) - f64::from(corner[axis]) / f64::from(GRID));
        let extent = extent.fold(0.0, f64::max);
        let fits = |scale: u8| {
            let units = f64::from(units(scale));
            units * extent <= FILLED && units * slack <= MOST_SLACK
        };
        debug_assert!(fits(0), "a box of the frame, and a slack below its radius");
        let scale = (0..=u8::MAX).rev().find(|&scale| fits(scale));
        Self {
            corner: corner.map(|x| x as i16),
            scale: scale.unwrap_or(0),
            exponent: 0,
        }
    }

    /// The number of units in a unit of the frame.
    #[inline(always)]
    pub fn units(&self) -> f32 {
        units(self.scale)
    }

    /// A point of the group's space in units of the cell.
    pub fn place(&self, point: DVec3, frame: &Frame) -> DVec3 {
        let corner = DVec3::from_array(self.corner().map(f64::from));
        (frame.place(point) - corner) * f64::from(self.units())
    }

    /// Radii in units of the cell, rounded up to eight bits each, as fine as the greatest
    /// allows. Tests pass a `share` of the rounding step.
    pub fn keep_radii(&mut self, radii: [f64; LANES], share: f64) -> [u8; LANES] {
        let greatest = radii.iter().copied().fold(0.0, f64::max);
        let fits = |exponent: &u8| greatest * f64::from(1_u32 << exponent) <= 255.0;
        self.exponent = (0..16).rev().find(fits).unwrap_or(0);
        let steps = f64::from(1_u32 << self.exponent);
        radii.map(|radius| (radius * steps - (1.0 - share)).ceil() as u8)
    }

    /// A stored radius, in units.
    #[inline(always)]
    pub fn radius(&self, kept: u8) -> f32 {
        f32::from(kept) * f32::from_bits((127 - u32::from(self.exponent)) << 23)
    }

    /// The corner, in the frame.
    #[inline(always)]
    fn corner(&self) -> [f32; 3] {
        self.corner.map(|x| f32::from(x) * (1.0 / GRID))
    }

    /// The ray relative to the cell.
    #[inline(always)]
    pub fn near(&self, ray: &Ray32) -> NearRay {
        let (units, corner) = (self.units(), self.corner());
        let length = dot(ray.direction, ray.direction).sqrt();
        let inverse = 1.0 / length;
        let d = [
            ray.direction[0] * inverse,
            ray.direction[1] * inverse,
            ray.direction[2] * inverse,
        ];
        let o = [
            (ray.origin[0] - corner[0]) * units,
            (ray.origin[1] - corner[1]) * units,
            (ray.origin[2] - corner[2]) * units,
        ];
        let nearest = dot([MIDDLE - o[0], MIDDLE - o[1], MIDDLE - o[2]], d);
        let end = ray.t_far * (length * units) - nearest;
        NearRay {
            origin: [
                o[0] + nearest * d[0],
                o[1] + nearest * d[1],
                o[2] + nearest * d[2],
            ],
            direction: d,
            start: greater(-nearest, -LONGEST),
            end: less(end, LONGEST),
        }
    }
}

/// 2^5 to nearly 2^21 in sixteenths of octaves, with five significant bits: products with it
/// are rounded, the number itself is exact.
#[inline(always)]
fn units(scale: u8) -> f32 {
    f32::from_bits((132 << 23) + (u32::from(scale) << 19))
}

#[inline(always)]
pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + (a[1] * b[1] + a[2] * b[2])
}

/// `f32::min` where neither is NaN, in one instruction.
#[inline(always)]
pub(super) fn less(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `f32::max` where neither is NaN, in one instruction.
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
