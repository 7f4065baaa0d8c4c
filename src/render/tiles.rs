//! The picture's tiles, spread over threads.
//!
//! A pixel is a pure function of its index, so the picture does not depend on
//! which thread computes what, or when.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::integrator::View;
use super::{Film, PixelSampler, RayCounts, RenderError, Settings};

/// Edge of a tile in pixels: near rays share what they read, and even a small
/// picture has tiles for many threads.
const TILE: u32 = 16;

struct Tile {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
}

/// Renders all tiles on the rayon pool that this is called in.
pub(super) fn render(
    view: &View,
    settings: &Settings,
    progress: &(dyn Fn(u64) + Sync),
    cancelled: &AtomicBool,
) -> Result<(Film, RayCounts), RenderError> {
    let size = settings.film;
    let across = size.width.div_ceil(TILE);
    let count = u64::from(across) * u64::from(size.height.div_ceil(TILE));
    let tile = |number: u64| {
        let x = (number % u64::from(across)) as u32 * TILE;
        let y = (number / u64::from(across)) as u32 * TILE;
        Tile {
            x,
            y,
            width: TILE.min(size.width - x),
            height: TILE.min(size.height - y),
        }
    };
    let rendered: Vec<_> = (0..count)
        .into_par_iter()
        .map(|number| {
            let rendered = render_tile(view, settings, &tile(number), cancelled)?;
            progress(rendered.0.len() as u64);
            Ok(rendered)
        })
        .collect::<Result<_, RenderError>>()?;

    let width = size.width as usize;
    let mut pixels = vec![[0.0; 3]; width * size.height as usize];
    let mut rays = RayCounts::default();
    for (number, (colors, tile_rays)) in (0..).zip(rendered) {
        rays = rays + tile_rays;
        let tile = tile(number);
        for (row, colors) in colors.chunks_exact(tile.width as usize).enumerate() {
            let start = (tile.y as usize + row) * width + tile.x as usize;
            pixels[start..start + colors.len()].copy_from_slice(colors);
        }
    }
    Ok((Film::new(size.width, size.height, pixels), rays))
}

/// The pixels of a tile, row by row, and the rays they took.
fn render_tile(
    view: &View,
    settings: &Settings,
    tile: &Tile,
    cancelled: &AtomicBool,
) -> Result<(Vec<[f32; 3]>, RayCounts), RenderError> {
    let mut colors = Vec::with_capacity((tile.width * tile.height) as usize);
    let mut rays = RayCounts::default();
    for y in tile.y..tile.y + tile.height {
        for x in tile.x..tile.x + tile.width {
            if cancelled.load(Ordering::Relaxed) {
                return Err(RenderError::Cancelled);
            }
            let pixel = u64::from(y) * u64::from(settings.film.width) + u64::from(x);
            let sampler = PixelSampler::new(settings.seed, pixel);
            let sum: DVec3 = (0..settings.spp)
                .map(|sample| view.sample((x, y), &sampler, sample, &mut rays))
                .sum();
            let mean = sum / f64::from(settings.spp);
            colors.push(mean.as_vec3().to_array());
        }
    }
    Ok((colors, rays))
}
