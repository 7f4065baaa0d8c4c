//! Directions drawn from environments, against closed forms and sums over all directions.

use super::*;
use cyltrace::math::{Bounds, Random};
use cyltrace::scene::{AimedCamera, Camera, Film, Frame, Projection};
use glam::DVec2;

/// The map of a function of column and row.
fn map(width: u32, height: u32, pixel: impl FnMut(u32, u32) -> [f32; 3]) -> EnvironmentMap {
    EnvironmentMap::new(&environment(width, height, pixel))
}

fn environment(
    width: u32,
    height: u32,
    mut pixel: impl FnMut(u32, u32) -> [f32; 3],
) -> Environment {
    let pixels = (0..width * height).map(|index| pixel(index % width, index / width));
    Environment::new(width, height, pixels.collect()).expect("radiance")
}

/// Dark pixels, dim ones and a few that are very bright.
fn random_map(random: &mut Random) -> EnvironmentMap {
    let (width, height) = (1 + random.below(9) as u32, 1 + random.below(7) as u32);
    let mut environment = environment(width, height, |column, row| match random.below(5) {
        0 if (column, row) != (0, 0) => [0.0; 3],
        1 => [900.0, 400.0, 800.0],
        _ => [
            random.unit() as f32,
            random.unit() as f32,
            random.unit() as f32 + 1e-3,
        ],
    });
    environment.strength = random.log_uniform(0.1, 10.0);
    environment.rotate_degrees = random.uniform(-400.0, 400.0);
    EnvironmentMap::new(&environment)
}

fn direction(z: f64, azimuth: f64) -> DVec3 {
    let radius = (1.0 - z * z).sqrt();
    let (sine, cosine) = libm::sincos(azimuth);
    DVec3::new(radius * cosine, radius * sine, z)
}

