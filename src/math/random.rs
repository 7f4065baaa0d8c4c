//! Seeded random numbers that need no state between calls.
//!
//! The n-th number of a stream is a hash of (seed, stream, n), so any tile,
//! row or thread draws the same numbers whatever was drawn before it. The hash
//! is the finalizer of SplitMix64 (Steele, Lea, Flood, "Fast splittable
//! pseudorandom number generators", OOPSLA 2014) applied to a Weyl sequence.

use glam::DVec3;

/// The odd constant nearest 2^64 divided by the golden ratio: it spreads
/// successive counters over all 64 bits before they are mixed.
const WEYL_INCREMENT: u64 = 0x9E37_79B9_7F4A_7C15;

/// A stream of numbers that is determined by a seed and a stream number.
#[derive(Clone, Debug)]
pub struct Random {
    key: u64,
    counter: u64,
}

impl Random {
    /// The stream number `stream` of the family `seed`. Streams with different
    /// numbers are independent; the number is often a pixel, a row or a test case.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        Self {
            key: mix(mix(seed.wrapping_add(WEYL_INCREMENT)) ^ stream),
            counter: 0,
        }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.counter = self.counter.wrapping_add(WEYL_INCREMENT);
        mix(self.key.wrapping_add(self.counter))
    }

    /// The next number, uniform on the multiples of 2^-53 in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * f64::EPSILON * 0.5
    }

    /// The next number, uniform in [low, high].
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// The next number in [low, high] whose logarithm is uniform; both limits
    /// are positive.
    pub fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.uniform(libm::log(low), libm::log(high)))
    }

    /// The next whole number below `end`, which is at least 1. The bias is
    /// below `end / 2^64`.
    pub fn below(&mut self, end: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(end)) >> 64) as u64
    }

    /// The next unit vector, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.uniform(-1.0, 1.0);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(self.unit() * std::f64::consts::TAU);
        DVec3::new(radius * cos, radius * sin, z)
    }
}

/// The finalizer of SplitMix64: a bijection in which every input bit flips
/// about half of the output bits.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
