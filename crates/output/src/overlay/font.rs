//! Text in the embedded font, a part of DejaVu Sans (`LICENSE-DejaVu`).

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontRef, Glyph, PxScale, ScaleFont, point};

use super::canvas::Canvas;

static FONT: LazyLock<FontRef> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("DejaVuSans-subset.ttf")).expect("a valid font")
});

/// The glyphs of a line of text of this height, from the left end of its base line at the
/// origin, and the length of the line.
fn glyphs(text: &str, height: f32) -> (Vec<Glyph>, f32) {
    let scale = PxScale::from(height);
    let font = FONT.as_scaled(scale);
    let mut glyphs: Vec<Glyph> = Vec::new();
    let mut end = 0.0;
    for character in text.chars() {
        let id = font.glyph_id(character);
        if let Some(last) = glyphs.last() {
            end += font.kern(last.id, id);
        }
        glyphs.push(id.with_scale_and_position(scale, point(end, 0.0)));
        end += font.h_advance(id);
    }
    (glyphs, end)
}

/// The length of a line of text of this height, in pixels.
pub(super) fn length(text: &str, height: f32) -> f32 {
    glyphs(text, height).1
}

/// Draws a line of text of this height with its middle near a position. It may be beside the
/// middle by half a pixel.
pub(super) fn draw_around(
    canvas: &mut Canvas,
    text: &str,
    height: f32,
    [x, y]: [f32; 2],
    color: [f32; 3],
) {
    let left = (x - 0.5 * length(text, height)).round() as i32;
    let top = (y - 0.5 * height).round() as i32;
    draw(canvas, text, height, [left, top], color);
}

/// Draws a line of text of this height, which is the distance from the lowest to the highest
/// letters; its left upper corner is a whole pixel.
pub(super) fn draw(
    canvas: &mut Canvas,
    text: &str,
    height: f32,
    [left, top]: [i32; 2],
    color: [f32; 3],
) {
    // A base line on whole pixels keeps the feet of letters sharp.
    let base = FONT.as_scaled(PxScale::from(height)).ascent().round() as i32;
    for glyph in glyphs(text, height).0 {
        if let Some(outline) = FONT.outline_glyph(glyph) {
            let corner = outline.px_bounds().min;
            let (x, y) = (left + corner.x as i32, top + base + corner.y as i32);
            outline.draw(|column, row, coverage| {
                let pixel = [x + column as i32, y + row as i32];
                canvas.cover(pixel, color, coverage.clamp(0.0, 1.0));
            });
        }
    }
}
