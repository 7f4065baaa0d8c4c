//! A picture has the same bits whatever traces it: either layout, built at once
//! or on the way, any instruction set, any number of threads; and those of the
//! version that traced ray by ray, whose pictures are kept here as a number.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::{self, Integrator, Scene, load};
use cyltrace::tracer::{Layout, Options, Tracer, workers};
use cyltrace_render::{Picture, Settings, render};

fn sample(name: &str) -> Arc<Scene> {
    let scenes = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenes");
    Arc::new(load(&scenes.join(name)).unwrap())
}

/// A small picture; its size is no multiple of a tile's.
fn picture(scene: &Arc<Scene>, integrator: Integrator, options: &Options, pool: usize) -> Picture {
    let tracer = Tracer::new(Arc::clone(scene), options).unwrap();
    let settings = Settings {
        film: scene::Film {
            width: 57,
            height: 41,
        },
        spp: 3,
        integrator,
        ..Settings::of(scene)
    };
    let pool = workers(NonZeroUsize::new(pool)).unwrap();
    render(&tracer, &settings, &pool, &|_| {}, &AtomicBool::new(false)).unwrap()
}

/// The bits of all pixels, as one number (FNV-1a, of words rather than bytes).
fn fingerprint(picture: &Picture) -> u64 {
    let words = picture.film.pixels().iter().flatten();
    words.fold(0xcbf2_9ce4_8422_2325, |hash, word| {
        (hash ^ u64::from(word.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Of the version that traced every ray by itself: how many rays go to the sun
/// and to the sky, and the fingerprints by [`INTEGRATORS`].
const BEFORE_PACKETS: [(&str, [u64; 2], [u64; 3]); 4] = [
    (
        "minimal.toml",
        [1805, 2001],
        [
            0x7c86_730a_1d2b_7881,
            0xf5d6_7e60_6b45_dd26,
            0x0335_cb24_1137_98e3,
        ],
    ),
    (
        "forest.toml",
        [5094, 6032],
        [
            0x7cf7_e784_a090_5ddd,
            0x8175_2d5d_d4f4_bdfe,
            0x98ce_e976_c899_ed28,
        ],
    ),
    (
        "lattice.toml",
        [6216, 7011],
        [
            0xde20_9f7b_4a18_ecb1,
            0xc643_e5e6_727c_542b,
            0x1bf5_cfc8_8d98_eb6f,
        ],
    ),
    (
        "pathological.toml",
        [6201, 6437],
        [
            0x3c12_4977_7ed5_0a46,
            0x4203_2781_1381_da8e,
            0x74fb_cdea_be5d_57dd,
        ],
    ),
];

const INTEGRATORS: [Integrator; 3] = [Integrator::Sun, Integrator::Ao, Integrator::Normal];

#[test]
fn pictures_are_those_of_rays_traced_one_by_one() {
    for (name, [to_sun, to_sky], fingerprints) in BEFORE_PACKETS {
        // That version's sun had no extent.
        let mut scene = Scene::clone(&sample(name));
        if let Some(sun) = &mut scene.sun {
            sun.angle_degrees = 0.0;
        }
        let scene = Arc::new(scene);
        for (integrator, wanted) in INTEGRATORS.into_iter().zip(fingerprints) {
            let rays = match integrator {
                Integrator::Sun => [to_sun, to_sky],
                Integrator::Ao => [0, to_sky],
                Integrator::Normal | Integrator::Path => [0, 0],
            };
            for layout in [Layout::Single, Layout::Block] {
                let options = Options {
                    layout,
                    ..Default::default()
                };
                let made = picture(&scene, integrator, &options, 2);
                let what = format!("{name}, {integrator:?}, {layout:?}");
                assert_eq!([made.rays.shadow, made.rays.ao], rays, "{what}");
                let found = fingerprint(&made);
                assert_eq!(found, wanted, "{what}: {found:#x}, not {wanted:#x}");
            }
        }
    }
}

#[test]
fn pictures_do_not_depend_on_layout_build_time_instructions_or_threads() {
    let scene = sample("forest.toml");
    for integrator in [Integrator::Sun, Integrator::Path] {
        let wanted = picture(&scene, integrator, &Options::default(), 1);
        let with_threads = |threads| (Options::default(), threads);
        let ways = test_support::ways_to_trace()
            .into_iter()
            .map(|way| (way, 2));
        for (options, threads) in ways.chain([2, 7].map(with_threads)) {
            let made = picture(&scene, integrator, &options, threads);
            let what = format!("{integrator:?}, {options:?}, {threads} threads");
            assert!(made.film == wanted.film, "{what}");
            assert_eq!(made.rays, wanted.rays, "{what}");
        }
    }
}
