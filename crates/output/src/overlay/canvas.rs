//! A rectangle of pixels that is drawn on.

use glam::Vec2;

/// Pixels of linear RGB times opacity, and opacity.
pub(super) struct Canvas {
    pub width: u32,
    pub pixels: Vec<[f32; 4]>,
}

impl Canvas {
    /// A canvas of one color and opacity.
    pub fn new([width, height]: [u32; 2], [red, green, blue]: [f32; 3], opacity: f32) -> Self {
        let pixel = [red * opacity, green * opacity, blue * opacity, opacity];
        Self {
            width,
            pixels: vec![pixel; width as usize * height as usize],
        }
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.pixels.len() as u32 / self.width.max(1)
    }

    /// Covers a part of a pixel with a color. Pixels outside are ignored.
    pub fn cover(&mut self, [column, row]: [i32; 2], color: [f32; 3], part: f32) {
        let (Ok(column), Ok(row)) = (u32::try_from(column), u32::try_from(row)) else {
            return;
        };
        if column >= self.width {
            return;
        }
        let position = row as usize * self.width as usize + column as usize;
        if let Some(pixel) = self.pixels.get_mut(position) {
            let [red, green, blue] = color;
            let over = [red, green, blue, 1.0];
            *pixel =
                std::array::from_fn(|channel| over[channel] * part + pixel[channel] * (1.0 - part));
        }
    }

    /// Fills a rectangle between any positions: a pixel is covered by the part that is within.
    pub fn fill_between(
        &mut self,
        [left, top]: [f32; 2],
        [right, bottom]: [f32; 2],
        color: [f32; 3],
    ) {
        let within = |pixel: i32, first: f32, last: f32| {
            let pixel = pixel as f32;
            (last.min(pixel + 1.0) - first.max(pixel)).max(0.0)
        };
        for row in top.floor() as i32..bottom.ceil() as i32 {
            for column in left.floor() as i32..right.ceil() as i32 {
                let part = within(column, left, right) * within(row, top, bottom);
                self.cover([column, row], color, part);
            }
        }
    }

    /// Draws a line with round ends of a width between two positions. The part of a pixel that
    /// is covered falls over the width of a pixel at the edges.
    pub fn line(&mut self, [from, to]: [Vec2; 2], width: f32, color: [f32; 3]) {
        let reach = Vec2::splat(0.5 * width + 1.0);
        let (low, high) = (from.min(to) - reach, from.max(to) + reach);
        let along = to - from;
        for row in low.y.floor() as i32..high.y.ceil() as i32 {
            for column in low.x.floor() as i32..high.x.ceil() as i32 {
                let middle = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) - from;
                let length = along.length_squared().max(f32::MIN_POSITIVE);
                let nearest = along * (middle.dot(along) / length).clamp(0.0, 1.0);
                let beyond = middle.distance(nearest) - 0.5 * width;
                self.cover([column, row], color, (0.5 - beyond).clamp(0.0, 1.0));
            }
        }
    }

    /// Fills a rectangle of whole pixels; `color` gets the row within it.
    pub fn fill(
        &mut self,
        [left, top]: [i32; 2],
        [width, height]: [i32; 2],
        color: impl Fn(i32) -> [f32; 3],
    ) {
        for row in 0..height {
            let color = color(row);
            for column in 0..width {
                self.cover([left + column, top + row], color, 1.0);
            }
        }
    }
}
