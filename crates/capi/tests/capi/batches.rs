//! Arrays of rays have the results of their rays one by one, bit for bit.

use cyltrace::math::{Random, Ray};
use cyltrace_c::*;
use glam::DVec3;

use super::loaded::Loaded;

/// More than two of the library's batches, with a rest that is no packet.
const COUNT: usize = 2 * 4096 + 19;

/// Coherent rays from the camera of `scenes/lattice.toml`, or incoherent ones through it.
fn rays(are_coherent: bool) -> Vec<CyltraceRay> {
    let mut random = Random::new(3, 0);
    let center = DVec3::new(12.0, 12.0, 0.0);
    let mut rays = Vec::with_capacity(COUNT);
    for number in 0..COUNT {
        let x = (number % 128) as f64 / 128.0 - 0.5;
        let y = (number / 128) as f64 / 64.0 - 0.5;
        let to = DVec3::new(12.2, 11.3, 0.2) + x * DVec3::new(18.0, -16.0, 0.0);
        let from = DVec3::new(-14.0, -19.0, 21.0);
        let mut ray = Ray::new(from, to + y * DVec3::new(0.0, 0.0, 14.0) - from);
        if !are_coherent {
            ray.origin = center + random.direction() * 20.0;
            ray.direction = center + random.direction() * 8.0 - ray.origin;
        }
        rays.push(CyltraceRay::from(&ray));
    }
    // Rays that no batch traces, among others that it does.
    rays[77].direction[1] = f64::NAN;
    rays[5000].t_max = 1e-3;
    rays
}

fn closest_with(scene: &Loaded, rays: &[CyltraceRay], fields: u32) -> Vec<CyltraceHit> {
    let mut hits = vec![CyltraceHit::MISS; rays.len()];
    // SAFETY: both arrays have as many elements as there are rays.
    let code = unsafe {
        let hits = hits.as_mut_ptr();
        cyltrace_closest_with(scene.0, rays.as_ptr(), rays.len(), fields, hits)
    };
    assert_eq!(code, CYLTRACE_OK);
    hits
}

fn occluded(scene: &Loaded, rays: &[CyltraceRay]) -> Vec<u8> {
    let mut occluded = vec![7; rays.len()];
    // SAFETY: both arrays have as many elements as there are rays.
    let code = unsafe {
        let occluded = occluded.as_mut_ptr();
        cyltrace_occluded(scene.0, rays.as_ptr(), rays.len(), occluded)
    };
    assert_eq!(code, CYLTRACE_OK);
    occluded
}

#[test]
fn arrays_have_the_bits_of_single_rays() {
    let scene = Loaded::new("lattice.toml");
    for are_coherent in [true, false] {
        let rays = rays(are_coherent);
        let singles = || rays.chunks(1);
        for fields in [CYLTRACE_FIELD_ALL, CYLTRACE_FIELD_NORMAL] {
            let hits = closest_with(&scene, &rays, fields);
            let hit_count = hits.iter().filter(|hit| hit.is_hit == 1).count();
            assert!((COUNT / 8..COUNT).contains(&hit_count), "{hit_count}");
            let one_by_one = singles().flat_map(|ray| closest_with(&scene, ray, fields));
            for (hit, expected) in hits.iter().zip(one_by_one) {
                // The text of a number names its bits; all NaN are the same.
                assert_eq!(format!("{hit:?}"), format!("{expected:?}"));
            }
        }
        let one_by_one = singles().flat_map(|ray| occluded(&scene, ray));
        assert_eq!(occluded(&scene, &rays), one_by_one.collect::<Vec<u8>>());
    }
}
