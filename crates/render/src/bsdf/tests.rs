//! Tests of all functions by their definitions: integrals by quadrature and symmetry.

use std::f64::consts::{PI, TAU};

use cyltrace::math::Random;
use cyltrace::scene::{Color, Material, MaterialKind};
use glam::DVec3;

use super::{Bsdf, Local, Numbers, Scattered, of};

/// Functions with a density, and what they are called in messages.
fn rough() -> Vec<(String, MaterialKind, f64)> {
    let mut all = vec![("diffuse".to_owned(), MaterialKind::Diffuse, 1.0)];
    for roughness in [0.4, 0.6, 1.0] {
        let ior = 1.5;
        all.push((
            format!("metal {roughness}"),
            MaterialKind::Metal { roughness },
            1.0,
        ));
        let plastic = MaterialKind::Plastic { roughness, ior };
        all.push((format!("plastic {roughness}"), plastic, 1.0));
        for relative_ior in [1.5, 1.0 / 1.5] {
            let name = format!("glass {roughness} into {relative_ior:.2}");
            all.push((name, MaterialKind::Glass { roughness, ior }, relative_ior));
        }
    }
    all.push((
        "plastic with a smooth coat".to_owned(),
        MaterialKind::Plastic {
            roughness: 0.0,
            ior: 1.5,
        },
        1.0,
    ));
    all
}

fn bsdf(kind: MaterialKind) -> Box<dyn Bsdf> {
    let material = Material {
        name: String::new(),
        color: Color::Constant(DVec3::ONE),
        kind,
    };
    of(&material).expect("it scatters")
}

fn local(relative_ior: f64) -> Local {
    Local {
        color: DVec3::new(1.0, 0.5, 0.9),
        relative_ior,
    }
}

fn outgoing(cosine: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    DVec3::new(sine * libm::cos(0.7), sine * libm::sin(0.7), cosine)
}

fn numbers(random: &mut Random) -> Numbers {
    Numbers {
        choice: random.unit(),
        direction: (random.unit(), random.unit()),
    }
}

/// The direction of a height and an angle around.
fn direction(height: f64, around: f64) -> DVec3 {
    let (sine, cosine) = libm::sincos(around);
    let radius = (1.0 - height * height).max(0.0).sqrt();
    DVec3::new(radius * cosine, radius * sine, height)
}

const COSINES: [f64; 3] = [0.95, 0.5, 0.15];

/// Directions are sampled as the density says: Pearson's statistic over 16 x 24 cells of equal
/// solid angle, with the integral of the density over each from 24 x 24 midpoints.
#[test]
fn samples_follow_the_density() {
    const DOWN: usize = 16;
    const AROUND: usize = 24;
    const SAMPLES: u32 = 40_000;
    const FINE: usize = 24;
    for (name, kind, relative_ior) in rough() {
        let (bsdf, local) = (bsdf(kind), local(relative_ior));
        for cosine in COSINES {
            let outgoing = outgoing(cosine);
            let mut random = Random::new(3, (cosine * 100.0) as u64);
            let mut counts = [0.0_f64; DOWN * AROUND + 1];
            for _ in 0..SAMPLES {
                let sampled = bsdf.sample(&local, outgoing, numbers(&mut random));
                let place = match sampled {
                    Some(Scattered {
                        incoming,
                        density: Some(_),
                        ..
                    }) => {
                        let down = ((incoming.z * 0.5 + 0.5) * DOWN as f64) as usize;
                        let around = libm::atan2(incoming.y, incoming.x).rem_euclid(TAU);
                        let around = (around / TAU * AROUND as f64) as usize;
                        down.min(DOWN - 1) * AROUND + around.min(AROUND - 1)
                    }
                    _ => DOWN * AROUND,
                };
                counts[place] += 1.0;
            }
            let mut expected = [0.0_f64; DOWN * AROUND + 1];
            let cell = 2.0 * TAU / (DOWN * AROUND * FINE * FINE) as f64;
            for down in 0..DOWN * FINE {
                for around in 0..AROUND * FINE {
                    let height = (down as f64 + 0.5) / (DOWN * FINE) as f64 * 2.0 - 1.0;
                    let angle = (around as f64 + 0.5) / (AROUND * FINE) as f64 * TAU;
                    let density = bsdf.density(&local, outgoing, direction(height, angle));
                    expected[down / FINE * AROUND + around / FINE] +=
                        density * cell * f64::from(SAMPLES);
                }
            }
            let rest = f64::from(SAMPLES) - expected.iter().sum::<f64>();
            expected[DOWN * AROUND] = rest;
            // No density integrates to more than 1; 0.2 % for the midpoints of narrow lobes.
            assert!(
                rest > -0.002 * f64::from(SAMPLES),
                "{name} at {cosine}: {rest}"
            );
            // Cells of few samples count as one.
            let (mut statistic, mut cells, mut few) = (0.0, 0.0, (0.0, 0.0));
            for (count, expected) in counts.into_iter().zip(expected) {
                if expected < 10.0 {
                    few = (few.0 + count, few.1 + expected.max(0.0));
                } else {
                    statistic += (count - expected) * (count - expected) / expected;
                    cells += 1.0;
                }
            }
            if few.1 > 10.0 {
                statistic += (few.0 - few.1) * (few.0 - few.1) / few.1;
                cells += 1.0;
            } else {
                assert!(few.0 < 40.0, "{name} at {cosine}: {few:?} of few");
            }
            // Wilson and Hilferty: the cube root is nearly normal.
            let freedom: f64 = cells - 1.0;
            if freedom > 0.0 {
                let spread = 2.0 / (9.0 * freedom);
                let deviations = (libm::cbrt(statistic / freedom) - 1.0 + spread) / spread.sqrt();
                assert!(
                    deviations < 4.0,
                    "{name} at {cosine}: {deviations:.1} deviations"
                );
            }
        }
    }
}