/// The integral over directions by the midpoints of `2 n²` boxes of equal solid angle.
fn integral(n: usize, value: impl Fn(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for row in 0..n {
        let z = 1.0 - 2.0 * (row as f64 + 0.5) / n as f64;
        for column in 0..2 * n {
            sum += value(direction(z, PI * (column as f64 + 0.5) / n as f64));
        }
    }
    sum * TAU / (n * n) as f64
}

/// The mean over `n²` drawn directions of value over density.
fn drawn_integral(map: &EnvironmentMap, n: usize, value: impl Fn(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for cell in 0..n * n {
        let middle = |index: usize| (index as f64 + 0.5) / n as f64;
        let (direction, density) = map.sample((middle(cell / n), middle(cell % n)));
        sum += value(direction) / density;
    }
    sum / (n * n) as f64
}

fn irradiance(map: &EnvironmentMap, normal: DVec3) -> f64 {
    drawn_integral(map, 500, |direction| {
        map.radiance(direction).x * normal.dot(direction).max(0.0)
    })
}

#[test]
fn density_integrates_to_one_and_radiance_to_the_mean() {
    let mut random = Random::new(51, 0);
    for case in 0..12 {
        let map = random_map(&mut random);
        let all = integral(500, |direction| map.density(direction));
        assert!((all - 1.0).abs() < 2e-3, "case {case}: {all}");
        let mean = integral(500, |direction| map.radiance(direction).y) / (2.0 * TAU);
        let expected = map.mean_radiance().y;
        assert!(
            (mean / expected - 1.0).abs() < 2e-3,
            "case {case}: {mean}, {expected}"
        );
        let power = LUMINANCE.dot(map.mean_radiance()) * 2.0 * TAU;
        assert!((map.power() / power - 1.0).abs() < 1e-12, "case {case}");
    }
}

#[test]
fn drawn_directions_are_unit_vectors_of_the_stated_density() {
    let mut random = Random::new(52, 0);
    for case in 0..40 {
        let map = random_map(&mut random);
        for _ in 0..300 {
            let (direction, density) = map.sample((random.unit(), random.unit()));
            let name = format!("case {case}: {direction:?}");
            assert!((direction.length() - 1.0).abs() < 1e-14, "{name}");
            let found = map.density(direction);
            assert!(
                (found / density - 1.0).abs() < 1e-6,
                "{name}: {found}, {density}"
            );
            let luminance = LUMINANCE.dot(map.radiance(direction));
            assert!(
                (luminance / density / map.power() - 1.0).abs() < 1e-6,
                "{name}"
            );
        }
    }
}

/// Pearson's test of the numbers of directions in boxes of equal solid angle.
#[test]
fn drawn_directions_have_the_density_by_chi_squared() {
    const ROWS: usize = 12;
    const COLUMNS: usize = 24;
    const DRAWN: usize = 150_000;
    const FINE: usize = 16;
    let mut random = Random::new(53, 0);
    for case in 0..8 {
        let map = random_map(&mut random);
        let mut found = vec![0.0; ROWS * COLUMNS];
        for _ in 0..DRAWN {
            let (direction, _) = map.sample((random.unit(), random.unit()));
            let row = ((1.0 - direction.z) / 2.0 * ROWS as f64) as usize;
            let turns = libm::atan2(direction.y, direction.x) / TAU;
            let column = ((turns - turns.floor()) * COLUMNS as f64) as usize;
            found[row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)] += 1.0;
        }
        let mut expected = vec![0.0; ROWS * COLUMNS];
        let (rows, columns) = (ROWS * FINE, COLUMNS * FINE);
        for row in 0..rows {
            let z = 1.0 - 2.0 * (row as f64 + 0.5) / rows as f64;
            for column in 0..columns {
                let azimuth = TAU * (column as f64 + 0.5) / columns as f64;
                let density = map.density(direction(z, azimuth));
                let share = density * 2.0 * TAU / (rows * columns) as f64;
                expected[row / FINE * COLUMNS + column / FINE] += share * DRAWN as f64;
            }
        }
        let (mut statistic, mut boxes) = (0.0, 0.0);
        let (mut rare_found, mut rare_expected) = (0.0, 0.0);
        for (found, expected) in found.into_iter().zip(expected) {
            if expected < 10.0 {
                rare_found += found;
                rare_expected += expected;
            } else {
                let apart: f64 = found - expected;
                statistic += apart * apart / expected;
                boxes += 1.0;
            }
        }
        // Five standard deviations of the chi-squared distribution, and of a Poisson one.
        let freedom: f64 = f64::max(boxes - 1.0, 1.0);
        let limit = freedom + 5.0 * (2.0 * freedom).sqrt();
        assert!(statistic < limit, "case {case}: {statistic} of {freedom}");
        let apart: f64 = rare_found - rare_expected;
        assert!(
            apart.abs() < 5.0 * rare_expected.sqrt() + 5.0,
            "case {case}: {apart}"
        );
    }
}

#[test]
fn irradiance_of_a_constant_map_is_pi_times_its_radiance() {
    let map = map(8, 4, |_, _| [0.5, 0.25, 0.125]);
    assert!((map.mean_radiance() - DVec3::new(0.5, 0.25, 0.125)).length() < 1e-15);
    let density = map.density(DVec3::new(0.6, 0.0, 0.8));
    assert!((density - 0.5 / TAU).abs() < 1e-15, "{density}");
    for normal in [
        DVec3::Z,
        DVec3::NEG_Z,
        DVec3::X,
        DVec3::new(0.6, -0.64, 0.48),
    ] {
        let found = irradiance(&map, normal);
        assert!((found - 0.5 * PI).abs() < 1e-4, "{normal:?}: {found}");
    }
}

/// The interpolated pixel is a hat in longitude and in `z`, with the integral of half its base.
#[test]
fn irradiance_of_a_bright_pixel_is_its_integral_times_the_cosine() {
    let (width, height, column, row) = (720, 360, 100, 70);
    let map = map(width, height, |x, y| {
        [if (x, y) == (column, row) { 1e4 } else { 0.0 }; 3]
    });
    let z = |row: f64| libm::cos(PI * (row + 0.5) / f64::from(height));
    let row = f64::from(row);
    let solid_angle = TAU / f64::from(width) * 0.5 * (z(row - 1.0) - z(row + 1.0));
    assert!((map.power() / (1e4 * solid_angle) - 1.0).abs() < 1e-9);
    // From the left edge, at 180 degrees, to the right.
    let azimuth = PI - TAU * (f64::from(column) + 0.5) / f64::from(width);
    let middle = direction(z(row), azimuth);
    for normal in [DVec3::Z, DVec3::NEG_X, middle, -middle] {
        let expected = 1e4 * solid_angle * normal.dot(middle).max(0.0);
        let found = irradiance(&map, normal);
        assert!(
            (found - expected).abs() < 1e-4 * 1e4 * solid_angle,
            "{normal:?}: {found}"
        );
    }
}

/// The irradiance of the radiance `max(0, z)`: 2π/3 from above, nothing from below and
/// `∫ z sqrt(1 - z²) 2 dz = 2/3` on a wall.
#[test]
fn irradiance_of_a_cosine_lobe_is_that_of_its_integrals() {
    let map = map(16, 512, |_, row| {
        [libm::cos(PI * (f64::from(row) + 0.5) / 512.0).max(0.0) as f32; 3]
    });
    for (normal, expected) in [
        (DVec3::Z, TAU / 3.0),
        (DVec3::NEG_Z, 0.0),
        (DVec3::Y, 2.0 / 3.0),
    ] {
        let found = irradiance(&map, normal);
        assert!(
            (found - expected).abs() < 1e-4,
            "{normal:?}: {found}, {expected}"
        );
    }
}

#[test]
fn map_is_the_picture_of_a_panorama_camera_along_x() {
    let film = Film {
        width: 6,
        height: 5,
    };
    let pixel = |column: u32, row: u32| [column as f32 + 1.0, row as f32, 0.5];
    let environment = environment(film.width, film.height, pixel);
    let (map, mut turned) = (EnvironmentMap::new(&environment), environment);
    turned.rotate_degrees = 90.0;
    turned.strength = 3.0;
    let turned = EnvironmentMap::new(&turned);
    let camera = Camera {
        projection: Projection::Panorama,
        frame: Frame::LookAt {
            position: DVec3::ZERO,
            look_at: DVec3::X,
            up: DVec3::Z,
        },
        lens: None,
    };
    let camera = AimedCamera::new(&camera, &Bounds::EMPTY, film);
    for row in 0..film.height {
        for column in 0..film.width {
            let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let direction = camera.ray(middle).direction;
            let expected = color(pixel(column, row));
            assert!((map.radiance(direction) - expected).length() < 1e-12);
            let quarter = DVec3::new(-direction.y, direction.x, direction.z);
            assert!((turned.radiance(quarter) - expected * 3.0).length() < 1e-12);
        }
    }
}

#[test]
fn black_map_has_no_power_and_no_density() {
    let map = map(3, 2, |_, _| [0.0; 3]);
    assert_eq!((map.power(), map.mean_radiance()), (0.0, DVec3::ZERO));
    assert_eq!(map.sample((0.3, 0.6)), (DVec3::Z, 0.0));
    assert_eq!(map.density(DVec3::X), 0.0);
}
