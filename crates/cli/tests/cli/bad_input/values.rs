//! Values of the right type that mean nothing.

use super::Case;

const SOLID: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";

fn with_solid(name: &'static str, more: &str, message: &'static [&'static str]) -> Case {
    Case::new(name, format!("{SOLID}{more}"), message)
}

fn cylinder(name: &'static str, keys: &str, message: &'static [&'static str]) -> Case {
    Case::new(name, format!("[[cylinder]]\n{keys}\n"), message)
}

pub fn cases() -> Vec<Case> {
    vec![
        cylinder(
            "radius_nan",
            "p0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = nan",
            &["scene.toml:4:10", "the number is NaN", "must be finite"],
        ),
        cylinder(
            "radius_infinite",
            "p0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = +inf",
            &["scene.toml:4:10", "the number is inf"],
        ),
        cylinder(
            "coordinate_that_overflows",
            "p0 = [0, 1e999, 0]\np1 = [0, 0, 1]\nradius = 1",
            &["scene.toml:2:10", "number overflowed"],
        ),
        cylinder(
            "radius_negative",
            "p0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = -0.5",
            &[
                "scene.toml:4:10",
                "radius is -0.5",
                "must be a positive number",
                "4 | radius = -0.5",
            ],
        ),
        cylinder(
            "radius_zero",
            "p0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 0",
            &[
                "scene.toml:4:10",
                "radius is 0",
                "must be a positive number",
            ],
        ),
        cylinder(
            "length_zero",
            "p0 = [1, 2, 3]\np1 = [1, 2, 3]\nradius = 1",
            &["scene.toml:3:6", "p0 and p1 are 0.0 apart"],
        ),
        cylinder(
            "coordinate_too_large",
            "p0 = [1e100, 0, 0]\np1 = [0, 0, 1]\nradius = 1",
            &["scene.toml:2:6", "p0 is (1e100, 0.0, 0.0)", "at most"],
        ),
        with_solid(
            "film_width_zero",
            "[film]\nwidth = 0\n",
            &["scene.toml:6:9", "width is 0", "between 1 and 65536"],
        ),
        with_solid(
            "film_height_negative",
            "[film]\nheight = -720\n",
            &["scene.toml:6:10", "`-720`", "a whole number, 0 or more"],
        ),
        with_solid(
            "spp_zero",
            "[render]\nspp = 0\n",
            &["scene.toml:6:7", "spp is 0", "between 1 and"],
        ),
        with_solid(
            "fov_zero",
            "[camera]\nfov_degrees = 0\n",
            &["scene.toml:6:15", "fov_degrees is 0", "between 0 and 180"],
        ),
        with_solid(
            "fov_180",
            "[camera]\nfov_degrees = 180\n",
            &["scene.toml:6:15", "fov_degrees is 180", "between 0 and 180"],
        ),
        with_solid(
            "orthographic_height_zero",
            "[camera]\ntype = \"orthographic\"\nheight = 0\n",
            &["scene.toml:7:10", "height is 0", "positive"],
        ),
        with_solid(
            "camera_looks_at_its_position",
            "[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]\n",
            &["scene.toml:7:11", "the same point as position"],
        ),
        with_solid(
            "camera_up_along_the_view",
            "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 1]\n",
            &[
                "scene.toml:7:11",
                "looks along up, which is [0, 0, 1]",
                "up = [0, 1, 0]",
            ],
        ),
        with_solid(
            "camera_up_zero",
            "[camera]\nposition = [0, 9, 9]\nlook_at = [0, 0, 1]\nup = [0, 0, 0]\n",
            &["scene.toml:8:6", "up is zero"],
        ),
        with_solid(
            "sun_direction_zero",
            "[sun]\ndirection = [0, 0, 0]\n",
            &["scene.toml:6:13", "the sun's direction is zero"],
        ),
        with_solid(
            "sun_elevation_beyond_the_zenith",
            "[sun]\nelevation_degrees = 91\n",
            &[
                "scene.toml:6:21",
                "elevation_degrees is 91",
                "between -90 and 90",
            ],
        ),
        with_solid(
            "aperture_negative",
            "[camera]\naperture = -1\n",
            &["scene.toml:6:12", "aperture is -1", "diameter of the lens"],
        ),
        with_solid(
            "focus_zero",
            "[camera]\nfocus = 0\naperture = 1\n",
            &["scene.toml:6:9", "focus is 0", "positive number"],
        ),
        with_solid(
            "sun_strength_negative",
            "[sun]\nstrength = -1\n",
            &["scene.toml:6:12", "strength is -1", "not be negative"],
        ),
        with_solid(
            "turbidity_too_small",
            "[sky]\nmodel = \"clear\"\nturbidity = 1\n",
            &[
                "scene.toml:7:13",
                "turbidity is 1",
                "between 2 (clear) and 10",
            ],
        ),
        with_solid(
            "ground_above_one",
            "[sky]\nmodel = \"clear\"\nground = [0, 2, 0]\n",
            &["scene.toml:7:10", "ground is [0, 2, 0]", "in [0, 1]"],
        ),
        with_solid(
            "sky_color_negative",
            "[sky]\ncolor = [1, -1, 1]\n",
            &["scene.toml:6:9", "must not be negative"],
        ),
        with_solid(
            "background_negative",
            "[sky]\n",
            &["scene.toml:1:14", "must not be negative"],
        )
        .after("background = [0, 0, -1]\n"),
        with_solid(
            "material_color_above_one",
            "[[material]]\nname = \"a\"\ncolor = [1, 1.5, 1]\n",
            &["scene.toml:7:9", "must be in [0, 1]"],
        ),
        with_solid(
            "material_roughness_above_one",
            "[[material]]\nname = \"a\"\ncolor = [1, 1, 1]\nkind = \"metal\"\nroughness = 1.5\n",
            &[
                "scene.toml:9:13",
                "roughness is 1.5: it must be between 0 and 1",
            ],
        ),
        with_solid(
            "material_ior_below_one",
            "[[material]]\nname = \"a\"\nkind = \"glass\"\nior = 0.9\n",
            &["scene.toml:8:7", "ior is 0.9: it must be between 1 and 10"],
        ),
        with_solid(
            "material_strength_negative",
            "[[material]]\nname = \"a\"\nkind = \"light\"\nstrength = -1\n",
            &["scene.toml:8:12", "strength is -1: it must not be negative"],
        ),
        with_solid(
            "point_light_too_far",
            "[[point_light]]\nposition = [0, 1e60, 0]\n",
            &[
                "scene.toml:6:12",
                "position has a coordinate of the size 1.0e60",
            ],
        ),
        with_solid(
            "sphere_light_radius_zero",
            "[[sphere_light]]\ncenter = [0, 0, 0]\nradius = 0\n",
            &["scene.toml:7:10", "radius is 0: it must be positive"],
        ),
        with_solid(
            "sphere_light_radius_tiny",
            "[[sphere_light]]\ncenter = [0, 0, 0]\nradius = 1e-60\n",
            &["scene.toml:7:10", "radius is 1e-60: it must be between"],
        ),
        with_solid(
            "sphere_light_strength_negative",
            "[[sphere_light]]\ncenter = [0, 0, 0]\nradius = 1\nstrength = -3\n",
            &["scene.toml:8:12", "strength is -3: it must not be negative"],
        ),
        with_solid(
            "rectangle_light_edges_parallel",
            "[[rectangle_light]]\ncorner = [0, 0, 0]\nedges = [[1, 2, 0], [-2, -4, 0]]\n",
            &["scene.toml:7:9", "the edges are parallel", "edges = ["],
        ),
        with_solid(
            "rectangle_light_edge_zero",
            "[[rectangle_light]]\ncorner = [0, 0, 0]\nedges = [[1, 2, 0], [0, 0, 0]]\n",
            &[
                "scene.toml:7:21",
                "the length of an edge is 0: it must be positive",
            ],
        ),
        with_solid(
            "rectangle_light_color_negative",
            "[[rectangle_light]]\ncorner = [0, 0, 0]\nedges = [[1, 0, 0], [0, 1, 0]]\ncolor = [-1, 0, 0]\n",
            &["scene.toml:8:9", "must not be negative"],
        ),
    ]
}

impl Case {
    fn after(mut self, line: &str) -> Self {
        self.scene = [line.as_bytes(), &self.scene].concat().into();
        self
    }
}
