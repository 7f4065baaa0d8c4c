//! The filter of spheres.
//!
//! The copy of a sphere has the center `c` and the radius `r`, in units of the cell. `c` is a
//! multiple of 1/256 in each component, which fills the cache line; `r` is a multiple of a
//! power of two.
//!
//! A point within the slack `s` of a sphere with the radius ρ is within
//!
//! ```text
//! r0 = off + ρ + s,        off = |center - c|                                        (1)
//! ```
//!
//! of `c`. For the ray `x + T d` relative to `c`, with |d| = 1, the distance is least at
//! `T = -x·d`, clamped to the range: the test is
//!
//! ```text
//! |x + T d|² <= r²,        T = min(max(-x·d, start), end)                            (2)
//! ```
//!
//! A ray that represents others passes `c` within `r` plus their distance.
//!
//! # Roundings
//!
//! Products and sums of f32 have a relative error of v = 2^-24. Every length is below `Y` =
//! 768, the distance of a ray that represents others 256 away, and that of `d` is 1 to within 4
//! v. `x` is rounded by v Y, √3 times in all. The computed `T` is off by up to 10 v Y from
//! where the distance is least: 2 for `x` and `d`, 4 for the product, 4 for the length of `d`.
//! The point `x + T d` is then rounded twice per component, 4 v Y. The least distance is that
//! of a point that is moved by no more than 2 v Y + 10 v Y + 4 v Y, below [`ROUNDED`], a 1024th
//! of a unit. The squares and their sums have three roundings, and that of the radius one: 2 v
//! of the lengths, for which `r` gets 2^-20. If the range is empty, either result is right.

use super::cell::{LONGEST, dot, greater, less};
use super::{Cell, Filter, Filtered, NearRay};
use crate::math::LANES;
use crate::solid::{ConvexSolid, Sphere};
use crate::tracer::frame::Frame;

/// Steps of centers per unit: 255 units then fill 16 bits.
const STEPS: f64 = 256.0;

/// The error bound of (2), in units.
const ROUNDED: f64 = 1.0 / 1024.0;

/// The stored radius over the required one.
const OUTWARD: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A block's spheres.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereFilter {
    cell: Cell,
    /// Centers, 256 to a unit.
    c: [[u16; LANES]; 3],
    /// Radii; 0 for an empty lane.
    r: [u8; LANES],
}

const _: () = assert!(size_of::<SphereFilter>() == 64);

impl Filtered for Sphere {
    type Filter = SphereFilter;

    fn filter(spheres: &[Self], frame: &Frame, share: f64) -> SphereFilter {
        let bounds = spheres.iter().map(Self::bounds);
        let mut cell = Cell::around(bounds, frame);
        let units = f64::from(cell.units());
        let mut c = [[0; LANES]; 3];
        let mut radii = [0.0; LANES];
        for (lane, sphere) in spheres.iter().enumerate() {
            let center = cell.place(sphere.center(), frame);
            let kept = (center * STEPS).round();
            for axis in 0..3 {
                c[axis][lane] = kept[axis] as u16;
            }
            let off = (center - kept / STEPS).length();
            let radius = sphere.radius() * frame.scale() * units;
            let least = (radius + off + frame.slack() * units + ROUNDED) * OUTWARD;
            radii[lane] = radius + share * (least - radius);
        }
        SphereFilter {
            r: cell.keep_radii(radii, share),
            cell,
            c,
        }
    }
}

impl SphereFilter {
    /// The test (2), with the given range and a radius greater by `apart`.
    #[inline(always)]
    fn is_near(&self, lane: usize, ray: &NearRay, [start, end]: [f32; 2], apart: f32) -> bool {
        const STEP: f32 = (1.0 / STEPS) as f32;
        let (o, d) = (ray.origin, ray.direction);
        let x = [
            o[0] - f32::from(self.c[0][lane]) * STEP,
            o[1] - f32::from(self.c[1][lane]) * STEP,
            o[2] - f32::from(self.c[2][lane]) * STEP,
        ];
        let t = less(greater(-dot(x, d), start), end);
        let p = [x[0] + t * d[0], x[1] + t * d[1], x[2] + t * d[2]];
        let r = self.cell.radius(self.r[lane]) + apart;
        (dot(p, p) <= r * r) & (self.r[lane] > 0)
    }
}

impl Filter for SphereFilter {
    #[inline(always)]
    fn cell(&self) -> &Cell {
        &self.cell
    }

    #[inline(always)]
    fn may_hit_near(&self, lane: usize, ray: &NearRay, apart: f32) -> bool {
        self.is_near(lane, ray, [-LONGEST, LONGEST], apart)
    }

    #[inline(always)]
    fn may_hit(&self, lane: usize, ray: &NearRay) -> bool {
        self.is_near(lane, ray, [ray.start, ray.end], 0.0)
    }
}
