//! A rectangle of pixels that is drawn on.

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
