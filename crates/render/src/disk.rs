//! Points of a disk from two numbers.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::DVec2;

/// A point of the unit disk, uniform for numbers uniform in [0, 1): squares about the middle of
/// the unit square become circles, which keeps strata whole (P. Shirley, K. Chiu, "A Low
/// Distortion Map Between Disk and Square", 1997).
pub(crate) fn concentric_disk((first, second): (f64, f64)) -> DVec2 {
    let (x, y) = (2.0 * first - 1.0, 2.0 * second - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, angle) = match x.abs() > y.abs() {
        true => (x, FRAC_PI_4 * (y / x)),
        false => (y, FRAC_PI_2 - FRAC_PI_4 * (x / y)),
    };
    let (sine, cosine) = libm::sincos(angle);
    DVec2::new(radius * cosine, radius * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rings and sectors of equal areas contain as many points of a grid.
    #[test]
    fn points_are_uniform() {
        let (side, rings, sectors) = (480, 6, 8);
        let mut counts = vec![0_u32; rings * sectors];
        for row in 0..side {
            for column in 0..side {
                let number = |place| (f64::from(place) + 0.5) / f64::from(side);
                let point = concentric_disk((number(column), number(row)));
                assert!(point.length() < 1.0);
                let ring = (point.length_squared() * rings as f64) as usize;
                let turn = libm::atan2(point.y, point.x) / std::f64::consts::TAU;
                let sector = (turn.rem_euclid(1.0) * sectors as f64) as usize % sectors;
                counts[ring * sectors + sector] += 1;
            }
        }
        let expected = f64::from(side * side) / counts.len() as f64;
        for count in counts {
            let apart = (f64::from(count) / expected - 1.0).abs();
            assert!(apart < 0.02, "{count} of {expected}");
        }
    }
}
