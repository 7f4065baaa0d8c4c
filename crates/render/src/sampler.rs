//! The numbers of every sample, fixed by (seed, pixel, sample).
//!
//! A sample needs pairs of numbers: a place in its pixel, a direction, and those that a longer
//! path takes.
//! Each pair is a point of the (0, 2)-sequence of Sobol', so that any 2^k
//! samples of a pixel from its start are stratified in every way that 2^k
//! boxes allow. Two hashes decorrelate what would otherwise repeat: each
//! coordinate is Owen-scrambled per pixel, and each pair takes the points in
//! an order of its own. Method: B. Burley, "Practical Hash-based Owen
//! Scrambling", JCGT 9(4), 2020.
//!
//! The sampler `random` is for comparisons: every number of every sample is an independent hash of
//! (seed, pixel, pair, sample), so the variance of a mean is that of a sample over their number.
//!
//! No state is carried between samples, so pictures are the same for any
//! tile order and thread count.

use cyltrace::math::Random;
use cyltrace::scene::Sampler;

/// The numbers of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelSampler {
    sampler: Sampler,
    place: PairKey,
    direction: PairKey,
    /// Distinguishes the pixel's further pairs.
    further: u64,
}

/// The hashes of one pair of dimensions.
#[derive(Clone, Copy, Debug)]
struct PairKey {
    order: u32,
    first: u32,
    second: u32,
}

impl PixelSampler {
    /// The numbers of the pixel with the index `pixel` in pictures of `seed`.
    #[must_use]
    pub fn new(sampler: Sampler, seed: u64, pixel: u64) -> Self {
        let mut random = Random::new(seed, pixel);
        Self {
            sampler,
            place: PairKey::next(&mut random),
            direction: PairKey::next(&mut random),
            further: random.bits(),
        }
    }

    /// Where in the pixel a sample lies: both in [0, 1).
    #[must_use]
    pub fn place(&self, sample: u32) -> (f64, f64) {
        self.place.point(self.sampler, sample)
    }

    /// The numbers that choose a sample's direction: both in [0, 1).
    #[must_use]
    pub fn direction(&self, sample: u32) -> (f64, f64) {
        self.direction.point(self.sampler, sample)
    }

    /// Two numbers of a sample for another purpose, each with a `dimension` of its own: both in
    /// [0, 1).
    #[must_use]
    pub fn pair(&self, dimension: u32, sample: u32) -> (f64, f64) {
        self.key(dimension).point(self.sampler, sample)
    }

    fn key(&self, dimension: u32) -> PairKey {
        PairKey::next(&mut Random::new(self.further, dimension.into()))
    }
}

/// One dimension of the samples of many pixels: the numbers of [`PixelSampler::pair`], with less
/// work for successive samples of a pixel.
pub(crate) struct Pairs {
    dimension: u32,
    /// The last pixel and its hashes.
    last: Option<(u64, PairKey)>,
}

impl Pairs {
    pub fn new(dimension: u32) -> Self {
        Self {
            dimension,
            last: None,
        }
    }

    /// Two numbers of a sample of a pixel.
    pub fn of(&mut self, pixel: &PixelSampler, sample: u32) -> (f64, f64) {
        let key = match self.last {
            Some((further, key)) if further == pixel.further => key,
            _ => pixel.key(self.dimension),
        };
        self.last = Some((pixel.further, key));
        key.point(pixel.sampler, sample)
    }
}

impl PairKey {
    fn next(random: &mut Random) -> Self {
        let mut key = || (random.bits() >> 32) as u32;
        Self {
            order: key(),
            first: key(),
            second: key(),
        }
    }

    fn point(&self, sampler: Sampler, sample: u32) -> (f64, f64) {
        match sampler {
            Sampler::Sobol => self.sobol_point(sample),
            Sampler::Random => self.random_point(sample),
        }
    }

    #[cold]
    fn random_point(&self, sample: u32) -> (f64, f64) {
        let joined = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
        let key = joined(self.order, self.first);
        let mut random = Random::new(key, joined(self.second, sample));
        (random.unit(), random.unit())
    }

