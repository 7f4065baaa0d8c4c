//! Morton codes: the positions of grid cells along a Z-order curve.
//!
//! The code of a cell interleaves the bits of its coordinates; the lowest bit is
//! the first coordinate's. Cells with nearby codes tend to be nearby.

/// The code of a cell in a plane.
#[inline]
#[must_use]
pub fn morton_code_2([x, y]: [u32; 2]) -> u64 {
    spread_by_2(x) | spread_by_2(y) << 1
}

/// The code of a cell in space, from the lowest 21 bits of its coordinates.
#[inline]
#[must_use]
pub fn morton_code_3([x, y, z]: [u32; 3]) -> u64 {
    spread_by_3(x) | spread_by_3(y) << 1 | spread_by_3(z) << 2
}

/// The bits of a number, two places apart: halves are moved away from each
/// other, then halves of halves.
#[inline]
fn spread_by_2(x: u32) -> u64 {
    let x = u64::from(x);
    let x = (x | x << 16) & 0x0000_FFFF_0000_FFFF;
    let x = (x | x << 8) & 0x00FF_00FF_00FF_00FF;
    let x = (x | x << 4) & 0x0F0F_0F0F_0F0F_0F0F;
    let x = (x | x << 2) & 0x3333_3333_3333_3333;
    (x | x << 1) & 0x5555_5555_5555_5555
}

/// The lowest 21 bits of a number, three places apart.
#[inline]
fn spread_by_3(x: u32) -> u64 {
    let x = u64::from(x) & 0x1F_FFFF;
    let x = (x | x << 32) & 0x001F_0000_0000_FFFF;
    let x = (x | x << 16) & 0x001F_0000_FF00_00FF;
    let x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
    let x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    /// Computes the code bit by bit.
    fn plain<const N: usize>(cell: [u32; N]) -> u64 {
        let bits = (0..32).flat_map(|bit| cell.map(|x| u64::from(x >> bit & 1)));
        let bits = bits.take(64).enumerate();
        bits.fold(0, |code, (place, bit)| code | bit << place)
    }

    #[test]
    fn codes_interleave_the_bits() {
        for number in 0..1000 {
            let mut random = Random::new(1, number);
            let mut coordinate = |bits: u32| random.below(1 << bits) as u32;
            let cell = [coordinate(32), coordinate(32)];
            assert_eq!(morton_code_2(cell), plain(cell), "{cell:?}");
            let cell = [coordinate(21), coordinate(21), coordinate(21)];
            assert_eq!(morton_code_3(cell), plain(cell), "{cell:?}");
        }
    }
}