/// The weight of a sample is the function over the density.
#[test]
fn weights_are_the_function_over_the_density() {
    for (name, kind, relative_ior) in rough() {
        let (bsdf, local) = (bsdf(kind), local(relative_ior));
        let mut random = Random::new(4, 0);
        for _ in 0..2000 {
            let outgoing = outgoing(random.uniform(0.01, 1.0));
            let sampled = bsdf.sample(&local, outgoing, numbers(&mut random));
            let Some(Scattered {
                incoming,
                weight,
                density: Some(density),
            }) = sampled
            else {
                continue;
            };
            assert!((incoming.length() - 1.0).abs() < 1e-12, "{name}");
            let again = bsdf.density(&local, outgoing, incoming);
            assert!(
                (again / density - 1.0).abs() < 1e-6,
                "{name}: {again} {density}"
            );
            let expected = bsdf.evaluate(&local, outgoing, incoming) / density;
            let apart = (weight - expected).abs().max_element();
            assert!(
                apart <= 1e-6 * (1.0 + expected.max_element()),
                "{name}: {weight} {expected}"
            );
        }
    }
}

/// `f(o, i) = f(i, o)`, and with the squares of the indices through an interface.
#[test]
fn functions_are_reciprocal() {
    for (name, kind, relative_ior) in rough() {
        let bsdf = bsdf(kind);
        let mut random = Random::new(5, 0);
        for _ in 0..5000 {
            let there = outgoing(random.uniform(0.05, 1.0));
            let back = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, TAU));
            if back.z.abs() < 0.05 {
                continue;
            }
            let one = bsdf.evaluate(&local(relative_ior), there, back) / back.z.abs();
            let other = match back.z > 0.0 {
                true => bsdf.evaluate(&local(relative_ior), back, there) / there.z,
                // Seen from the far side, whose normal points there.
                false => {
                    let turned = local(1.0 / relative_ior);
                    let value = bsdf.evaluate(&turned, -back, -there) / there.z;
                    value / (relative_ior * relative_ior)
                }
            };
            let apart = (one - other).abs().max_element();
            assert!(apart <= 1e-7 * one.max_element(), "{name}: {one} {other}");
        }
    }
}