    fn sobol_point(&self, sample: u32) -> (f64, f64) {
        let index = scrambled(sample, self.order);
        let first = scrambled(index.reverse_bits(), self.first);
        let second = scrambled(second_sobol_coordinate(index), self.second);
        (unit(first), unit(second))
    }
}

/// The second coordinate of the Sobol' sequence (the first is the reversal of
/// the index's bits). The direction numbers follow from the polynomial
/// `x + 1`: each is the one before, added to its half modulo 2.
///
/// So bit `j` of direction number `i`, from the top, is the binomial coefficient `i` over `j`
/// modulo 2, which by Lucas's theorem is 1 where the binary digits of `j` are among those of
/// `i`. The coordinate's bit `j` is the sum of the index's bits at all such `i`, and a
/// sum over supersets is computed one binary digit of the position at a time.
fn second_sobol_coordinate(index: u32) -> u32 {
    let mut sums = index;
    for (shift, lower) in [
        (1, 0x5555_5555),
        (2, 0x3333_3333),
        (4, 0x0f0f_0f0f),
        (8, 0x00ff_00ff),
        (16, 0x0000_ffff),
    ] {
        sums ^= (sums >> shift) & lower;
    }
    sums.reverse_bits()
}

/// An Owen scrambling: every bit is flipped or not, as a hash of `key` and of
/// the bits above it says. So two numbers with the same leading bits keep
/// them the same, which is what keeps strata and aligned blocks intact.
///
/// The hash works upward from the low bits, hence the reversals: adding and
/// multiplying carry only upward, and the even factors keep a bit out of its
/// own flip. The factors are those that Burley's paper found by search.
fn scrambled(value: u32, key: u32) -> u32 {
    let mut bits = value.reverse_bits().wrapping_add(key);
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        bits ^= bits.wrapping_mul(factor);
    }
    bits.reverse_bits()
}

