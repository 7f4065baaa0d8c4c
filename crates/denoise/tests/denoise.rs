//! The noise of a picture with an edge is less afterwards, where the library is installed.

use cyltrace_denoise::{DenoiseError, Denoiser, LIBRARY, Picture};

const SIDE: usize = 96;

/// The library, or `None` with a printed reason. A missing one must be reported with its name.
fn library() -> Option<Denoiser> {
    match Denoiser::load() {
        Ok(denoiser) => Some(denoiser),
        Err(error) => {
            assert!(matches!(error, DenoiseError::Load { .. }), "{error}");
            assert!(error.to_string().contains(LIBRARY), "{error}");
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// A number in [0, 1) for each pixel.
fn noise(pixel: usize) -> f32 {
    let mixed = (pixel as u32).wrapping_mul(2_654_435_761);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
    ((mixed ^ (mixed >> 13)) >> 8) as f32 / (1 << 24) as f32
}

#[test]
fn noise_is_reduced_and_edges_stay() {
    let Some(denoiser) = library() else {
        return;
    };
    let truth = |pixel: usize| match pixel % SIDE < SIDE / 2 {
        true => [0.2, 0.4, 0.6],
        false => [0.8, 0.4, 0.1],
    };
    let albedo: Vec<_> = (0..SIDE * SIDE).map(truth).collect();
    let normals = vec![[0.0, 0.0, 1.0]; SIDE * SIDE];
    let noisy = |pixel| truth(pixel).map(|component| component * 2.0 * noise(pixel));
    let mut colors: Vec<_> = (0..SIDE * SIDE).map(noisy).collect();
    let error = |colors: &[[f32; 3]]| {
        let pairs = colors.as_flattened().iter().zip(albedo.as_flattened());
        pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f32>() / (3 * SIDE * SIDE) as f32
    };
    let before = error(&colors);
    let mut picture = Picture {
        width: SIDE,
        height: SIDE,
        colors: &mut colors,
        albedo: &albedo,
        normals: &normals,
    };
    denoiser.denoise(&mut picture, 2).expect("denoised");
    let after = error(&colors);
    assert!(after < 0.02 * before, "{before} {after}");
}
