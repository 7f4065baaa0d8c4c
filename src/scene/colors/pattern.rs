//! Checkers and stripes over the parameters `u` and `v` of a surface.

use glam::DVec3;

/// A pattern of rectangles in two colors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// The colors, linear RGB, each component in [0, 1]; the first is that at `u = v = 0`.
    pub colors: [DVec3; 2],
    /// The numbers of rectangles along `u` and `v`, at least 1.
    pub count: [u32; 2],
}

/// A pattern of stripes of the same width.
#[derive(Clone, Debug, PartialEq)]
pub struct Stripes {
    /// The colors in turn, at least one, linear RGB, each component in [0, 1].
    pub colors: Vec<DVec3>,
    /// The number of stripes, at least 1.
    pub count: u32,
    /// The parameter that changes from stripe to stripe.
    pub along: Along,
}

/// A parameter of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// [`Hit::u`](crate::tracer::Hit::u).
    U,
    /// [`Hit::v`](crate::tracer::Hit::v).
    V,
}

impl Along {
    /// The names in scene files.
    pub const NAMES: [(&'static str, Self); 2] = [("u", Self::U), ("v", Self::V)];

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::V => "v",
        }
    }
}

impl Checker {
    /// The color at a place of a surface.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        let [across, along] = self.count;
        let parity = (part(u, across) ^ part(v, along)) & 1;
        self.colors[parity as usize]
    }
}

impl Stripes {
    /// The color at a place of a surface.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        let place = match self.along {
            Along::U => u,
            Along::V => v,
        };
        let stripe = part(place, self.count) as usize;
        self.colors[stripe % self.colors.len()]
    }
}

/// The number of the part of [0, 1], cut into `count` parts, that contains a place.
fn part(place: f64, count: u32) -> u32 {
    // The conversion saturates, so a place outside of [0, 1] is in the first or last part.
    ((place * f64::from(count)) as u32).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLORS: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];

    #[test]
    fn checker_alternates_along_both_parameters_and_ends_in_the_last_rectangle() {
        let checker = Checker {
            colors: [DVec3::X, DVec3::Y],
            count: [4, 2],
        };
        for (u, v, color) in [
            (0.0, 0.0, DVec3::X),
            (0.24, 0.49, DVec3::X),
            (0.26, 0.0, DVec3::Y),
            (0.26, 0.51, DVec3::X),
            (0.99, 0.0, DVec3::Y),
            (0.0, 1.0, DVec3::Y),
        ] {
            assert_eq!(checker.at(u, v), color, "{u} {v}");
        }
    }

    #[test]
    fn stripes_repeat_their_colors_in_turn() {
        let mut stripes = Stripes {
            colors: COLORS.to_vec(),
            count: 5,
            along: Along::V,
        };
        let places = [0.1, 0.3, 0.5, 0.7, 0.9, 1.0];
        let expected = [0, 1, 2, 0, 1, 1].map(|index: usize| COLORS[index]);
        assert_eq!(places.map(|v| stripes.at(0.0, v)), expected);
        stripes.along = Along::U;
        assert_eq!(places.map(|u| stripes.at(u, 0.0)), expected);
    }
}