/// The mean weight, which is the light reflected or transmitted of a uniform surrounding, and
/// its standard deviation.
fn furnace(bsdf: &dyn Bsdf, local: &Local, outgoing: DVec3, is_far_scaled: bool) -> (f64, f64) {
    let samples = 40_000;
    let (mut sum, mut squares) = (0.0, 0.0);
    let mut random = Random::new(6, 0);
    for _ in 0..samples {
        let sampled = bsdf.sample(local, outgoing, numbers(&mut random));
        let weight = sampled.map_or(0.0, |sampled| {
            // In a uniform field the radiance is proportional to the square of the index.
            let far = sampled.incoming.z < 0.0 && is_far_scaled;
            sampled.weight.x
                * if far {
                    local.relative_ior * local.relative_ior
                } else {
                    1.0
                }
        });
        sum += weight;
        squares += weight * weight;
    }
    let count = f64::from(samples);
    let mean = sum / count;
    (
        mean,
        ((squares / count - mean * mean).max(0.0) / count).sqrt(),
    )
}

#[test]
fn white_surfaces_lose_no_light() {
    let mut kinds = vec![MaterialKind::Diffuse];
    for roughness in [0.0, 0.1, 0.3, 0.6, 1.0] {
        kinds.push(MaterialKind::Metal { roughness });
        for ior in [1.1, 1.5, 3.0] {
            kinds.push(MaterialKind::Plastic { roughness, ior });
        }
    }
    kinds.push(MaterialKind::Glass {
        roughness: 0.0,
        ior: 1.5,
    });
    for kind in kinds {
        let bsdf = bsdf(kind);
        for relative_ior in [1.5, 1.0 / 1.5] {
            let local = Local {
                color: DVec3::ONE,
                relative_ior,
            };
            for cosine in [1.0, 0.7, 0.3, 0.05] {
                let (mean, deviation) = furnace(&*bsdf, &local, outgoing(cosine), true);
                // 10^-3 for the interpolated albedo.
                let apart = (mean - 1.0).abs();
                assert!(
                    apart < 3.0 * deviation + 1e-3,
                    "{kind:?} at {cosine}: {mean} +- {deviation}"
                );
            }
        }
    }
}

/// The losses that `glass` states, for light that enters and light that leaves.
#[test]
fn rough_glass_loses_as_much_as_is_stated() {
    let stated = [
        (0.3, [(0.97, 1.0), (0.94, 0.99)]),
        (0.5, [(0.93, 0.99), (0.80, 0.93)]),
        (1.0, [(0.70, 0.89), (0.42, 0.50)]),
    ];
    for (roughness, ranges) in stated {
        let bsdf = bsdf(MaterialKind::Glass {
            roughness,
            ior: 1.5,
        });
        for (relative_ior, (least, greatest)) in [1.5, 1.0 / 1.5].into_iter().zip(ranges) {
            let local = Local {
                color: DVec3::ONE,
                relative_ior,
            };
            for cosine in [1.0, 0.7, 0.3] {
                let (mean, deviation) = furnace(&*bsdf, &local, outgoing(cosine), true);
                let accepted = least - 0.005..greatest + 0.005;
                let state = format!("{roughness} into {relative_ior:.2} at {cosine}: {mean}");
                assert!(accepted.contains(&mean), "{state}");
                assert!(mean < 1.0 + 3.0 * deviation, "{state}");
            }
        }
    }
}

/// What a colored metal reflects by its samples is the integral of its function.
#[test]
fn colored_metal_reflects_the_integral_of_its_function() {
    let local = Local {
        color: DVec3::splat(0.5),
        relative_ior: 1.0,
    };
    for roughness in [0.5, 1.0] {
        let bsdf = bsdf(MaterialKind::Metal { roughness });
        // By quadrature over the hemisphere, without the sampling.
        let outgoing = outgoing(0.8);
        let (steps, mut sum) = (400, 0.0);
        for up in 0..steps {
            for around in 0..steps {
                let height = (f64::from(up) + 0.5) / f64::from(steps);
                let angle = (f64::from(around) + 0.5) / f64::from(steps) * TAU;
                sum += bsdf.evaluate(&local, outgoing, direction(height, angle)).x;
            }
        }
        let reflected = sum * 2.0 * PI / f64::from(steps * steps);
        let (mean, deviation) = furnace(&*bsdf, &local, outgoing, false);
        assert!(
            (mean - reflected).abs() < 4.0 * deviation + 1e-4,
            "{mean} {reflected}"
        );
    }
}
