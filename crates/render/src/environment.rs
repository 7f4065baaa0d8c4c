//! Light from all directions as a picture, and directions drawn by it.
//!
//! **Radiance.** The pixel in column `c` and row `r` of `w × h` pixels is the radiance at the
//! longitude `2π (c + 1/2)/w` to the right of the picture's left edge and at the height
//! `z_r = cos(π (r + 1/2)/h)` above the equator. In between, radiance is interpolated linearly in
//! the longitude, around the whole circle, and in `z`; above `z_0` and below `z_(h-1)` it depends
//! on the longitude only. Interpolating in `z` instead of the latitude moves the values between
//! rows by little, and makes what follows exact: by Archimedes' theorem, solid angle is
//! `dω = dz dφ`, so that radiance is linear in both variables of a uniform measure.
//!
//! **Density.** The density of directions per solid angle is the luminance of the radiance there,
//! `Y(ω)`, over its integral `Φ`:
//!
//! ```text
//! p(ω) = Y(ω) / Φ,    Φ = Σ_i (M_a + M_b)/2 · (z_a - z_b) · 2π
//! ```
//!
//! `M_r` is the mean luminance of row `r`, and the intervals `i` of `z` are between successive
//! nodes `1, z_0, ..., z_(h-1), -1` with the rows `a` above and `b` below (the same at the poles).
//! Along an interval the mean over all longitudes is linear, so the trapezoid is exact.
//!
//! **Drawing.** The first number chooses an interval of `z` by its share of `Φ`, and its rest a
//! place `t` in the interval by the linear density from `M_a` to `M_b`. At that `z`, luminance along
//! the circle is linear between the columns, with the values `(1 - t) Y_a + t Y_b`; its integrals up to
//! each column are the same mixture of the integrals of both rows, which are stored. The second number
//! chooses a column by bisection, and its rest a place between it and the next. A linear density
//! from `a` to `b` on [0, 1] is inverted by `u (a + b) / (a + sqrt(a² + u (b² - a²)))`.
//!
//! Luminance is `0.2126 R + 0.7152 G + 0.0722 B` (Rec. 709). A density is exact to within roundings;
//! integrals are sums in f64.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use cyltrace::scene::{Environment, Scene};
use glam::DVec3;

use super::clear_sky::ClearSkyModel;

/// The share of each component in luminance.
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The light of an environment, prepared for lookups and for drawing directions.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    width: usize,
    height: usize,
    pixels: Arc<[[f32; 3]]>,
    /// Factor on the pixels.
    strength: f64,
    /// The azimuth of the picture's left edge, from the x axis towards the y axis.
    left: f64,
    /// The heights `z` of the rows' middles, between those of the poles.
    nodes: Vec<f64>,
    /// For each interval between nodes, the integral of luminance above it, over 2π; then that of
    /// all.
    above: Vec<f64>,
    /// For each row, the integrals of luminance from the first column's middle to that of each
    /// column, once around; in units of a column's width.
    along: Vec<f64>,
}

/// A place between the middles of pixels: two rows and two columns with the shares of the second.
#[derive(Clone, Copy)]
struct Place {
    rows: [usize; 2],
    down: f64,
    columns: [usize; 2],
    right: f64,
}