/// A multiple of 2^-32 in [0, 1).
fn unit(bits: u32) -> f64 {
    f64::from(bits) / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The direction numbers by their recurrence.
    #[test]
    fn second_sobol_coordinate_adds_the_direction_numbers_of_its_bits() {
        let mut random = Random::new(7, 0);
        let indices = (0..1024).chain((0..10_000).map(|_| (random.bits() >> 32) as u32));
        for index in indices {
            let (mut direction, mut expected) = (1_u32 << 31, 0);
            for bit in 0..32 {
                if index >> bit & 1 == 1 {
                    expected ^= direction;
                }
                direction ^= direction >> 1;
            }
            assert_eq!(
                second_sobol_coordinate(index),
                expected,
                "seed 7, {index:#x}"
            );
        }
    }

    #[test]
    fn sampler_any_order_same_numbers() {
        let forward: Vec<_> = (0..64)
            .map(|n| {
                (
                    PixelSampler::new(Sampler::Sobol, 3, n).place(5),
                    PixelSampler::new(Sampler::Sobol, 3, n).direction(5),
                )
            })
            .collect();
        let sampler: Vec<_> = (0..64)
            .rev()
            .map(|n| PixelSampler::new(Sampler::Sobol, 3, n))
            .collect();
        for (n, expected) in forward.iter().enumerate() {
            let sampler = &sampler[63 - n];
            let _ = sampler.place(17);
            assert_eq!(
                *expected,
                (sampler.place(5), sampler.direction(5)),
                "pixel {n}"
            );
        }
    }

    #[test]
    fn sampler_sixteen_samples_stratified_in_every_elementary_interval() {
        for pixel in 0..200 {
            let sampler = PixelSampler::new(Sampler::Sobol, 11, pixel);
            let pair =
                |dimension| move |sampler: &PixelSampler, sample| sampler.pair(dimension, sample);
            type Pair<'a> = &'a dyn Fn(&PixelSampler, u32) -> (f64, f64);
            let pairs: [Pair; 4] = [
                &PixelSampler::place,
                &PixelSampler::direction,
                &pair(0),
                &pair(77),
            ];
            for pair in pairs {
                for (columns, rows) in [(1, 16), (2, 8), (4, 4), (8, 2), (16, 1)] {
                    let mut seen = [false; 16];
                    for sample in 0..16 {
                        let (x, y) = pair(&sampler, sample);
                        assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                        let cell =
                            (x * f64::from(columns)) as usize * rows + (y * rows as f64) as usize;
                        assert!(
                            !std::mem::replace(&mut seen[cell], true),
                            "seed 11 pixel {pixel}: two of 16 samples in one of {columns}x{rows}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn sampler_pairs_are_uncorrelated() {
        for sampler in Sampler::ALL {
            pairs_are_uncorrelated(sampler);
        }
    }

    fn pairs_are_uncorrelated(sampler: Sampler) {
        let mut sums = [0.0_f64; 12];
        let pixels = 20_000;
        for pixel in 0..pixels {
            let sampler = PixelSampler::new(sampler, 5, pixel);
            let (x, y) = sampler.place(0);
            let (u, v) = sampler.direction(0);
            let (one, two) = (sampler.pair(0, 0), sampler.pair(1, 0));
            let products = [(x, u), (x, v), (y, u), (y, v), (x, one.0), (y, one.1)];
            let further = [(u, one.0), (v, one.1), (u, two.1), (v, two.0)];
            let last = [(one.0, two.0), (one.1, two.1)];
            let products = products.into_iter().chain(further).chain(last);
            for (sum, (a, b)) in sums.iter_mut().zip(products) {
                *sum += (a - 0.5) * (b - 0.5) * 12.0;
            }
        }
        // The correlation of n independent pairs has the deviation 1/sqrt(n).
        for sum in sums {
            let correlation = sum / pixels as f64;
            assert!(
                correlation.abs() < 5.0 / (pixels as f64).sqrt(),
                "{correlation}"
            );
        }
    }

    #[test]
    fn pairs_of_successive_samples_are_those_of_single_ones() {
        let mut pairs = Pairs::new(9);
        for pixel in [3, 3, 4, 3] {
            let sampler = PixelSampler::new(Sampler::Sobol, 1, pixel);
            for sample in 0..5 {
                assert_eq!(pairs.of(&sampler, sample), sampler.pair(9, sample));
            }
        }
    }

    #[test]
    fn sampler_seed_changes_numbers() {
        let differing = (0..100)
            .filter(|&n| {
                PixelSampler::new(Sampler::Sobol, 1, n).place(0)
                    != PixelSampler::new(Sampler::Sobol, 2, n).place(0)
            })
            .count();
        assert!(differing > 98, "{differing} of 100");
    }

    /// Bins of the unit square, within a pixel and over pixels, by the chi-squared statistic, which
    /// has the mean 63 and the deviation √126.
    #[test]
    fn random_samples_are_uniform_and_independent() {
        let of = |pixel: u64| PixelSampler::new(Sampler::Random, 3, pixel);
        let within: Vec<_> = (0..64_000)
            .map(|n| (of(1).place(n), of(1).pair(4, n)))
            .collect();
        let over: Vec<_> = (0..64_000)
            .map(|n| (of(n).place(9), of(n).place(10)))
            .collect();
        for list in [within, over] {
            type Pick = fn(&((f64, f64), (f64, f64))) -> (f64, f64);
            let pairs: [Pick; 4] = [
                |((x, y), _)| (*x, *y),
                |((x, _), (z, _))| (*x, *z),
                |((_, y), (z, _))| (*y, *z),
                |(_, (z, w))| (*z, *w),
            ];
            for pair in pairs {
                let mut bins = [0.0_f64; 64];
                for (x, y) in list.iter().map(pair) {
                    bins[(x * 8.0) as usize * 8 + (y * 8.0) as usize] += 1.0;
                }
                let statistic: f64 = bins
                    .iter()
                    .map(|n| (n - 1000.0) * (n - 1000.0) / 1000.0)
                    .sum();
                let deviations = (statistic - 63.0) / 126.0_f64.sqrt();
                assert!(deviations.abs() < 5.0, "{deviations} deviations");
            }
        }
    }
}
