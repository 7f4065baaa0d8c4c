//! The rays of a packet against a block.
//!
//! Coherent rays mostly miss the same solids of a block. So the first ray represents all, with
//! their distance as its thickness, and only the solids that it may hit are tested against each
//! ray.
//!
//! Let `o` and `d` be those of the first ray. A point of another ray `o' + T d'` is off from
//! that of the first at the same T by at most `|o' - o| + |T| |d' - d|`, component by
//! component, and `|T|` is at most [`LONGEST`]. So the first ray passes everything that the
//! other hits within that distance. Its roundings, a few 2^-24 of it, are within the added 1 %.

use super::cell::{LONGEST, greater};
use super::{Cell, Filter, NearRay};
use crate::embree::{GREATEST_PACKET, RaySet, Rays32};
use crate::math::{LANES, LaneMask};

/// The greatest distance of rays from the first that represents them, in units of the cell: as
/// wide as the cell. The first ray is then within 512 + 256 of what the others hit, for which
/// filters need margins too.
pub(super) const MOST_APART: f32 = 256.0;

/// The factor of the distance: 1 % and the roundings.
const APART: f32 = 1.0 + 1.0 / (1 << 6) as f32;

/// Rays of a packet near a cell, in rows.
pub(crate) struct NearPacket {
    rows: [NearRow; ROWS],
    wanted: RaySet,
    /// One of them, and the greatest distance of the others from it; `None` if that is too far.
    bundle: Option<(NearRay, f32)>,
}

/// The number of rows of lanes in a packet.
const ROWS: usize = GREATEST_PACKET / LANES;

/// Eight rays near a cell.
struct NearRow {
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    start: [f32; LANES],
    end: [f32; LANES],
}

impl NearRow {
    const NOWHERE: Self = Self {
        origin: [[0.0; LANES]; 3],
        direction: [[0.0; LANES]; 3],
        start: [0.0; LANES],
        end: [0.0; LANES],
    };

    #[inline(always)]
    fn ray(&self, lane: usize) -> NearRay {
        NearRay {
            origin: [
                self.origin[0][lane],
                self.origin[1][lane],
                self.origin[2][lane],
            ],
            direction: [
                self.direction[0][lane],
                self.direction[1][lane],
                self.direction[2][lane],
            ],
            start: self.start[lane],
            end: self.end[lane],
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, ray: &NearRay) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.direction[axis][lane] = ray.direction[axis];
        }
        self.start[lane] = ray.start;
        self.end[lane] = ray.end;
    }
}

impl NearPacket {
    /// The `wanted` rays of a packet.
    #[inline(always)]
    pub fn new(cell: &Cell, rays: &Rays32, wanted: RaySet) -> Self {
        let mut rows = [NearRow::NOWHERE; ROWS];
        for (row, near) in rows.iter_mut().enumerate() {
            if in_row(wanted, row) == 0 {
                continue;
            }
            for lane in 0..LANES {
                near.set(lane, &cell.near(&rays.ray(row * LANES + lane)));
            }
        }
        Self {
            bundle: bundle(&rows, wanted),
            rows,
            wanted,
        }
    }

    /// The lanes whose solids some of the rays may hit, as bits.
    #[inline(always)]
    pub fn lanes(&self, filter: &impl Filter) -> u8 {
        let Some((ray, apart)) = self.bundle else {
            return u8::MAX;
        };
        let mut may_hit_near = LaneMask::splat(false);
        for lane in 0..LANES {
            may_hit_near.0[lane] = filter.may_hit_near(lane, &ray, apart);
        }
        may_hit_near.bits()
    }

    /// The rays that may hit the solid of a lane.
    #[inline(always)]
    pub fn survivors(&self, filter: &impl Filter, lane: usize) -> RaySet {
        let mut bits = 0;
        for row in 0..ROWS {
            if in_row(self.wanted, row) == 0 {
                continue;
            }
            let rays = &self.rows[row];
            let mut may_hit = LaneMask::splat(false);
            for ray in 0..LANES {
                may_hit.0[ray] = filter.may_hit(lane, &rays.ray(ray));
            }
            bits |= u16::from(may_hit.bits()) << (row * LANES);
        }
        RaySet::from_bits(bits) & self.wanted
    }
}

/// The first of the wanted rays, and the greatest distance of the others from it.
#[inline(always)]
fn bundle(rows: &[NearRow; ROWS], wanted: RaySet) -> Option<(NearRay, f32)> {
    let number = wanted.into_iter().next()?;
    let first = rows[number / LANES].ray(number % LANES);
    let mut greatest = [0.0; LANES];
    for (row, rays) in rows.iter().enumerate() {
        let in_row = LaneMask::from_bits(in_row(wanted, row));
        for (lane, greatest) in greatest.iter_mut().enumerate() {
            let apart = square_apart(&rays.ray(lane), &first);
            let apart = if in_row.0[lane] { apart } else { 0.0 };
            *greatest = greater(*greatest, apart);
        }
    }
    // In halves, since processors have no instruction for the maximum of a row.
    for half in [4, 2, 1] {
        for lane in 0..half {
            greatest[lane] = greater(greatest[lane], greatest[lane + half]);
        }
    }
    let square = greatest[0];
    if square > MOST_APART * MOST_APART {
        return None;
    }
    Some((first, square.sqrt() * APART))
}

/// The square of the greatest distance between two rays.
#[inline(always)]
fn square_apart(one: &NearRay, other: &NearRay) -> f32 {
    let mut square = 0.0;
    for axis in 0..3 {
        let moved = (one.origin[axis] - other.origin[axis]).abs();
        let turned = (one.direction[axis] - other.direction[axis]).abs();
        let apart = moved + LONGEST * turned;
        square += apart * apart;
    }
    square
}

/// The rays of a row, as bits.
#[inline(always)]
fn in_row(rays: RaySet, row: usize) -> u8 {
    (rays.bits() >> (row * LANES)) as u8
}
