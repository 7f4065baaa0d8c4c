//! The true errors of a picture, against one that is nearly free of noise.

use cyltrace::scene;
use cyltrace_output::Film;

use super::Tiles;
use super::spread::DARK;

/// The relative error of each tile, as [`crate::Target`] defines it: the root mean square of the
/// differences of its pixels' components over the mean of these components in `reference`, or over
/// 0.01 where that is darker.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn tile_errors(picture: &Film, reference: &Film) -> Vec<f64> {
    let size = |film: &Film| (film.width(), film.height());
    assert_eq!(size(picture), size(reference), "pictures of one size");
    let (width, height) = size(picture);
    let tiles = Tiles::of(scene::Film { width, height });
    let error = |number| {
        let tile = tiles.tile(number);
        let (mut squares, mut sum) = (0.0, 0.0);
        for y in tile.y..tile.y + tile.height {
            let start = y as usize * width as usize + tile.x as usize;
            let row = start..start + tile.width as usize;
            let own = picture.pixels()[row.clone()].as_flattened();
            let other = reference.pixels()[row].as_flattened();
            for (&value, &truth) in own.iter().zip(other) {
                let (value, truth) = (f64::from(value), f64::from(truth));
                squares += (value - truth) * (value - truth);
                sum += truth;
            }
        }
        let count = 3.0 * tile.pixels() as f64;
        (squares / count).sqrt() / (sum / count).max(DARK)
    };
    (0..tiles.count()).map(error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_of_tiles_and_relative() {
        // Two tiles: one off by 0.1 at a mean of 2, one exact and black but for one component.
        let truth = |x: u32| if x < 16 { [2.0; 3] } else { [0.0; 3] };
        let reference: Vec<[f32; 3]> = (0..2 * 20).map(|n| truth(n % 20)).collect();
        let mut pixels = reference.clone();
        for (n, pixel) in pixels.iter_mut().enumerate() {
            if n % 20 < 16 {
                *pixel = pixel.map(|value| value + if n % 2 == 0 { 0.1 } else { -0.1 });
            }
        }
        pixels[17][1] = 0.024;
        let film = |pixels| Film::new(20, 2, pixels);
        let errors = tile_errors(&film(pixels), &film(reference));
        assert_eq!(errors.len(), 2);
        assert!((errors[0] - 0.05).abs() < 1e-6, "{errors:?}");
        let dark = 0.024 / 24.0_f64.sqrt() / 0.01;
        assert!((errors[1] - dark).abs() < 1e-6, "{errors:?}");
    }
}
