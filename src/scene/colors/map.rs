//! Named color maps: gradients for numbers, and lists of colors for categories.
//!
//! The colors are those of matplotlib and d3, from the crate `colorous`: 8-bit sRGB codes, which
//! are decoded to linear values here.

use colorous::{Color, Gradient};
use glam::DVec3;

use super::srgb::decode8;

/// A color map.
#[derive(Clone, Copy)]
pub struct ColorMap(&'static Named);

struct Named {
    name: &'static str,
    colors: Colors,
}

enum Colors {
    Gradient(Gradient),
    Categories(&'static [Color]),
}

const fn gradient(name: &'static str, colors: Gradient) -> Named {
    Named {
        name,
        colors: Colors::Gradient(colors),
    }
}

const fn categories(name: &'static str, colors: &'static [Color]) -> Named {
    Named {
        name,
        colors: Colors::Categories(colors),
    }
}

static MAPS: [Named; 45] = [
    gradient("viridis", colorous::VIRIDIS),
    gradient("magma", colorous::MAGMA),
    gradient("inferno", colorous::INFERNO),
    gradient("plasma", colorous::PLASMA),
    gradient("cividis", colorous::CIVIDIS),
    gradient("turbo", colorous::TURBO),
    gradient("cubehelix", colorous::CUBEHELIX),
    gradient("warm", colorous::WARM),
    gradient("cool", colorous::COOL),
    gradient("blues", colorous::BLUES),
    gradient("greens", colorous::GREENS),
    gradient("greys", colorous::GREYS),
    gradient("oranges", colorous::ORANGES),
    gradient("purples", colorous::PURPLES),
    gradient("reds", colorous::REDS),
    gradient("bugn", colorous::BLUE_GREEN),
    gradient("bupu", colorous::BLUE_PURPLE),
    gradient("gnbu", colorous::GREEN_BLUE),
    gradient("orrd", colorous::ORANGE_RED),
    gradient("pubu", colorous::PURPLE_BLUE),
    gradient("pubugn", colorous::PURPLE_BLUE_GREEN),
    gradient("purd", colorous::PURPLE_RED),
    gradient("rdpu", colorous::RED_PURPLE),
    gradient("ylgn", colorous::YELLOW_GREEN),
    gradient("ylgnbu", colorous::YELLOW_GREEN_BLUE),
    gradient("ylorbr", colorous::YELLOW_ORANGE_BROWN),
    gradient("ylorrd", colorous::YELLOW_ORANGE_RED),
    gradient("brbg", colorous::BROWN_GREEN),
    gradient("piyg", colorous::PINK_GREEN),
    gradient("prgn", colorous::PURPLE_GREEN),
    gradient("puor", colorous::PURPLE_ORANGE),
    gradient("rdbu", colorous::RED_BLUE),
    gradient("rdgy", colorous::RED_GREY),
    gradient("rdylbu", colorous::RED_YELLOW_BLUE),
    gradient("rdylgn", colorous::RED_YELLOW_GREEN),
    gradient("spectral", colorous::SPECTRAL),
    gradient("sinebow", colorous::SINEBOW),
    categories("tab10", &colorous::CATEGORY10),
    categories("tableau10", &colorous::TABLEAU10),
    categories("accent", &colorous::ACCENT),
    categories("dark2", &colorous::DARK2),
    categories("paired", &colorous::PAIRED),
    categories("set1", &colorous::SET1),
    categories("set2", &colorous::SET2),
    categories("set3", &colorous::SET3),
];

impl ColorMap {
    /// All color maps.
    pub fn all() -> impl Iterator<Item = Self> {
        MAPS.iter().map(Self)
    }

    /// The color map of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|map| map.name() == name)
    }

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Whether it shows categories; otherwise it shows a range of numbers.
    #[must_use]
    pub fn has_categories(self) -> bool {
        matches!(self.0.colors, Colors::Categories(_))
    }

    /// The linear color at a position in [0, 1] of a gradient; positions outside are clamped.
    /// The first color of a list of categories.
    #[must_use]
    pub fn at(self, position: f64) -> DVec3 {
        match self.0.colors {
            Colors::Gradient(gradient) => decode8(gradient.eval_continuous(position).as_array()),
            Colors::Categories(_) => self.of_category(0),
        }
    }

    /// The linear color of a category: the colors of the list in turn. A gradient has only
    /// one, its first.
    #[must_use]
    pub fn of_category(self, category: u32) -> DVec3 {
        match self.0.colors {
            Colors::Gradient(_) => self.at(0.0),
            Colors::Categories(colors) => {
                decode8(colors[category as usize % colors.len()].as_array())
            }
        }
    }
}

/// The first map, viridis.
impl Default for ColorMap {
    fn default() -> Self {
        Self(&MAPS[0])
    }
}

impl PartialEq for ColorMap {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl std::fmt::Debug for ColorMap {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(formatter, "ColorMap({})", self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colors that matplotlib 3.9 returns, as hexadecimal sRGB.
    #[test]
    fn colors_are_those_of_matplotlib() {
        let map = |name| ColorMap::named(name).expect("a map");
        for (name, position, codes) in [
            ("viridis", 0.0, [0x44, 0x01, 0x54]),
            ("viridis", 1.0, [0xfd, 0xe7, 0x25]),
            ("plasma", 0.0, [0x0d, 0x08, 0x87]),
            ("plasma", 1.0, [0xf0, 0xf9, 0x21]),
            ("inferno", 1.0, [0xfc, 0xff, 0xa4]),
        ] {
            let case = format!("{name} {position}");
            assert_eq!(map(name).at(position), decode8(codes), "{case}");
        }
        for (category, codes) in [
            (0, [0x1f, 0x77, 0xb4]),
            (1, [0xff, 0x7f, 0x0e]),
            (9, [0x17, 0xbe, 0xcf]),
            (10, [0x1f, 0x77, 0xb4]),
        ] {
            assert_eq!(map("tab10").of_category(category), decode8(codes));
        }
        assert_eq!(map("viridis").at(-3.0), map("viridis").at(0.0));
        assert_eq!(map("viridis").at(7.0), map("viridis").at(1.0));
    }

    #[test]
    fn names_are_unique_and_found() {
        let names: std::collections::BTreeSet<_> = ColorMap::all().map(ColorMap::name).collect();
        assert_eq!(names.len(), MAPS.len());
        assert!(ColorMap::named("Viridis").is_none());
    }
}
