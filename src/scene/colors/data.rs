//! Colors that show data: a value of each solid, through a color map.

use glam::DVec3;

use super::map::ColorMap;

/// The color of solids without a value, unless the scene file states another.
pub(in crate::scene) const MISSING: DVec3 = DVec3::splat(0.5);

/// The color that shows the value of a solid in a column.
#[derive(Clone, Debug, PartialEq)]
pub struct DataColor {
    /// The column.
    pub column: String,
    /// The colors of the values.
    pub map: ColorMap,
    /// The values of the first and last color of a gradient: finite, the first less than the
    /// second. Values beyond the range have the nearest color.
    pub range: [f64; 2],
    /// The texts that stand for the values 0, 1, 2 and so on, and that a legend shows.
    pub labels: Vec<String>,
    /// The linear RGB color without a value, each component in [0, 1].
    pub missing: DVec3,
}

impl DataColor {
    /// The linear color of a value.
    #[must_use]
    pub fn at(&self, value: Option<f32>) -> DVec3 {
        let Some(value) = value else {
            return self.missing;
        };
        if self.map.has_categories() {
            // Loading accepts whole numbers, 0 or more; the conversion saturates.
            return self.map.of_category(value as u32);
        }
        let [first, last] = self.range;
        self.map.at((f64::from(value) - first) / (last - first))
    }

    /// The color in the middle of the range, or of the first category.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        self.map.at(0.5)
    }

    /// The greatest number of a category: greater whole numbers are not exact in f32.
    pub const GREATEST_CATEGORY: f64 = 16_777_216.0;

    /// Whether a number can be that of a category.
    #[must_use]
    pub fn is_category(number: f64) -> bool {
        (0.0..=Self::GREATEST_CATEGORY).contains(&number) && number.fract() == 0.0
    }

    /// What a [`ValueList`](super::ValueList) stores of a value: the nearest finite f32, or NaN.
    #[must_use]
    pub fn stored(number: f64) -> f32 {
        (number as f32).clamp(f32::MIN, f32::MAX)
    }

    /// The range of a gradient for values between these: with a single value, a range about it,
    /// and from 0 to 1 without any.
    #[must_use]
    pub fn automatic_range(values: Option<[f32; 2]>) -> [f64; 2] {
        let Some([least, greatest]) = values else {
            return [0.0, 1.0];
        };
        let [least, greatest] = [least, greatest].map(f64::from);
        if least < greatest {
            return [least, greatest];
        }
        // A relative part, because large numbers absorb 1/2.
        let beyond = (least.abs() * 1e-6).max(0.5);
        [least - beyond, least + beyond]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color(map: &str) -> DataColor {
        DataColor {
            column: "x".to_owned(),
            map: ColorMap::named(map).expect("a map"),
            range: [10.0, 20.0],
            labels: Vec::new(),
            missing: DVec3::X,
        }
    }

    #[test]
    fn values_are_mapped_linearly_and_clamped() {
        let gradient = color("viridis");
        let map = gradient.map;
        for (value, position) in [
            (10.0, 0.0),
            (12.5, 0.25),
            (20.0, 1.0),
            (9.0, 0.0),
            (1e9, 1.0),
        ] {
            assert_eq!(gradient.at(Some(value)), map.at(position), "{value}");
        }
        assert_eq!(gradient.at(None), DVec3::X);
        let categories = color("tab10");
        assert_eq!(categories.at(Some(3.0)), categories.map.of_category(3));
        assert_eq!(categories.at(Some(13.0)), categories.map.of_category(3));
    }

    #[test]
    fn automatic_ranges_are_never_empty() {
        assert_eq!(DataColor::automatic_range(None), [0.0, 1.0]);
        assert_eq!(DataColor::automatic_range(Some([-1.0, 4.0])), [-1.0, 4.0]);
        assert_eq!(DataColor::automatic_range(Some([7.0, 7.0])), [6.5, 7.5]);
        for value in [f32::MAX, f32::MIN, -0.0] {
            let [first, last] = DataColor::automatic_range(Some([value, value]));
            assert!(first < last && (last - first).is_finite(), "{value}");
        }
    }
}
