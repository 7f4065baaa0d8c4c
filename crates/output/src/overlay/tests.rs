//! Legends, scale bars and axes over pictures of one color.

use std::f64::consts::PI;

use super::*;
use crate::Band;
use crate::Film;

const GRAY: [f32; 3] = [0.25; 3];
const RED: [f32; 3] = [1.0, 0.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

fn inset(corner: Corner) -> Inset {
    Inset {
        corner,
        size: 0.04,
        color: [0.0; 3],
        background: [1.0; 3],
        opacity: 1.0,
    }
}

fn range() -> Legend {
    Legend {
        title: "Weglänge in µm".to_owned(),
        inset: inset(Corner::TopRight),
        scale: Scale::Range {
            ends: [0.1, 812.4],
            colors: vec![BLUE, RED],
        },
    }
}

fn categories() -> Legend {
    let list = [(RED, "axon"), (BLUE, "dendrite")];
    Legend {
        inset: inset(Corner::BottomLeft),
        scale: Scale::Categories(list.map(|(color, text)| (color, text.to_owned())).into()),
        ..range()
    }
}

/// A gray picture with a legend.
fn picture(legend: &Legend, size: (u32, u32)) -> Film {
    with(&legend.overlay(size), size)
}

/// A gray picture with something over it.
fn with(overlay: &Overlay, (width, height): (u32, u32)) -> Film {
    let mut pixels = vec![GRAY; (width * height) as usize];
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
            legend.inset.corner,
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
    legend.inset.color = [0.1, 1.0 / 3.0, 0.7];
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
    legend.inset.opacity = 0.5;
    let overlay = legend.overlay((400, 300));
    let mut bands = with_overlays(vec![overlay], 400, true, |band: &mut Band| {
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

/// The length of the bar of a picture, from the row with most ink.
fn ink(film: &Film) -> f64 {
    let rows = film.pixels().chunks(film.width() as usize);
    let of_row = |row: &[[f32; 3]]| -> f64 {
        let white = row.iter().filter(|pixel| **pixel != GRAY);
        white.map(|pixel| f64::from(1.0 - pixel[0])).sum()
    };
    rows.map(of_row).fold(0.0, f64::max)
}

#[test]
fn scale_bars_have_their_length_to_a_part_of_a_pixel() {
    for corner in [
        Corner::TopLeft,
        Corner::TopRight,
        Corner::BottomLeft,
        Corner::BottomRight,
    ] {
        for (pixels, scale) in [(83.37, 1), (83.37, 2), (200.0, 1), (0.25, 1)] {
            let size = (400 * scale, 300 * scale);
            let per_unit = pixels * f64::from(scale) / 7.0;
            let mut inset = inset(corner);
            if pixels < 1.0 {
                // The text has more ink than a short bar.
                inset.size = 1e-9;
            }
            let bar = ScaleBar::new(Some(7.0), "µm", inset, per_unit, size).expect("room");
            assert_eq!(bar.label, "7 µm");
            let length = ink(&with(&bar.overlay(size), size));
            let expected = pixels * f64::from(scale);
            assert!((length - expected).abs() < 1e-3, "{length} {expected}");
        }
    }
}

/// A fifth of 400 pixels is 80.
#[test]
fn scale_bars_without_a_length_have_a_round_one_near_a_fifth_of_the_width() {
    for (per_unit, label) in [
        (80.0, "1"),
        (17.0, "5"),
        (8.0, "10"),
        (80.0 * 1.42, "0.5"),
        (80.0 / 1.42, "2"),
        (80.0 / 3.1, "2"),
        (80.0 / 3.2, "5"),
        (8e-5, "1e6"),
        (4e5, "0.0002"),
        (8e6, "1e\u{2212}5"),
    ] {
        let bar = ScaleBar::new(None, "", inset(Corner::TopLeft), per_unit, (400, 300));
        let bar = bar.expect("room");
        assert_eq!(bar.label, label, "{per_unit}");
        let share = bar.length * 300.0 / 80.0;
        assert!((0.63..1.6).contains(&share), "{per_unit}: {share}");
    }
}

#[test]
fn scale_bars_longer_than_the_picture_are_refused() {
    // Text of 12 pixels has 7 and 10 beside it.
    let bar = |length| ScaleBar::new(Some(length), "", inset(Corner::TopLeft), 1.0, (400, 300));
    assert!(bar(366.0).is_ok() && bar(364.0).is_ok());
    let error = bar(732.0).expect_err("too long").to_string();
    assert!(
        error.contains("length 732 is 2.000 times as long"),
        "{error}"
    );
    assert!(error.contains("at most 364, or none"), "{error}");
    // A bar of no stated length fits into the smallest picture.
    for size in [(1, 1), (20, 200), (40, 30)] {
        let bar = ScaleBar::new(None, "", inset(Corner::TopLeft), 7.0, size).expect("room");
        let room = inset(Corner::TopLeft).room(size).max(1.0);
        assert!(bar.length * size.1 as f32 <= room, "{size:?}");
    }
}

/// An axis to the right, one upward and one to the viewer.
fn axes() -> Axes {
    Axes {
        directions: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        labels: false,
        inset: inset(Corner::TopLeft),
    }
}

/// The line of an axis of the length 1 is 2.2 heights of the text, with round ends of 0.18.
#[test]
fn axes_point_where_the_camera_sees_them() {
    for scale in [1, 2] {
        let size = (400 * scale, 300 * scale);
        let film = with(&axes().overlay(size), size);
        let text = 12.0 * f64::from(scale);
        let half = (3.35 * text).round();
        let middle = (0.8 * text).round() + (0.6 * text).round() + half;
        // What a color takes of white in the column or row through the middle.
        let at = |x: f64, y: f64| {
            film.pixels()[y as usize * film.width() as usize + x as usize].map(f64::from)
        };
        let tip = 2.2 * text;
        let red = at(middle + tip - 2.0, middle);
        assert!(red[0] > 0.7 && red[1] < 0.1, "{red:?}");
        let blue = at(middle, middle - tip + 2.0);
        assert!(blue[2] > 0.8 && blue[0] < 0.1, "{blue:?}");
        // The axis to the viewer is a dot before the others.
        let green = at(middle, middle);
        assert!(
            green[1] > 0.25 && green[0] < 0.15 && green[2] < 0.15,
            "{green:?}"
        );
        for (x, y) in [(-tip, 0.0), (0.0, tip), (tip, tip), (tip + 4.0, 0.0)] {
            assert_eq!(at(middle + x, middle + y), [1.0; 3], "{x} {y}");
        }
        // The ink of the line to the right, but for the dot: length and width.
        let mut area = 0.0;
        for y in 0..film.height() {
            for x in (middle as u32 + 4 * scale)..(middle as u32 + 4 * text as u32) {
                let pixel = at(f64::from(x), f64::from(y));
                let is_red = pixel[0] > pixel[2] + 1e-6 && pixel != [0.25; 3];
                area += if is_red { (1.0 - pixel[1]) / 0.98 } else { 0.0 };
            }
        }
        let width = 0.18 * text;
        let expected = (tip - 4.0 * f64::from(scale)) * width + 0.125 * width * width * PI;
        assert!((area / expected - 1.0).abs() < 0.02, "{area} {expected}");
    }
}

#[test]
fn scale_bars_and_axes_read_from_json_are_the_same() {
    let bar = ScaleBar::new(None, "µm", inset(Corner::TopLeft), 1.0 / 3.0, (300, 200));
    let insets = Insets {
        legend: Some(range()),
        scale_bar: Some(bar.expect("room")),
        axes: Some(axes()),
    };
    assert_eq!(insets.overlays((300, 200)).len(), 3);
    let value = serde_json::to_value(&insets).expect("JSON");
    let read: Insets = serde_json::from_str(&value.to_string()).expect("insets");
    assert_eq!(read, insets);
}
