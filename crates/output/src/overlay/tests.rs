//! Legends over pictures of one color.

use super::*;
use crate::Band;
use crate::Film;

const GRAY: [f32; 3] = [0.25; 3];
const RED: [f32; 3] = [1.0, 0.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

fn range() -> Legend {
    Legend {
        title: "Weglänge in µm".to_owned(),
        corner: Corner::TopRight,
        size: 0.04,
        color: [0.0; 3],
        background: [1.0; 3],
        opacity: 1.0,
        scale: Scale::Range {
            ends: [0.1, 812.4],
            colors: vec![BLUE, RED],
        },
    }
}

fn categories() -> Legend {
    let list = [(RED, "axon"), (BLUE, "dendrite")];
    Legend {
        corner: Corner::BottomLeft,
        scale: Scale::Categories(list.map(|(color, text)| (color, text.to_owned())).into()),
        ..range()
    }
}

/// A gray picture with a legend.
fn picture(legend: &Legend, (width, height): (u32, u32)) -> Film {
    let mut pixels = vec![GRAY; (width * height) as usize];
    let overlay = legend.overlay((width, height));
    for (row, line) in (0..).zip(pixels.chunks_mut(width as usize)) {
        overlay.draw(row, line, None);
    }
    Film::new(width, height, pixels)
}

/// The pixels that are not of the picture: their number, and the first and last column and row.
fn drawn(film: &Film) -> (usize, [u32; 4]) {
    let (mut count, mut edges) = (0, [u32::MAX, 0, u32::MAX, 0]);
    for (position, _) in film
        .pixels()
        .iter()
        .enumerate()
        .filter(|(_, color)| **color != GRAY)
    {
        let (x, y) = (
            position as u32 % film.width(),
            position as u32 / film.width(),
        );
        count += 1;
        edges = [
            edges[0].min(x),
            edges[1].max(x),
            edges[2].min(y),
            edges[3].max(y),
        ];
    }
    (count, edges)
}

fn count(film: &Film, color: [f32; 3]) -> usize {
    film.pixels()
        .iter()
        .filter(|pixel| **pixel == color)
        .count()
}

#[test]
fn legends_are_in_their_corners_with_their_colors() {
    let film = picture(&range(), (400, 300));
    let (count_drawn, [left, right, top, bottom]) = drawn(&film);
    // Text of 12 pixels, so a margin of 10; the background is one rectangle.
    assert_eq!((right, top), (400 - 10 - 1, 10));
    assert_eq!(count_drawn as u32, (right - left + 1) * (bottom - top + 1));
    assert!(left > 200 && bottom < 200, "{left} {bottom}");
    // The bar is 11 x 108 pixels, half of it in either color, but for the ticks beside it.
    assert_eq!([RED, BLUE].map(|color| count(&film, color)), [11 * 54; 2]);

    let film = picture(&categories(), (400, 300));
    let (_, [left, _, _, bottom]) = drawn(&film);
    assert_eq!((left, bottom), (10, 300 - 10 - 1));
    assert_eq!([RED, BLUE].map(|color| count(&film, color)), [11 * 11; 2]);
}

/// A picture of twice the size has the same legend: pixels of 2 x 2 have its colors on average.
#[test]
fn legends_of_pictures_of_twice_the_size_are_the_same() {
    for legend in [range(), categories()] {
        let (small, large) = (picture(&legend, (450, 300)), picture(&legend, (900, 600)));
        let pixel = |x: u32, y: u32| large.pixels()[(y * 900 + x) as usize];
        let mut sum = 0.0;
        for y in 0..300 {
            for x in 0..450 {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let four = four.map(|(right, down)| pixel(2 * x + right, 2 * y + down)[1]);
                let mean = four.iter().sum::<f32>() / 4.0;
                sum += f64::from((mean - small.pixels()[(y * 450 + x) as usize][1]).abs());
            }
        }
        let of_legend = drawn(&small).0 as f64;
        assert!(
            sum / of_legend < 0.12,
            "{:?}: {}",
            legend.corner,
            sum / of_legend
        );
        // Text is sharp in both: most pixels are fully dark or fully light.
        for film in [&small, &large] {
            let ink = |range: std::ops::Range<f32>| {
                let greens = film.pixels().iter().filter(|pixel| **pixel != GRAY);
                greens
                    .filter(|[red, green, _]| red == green && range.contains(green))
                    .count()
            };
            let (dark, between) = (ink(0.0..0.1), ink(0.1..0.9));
            assert!(dark > 40, "{dark} dark, {between} between");
            assert!(between < 5 * dark, "{dark} dark, {between} between");
        }
    }
}

#[test]
fn legends_read_from_json_are_the_same() {
    let mut legend = range();
    legend.color = [0.1, 1.0 / 3.0, 0.7];
    if let Scale::Range { ends, .. } = &mut legend.scale {
        *ends = [-1.0 / 3.0, 1e300 / 3.0];
    }
    for legend in [legend, categories()] {
        let text = serde_json::to_string(&legend).expect("JSON");
        let read: Legend = serde_json::from_str(&text).expect("a legend");
        assert_eq!(read, legend);
        let value = serde_json::to_value(&legend).expect("JSON");
        let read: Legend = serde_json::from_str(&value.to_string()).expect("a legend");
        assert_eq!(read, legend);
    }
}

#[test]
fn pictures_smaller_than_the_legend_are_covered_as_far_as_they_go() {
    for size in [(1, 1), (7, 40), (40, 7), (3, 500)] {
        let film = picture(&range(), size);
        assert_eq!(film.pixels().len() as u32, size.0 * size.1);
    }
    // Bright colors shine through as white does.
    let mut legend = range();
    legend.opacity = 0.5;
    let overlay = legend.overlay((400, 300));
    let mut bands = with_overlay(Some(overlay), 400, true, |band: &mut Band| {
        band.colors.resize(400 * 30, [100.0; 3]);
        // Half opaque, and another channel.
        let words = [0.5_f32.to_bits(), 7];
        band.words = words.into_iter().cycle().take(2 * 400 * 30).collect();
        Ok(())
    });
    let mut band = Band::default();
    bands(&mut band).expect("a band");
    assert_eq!(band.colors[399], [100.0; 3]);
    assert_eq!(band.colors[400 * 11 + 388], [1.0; 3]);
    // What covers a half of what is half covered leaves a quarter open.
    let covered = 2 * (400 * 11 + 388);
    assert_eq!(band.words[covered..][..2], [0.75_f32.to_bits(), 7]);
    assert_eq!(band.words[2 * 399..][..2], [0.5_f32.to_bits(), 7]);
}