impl EnvironmentMap {
    /// The light from all directions of a scene: its environment, or its clear sky as a table.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        let clear = scene.clear_sky.map(|sky| {
            let sun = scene.sun.map_or(DVec3::Z, |sun| sun.direction);
            Self::new(&ClearSkyModel::new(&sky, sun).environment())
        });
        clear.or_else(|| scene.environment.as_ref().map(Self::new))
    }

    /// About the bytes that an environment of some pixels takes, with the pixels of the scene.
    #[must_use]
    pub fn bytes(pixels: u64) -> u64 {
        pixels.saturating_mul((size_of::<[f32; 3]>() + size_of::<f64>()) as u64)
    }

    /// Prepares an environment. It takes 8 bytes per pixel besides the pixels, which are shared.
    #[must_use]
    pub fn new(environment: &Environment) -> Self {
        let (width, height) = (environment.width() as usize, environment.height() as usize);
        let mut map = Self {
            width,
            height,
            pixels: Arc::clone(environment.pixels()),
            strength: environment.strength,
            left: environment.rotate_degrees.to_radians() + PI,
            nodes: nodes(height),
            above: Vec::with_capacity(height + 2),
            along: Vec::with_capacity(height * (width + 1)),
        };
        for row in 0..height {
            let mut sum = 0.0;
            map.along.push(sum);
            for column in 0..width {
                let next = (column + 1) % width;
                sum += 0.5 * (map.luminance(row, column) + map.luminance(row, next));
                map.along.push(sum);
            }
        }
        let mut sum = 0.0;
        map.above.push(sum);
        for interval in 0..=height {
            let [upper, lower] = map.rows(interval).map(|row| map.mean(row));
            sum += 0.5 * (upper + lower) * (map.nodes[interval] - map.nodes[interval + 1]);
            map.above.push(sum);
        }
        map
    }

    /// The radiance from a direction, a unit vector that points towards the light.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        self.color(self.place(direction))
    }

    /// The density of [`EnvironmentMap::sample`] at a direction, a unit vector, per solid angle; 0
    /// where no light comes from.
    #[must_use]
    pub fn density(&self, direction: DVec3) -> f64 {
        self.density_at(self.place(direction))
    }

    /// The direction, a unit vector, that two numbers in [0, 1) choose, and its density per solid
    /// angle: that of the luminance. The density is 0 if the environment is black.
    #[must_use]
    pub fn sample(&self, (first, second): (f64, f64)) -> (DVec3, f64) {
        if self.power() <= 0.0 {
            return (DVec3::Z, 0.0);
        }
        let target = first * self.above[self.height + 1];
        let interval = last_at_most(self.height + 1, target, |index| self.above[index]);
        let [from, to] = [self.above[interval], self.above[interval + 1]];
        let rows = self.rows(interval);
        let [upper, lower] = rows.map(|row| self.mean(row));
        let down = linear(upper, lower, share(target, from, to));

        let mixed = |of: &dyn Fn(usize) -> f64| (1.0 - down) * of(rows[0]) + down * of(rows[1]);
        let integral = |column| mixed(&|row| self.along[row * (self.width + 1) + column]);
        let target = second * integral(self.width);
        let column = last_at_most(self.width, target, integral);
        let columns = [column, (column + 1) % self.width];
        let [left, right] = columns.map(|column| mixed(&|row| self.luminance(row, column)));
        let share = share(target, integral(column), integral(column + 1));
        let right = linear(left, right, share);

        let z = self.nodes[interval] + (self.nodes[interval + 1] - self.nodes[interval]) * down;
        let longitude = TAU * (column as f64 + 0.5 + right) / self.width as f64;
        let (sine, cosine) = libm::sincos(self.left - longitude);
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let place = Place {
            rows,
            down,
            columns,
            right,
        };
        let direction = DVec3::new(radius * cosine, radius * sine, z);
        (direction, self.density_at(place))
    }

    /// The integral of luminance over all directions, strength included; 0 if the environment is
    /// black.
    #[must_use]
    pub fn power(&self) -> f64 {
        self.strength * TAU * self.above[self.height + 1]
    }

    /// The mean radiance of all directions.
    #[must_use]
    pub fn mean_radiance(&self) -> DVec3 {
        let mean = |row: usize| {
            let pixels = self.pixels[row * self.width..][..self.width].iter();
            pixels.map(|pixel| color(*pixel)).sum::<DVec3>() / self.width as f64
        };
        let means: Vec<DVec3> = (0..self.height).map(mean).collect();
        let parts = (0..=self.height).map(|interval| {
            let [upper, lower] = self.rows(interval).map(|row| means[row]);
            (upper + lower) * (0.25 * (self.nodes[interval] - self.nodes[interval + 1]))
        });
        parts.sum::<DVec3>() * self.strength
    }

    fn density_at(&self, place: Place) -> f64 {
        match self.power() > 0.0 {
            true => LUMINANCE.dot(self.color(place)) / self.power(),
            false => 0.0,
        }
    }

    fn color(&self, place: Place) -> DVec3 {
        let pixel = |row: usize, column: usize| color(self.pixels[row * self.width + column]);
        let [left, right] = place.columns;
        let [upper, lower] = place
            .rows
            .map(|row| pixel(row, left).lerp(pixel(row, right), place.right));
        upper.lerp(lower, place.down) * self.strength
    }

    /// The pixels around a direction.
    fn place(&self, direction: DVec3) -> Place {
        let z = direction.z.clamp(-1.0, 1.0);
        let estimate = libm::acos(z) * self.height as f64 / PI + 0.5;
        let mut interval = (estimate as usize).min(self.height);
        // The estimate may be on the other side of a node by a rounding.
        if z > self.nodes[interval] {
            interval -= 1;
        } else if z < self.nodes[interval + 1] {
            interval += 1;
        }
        let azimuth = libm::atan2(direction.y, direction.x);
        let turns = (self.left - azimuth) / TAU;
        let across = (turns - turns.floor()) * self.width as f64 - 0.5;
        let column = across.floor();
        let left = (column as i64).rem_euclid(self.width as i64) as usize;
        Place {
            rows: self.rows(interval),
            down: share(z, self.nodes[interval], self.nodes[interval + 1]),
            columns: [left, (left + 1) % self.width],
            right: across - column,
        }
    }

    /// The rows at the ends of an interval between nodes.
    fn rows(&self, interval: usize) -> [usize; 2] {
        [interval.saturating_sub(1), interval.min(self.height - 1)]
    }

    /// The luminance of a pixel, without the strength.
    fn luminance(&self, row: usize, column: usize) -> f64 {
        LUMINANCE.dot(color(self.pixels[row * self.width + column]))
    }

    /// The mean luminance of a row, without the strength.
    fn mean(&self, row: usize) -> f64 {
        self.along[row * (self.width + 1) + self.width] / self.width as f64
    }
}

/// The heights of the rows' middles, between those of the poles.
fn nodes(height: usize) -> Vec<f64> {
    let middle = |row: usize| libm::cos(PI * (row as f64 + 0.5) / height as f64);
    let middles = (0..height).map(middle);
    std::iter::once(1.0).chain(middles).chain([-1.0]).collect()
}

fn color(pixel: [f32; 3]) -> DVec3 {
    DVec3::from(pixel.map(f64::from))
}

/// Where a value is between two others, in [0, 1].
fn share(value: f64, from: f64, to: f64) -> f64 {
    match from == to {
        true => 0.0,
        false => ((value - from) / (to - from)).clamp(0.0, 1.0),
    }
}

/// The greatest index below `end` whose value is at most the target; values ascend from 0.
fn last_at_most(end: usize, target: f64, value: impl Fn(usize) -> f64) -> usize {
    let (mut low, mut high) = (0, end);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        match value(middle) <= target {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

/// The place in [0, 1] that the number `u` chooses by a linear density from `a` to `b`.
fn linear(a: f64, b: f64, u: f64) -> f64 {
    let root = (a * a + u * (b * b - a * a)).max(0.0).sqrt();
    match a + root > 0.0 {
        true => (u * (a + b) / (a + root)).min(1.0),
        false => u,
    }
}

#[cfg(test)]
mod tests;
