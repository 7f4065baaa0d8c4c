//! Keys that are unknown, are missing, exclude each other or are of a wrong
//! type.

use super::Case;

const SOLID: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";

fn with_solid(name: &'static str, more: &str, message: &'static [&'static str]) -> Case {
    Case::new(name, format!("{SOLID}{more}"), message)
}

pub fn cases() -> Vec<Case> {
    vec![
        with_solid(
            "key_unknown_in_a_cylinder",
            "colour = [1, 1, 1]\n",
            &[
                "scene.toml:5:1",
                "unknown key \"colour\"",
                "\"material\"",
                "5 | colour",
            ],
        ),
        with_solid(
            "table_unknown",
            "[lamp]\nstrength = 3\n",
            &["scene.toml:5:2", "unknown key \"lamp\"", "\"sun\""],
        ),
        with_solid(
            "key_unknown_in_columns",
            "[[cylinder_table]]\nfile = \"t.csv\"\ncolumns = { p0 = [\"a\", \"b\", \"c\"], end = [\"a\", \"b\", \"c\"] }\n",
            &["scene.toml:7:35", "unknown key \"end\"", "\"p1\""],
        ),
        with_solid(
            "records_of_unknown_numbers",
            "",
            &[
                "scene.toml:1:11",
                "\"f16\" is not a value of records",
                "\"f32\"",
            ],
        )
        .preceded_by("records = \"f16\"\n"),
        Case::new(
            "key_missing_in_a_cylinder",
            "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\n",
            &["scene.toml:1:1", "missing field `radius`"],
        ),
        with_solid(
            "instance_without_of",
            "[[instance]]\nscale = 2\n",
            &["scene.toml:5:1", "missing field `of`"],
        ),
        Case::new(
            "cylinder_stated_as_one_table",
            "[cylinder]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n",
            &[
                "scene.toml:1:1",
                "[cylinder] is a single table",
                "write [[cylinder]]",
            ],
        ),
        with_solid(
            "film_stated_as_an_array",
            "",
            &["scene.toml:1:8", "expected a table of keys"],
        )
        .preceded_by("film = [1280, 720]\n"),
        with_solid(
            "instance_stated_as_inline_table",
            "",
            &["scene.toml:1:12", "write [[instance]]"],
        )
        .preceded_by("instance = { of = \"a\" }\n"),
        with_solid(
            "prototype_cylinder_stated_as_one_table",
            "[[prototype]]\nname = \"a\"\n[prototype.cylinder]\nradius = 1\n",
            &["scene.toml:7:1", "write [[prototype.cylinder]]"],
        ),
        Case::new(
            "cylinder_stated_as_one_table_twice",
            "[cylinder]\nradius = 1\n[cylinder]\nradius = 1\n",
            &["scene.toml:3:", "write [[cylinder]]"],
        ),
        with_solid(
            "camera_stated_as_a_list",
            "[[camera]]\nframe = \"auto\"\n",
            &[
                "scene.toml:5:1",
                "camera must be a single table",
                "write [camera] once",
            ],
        ),
        with_solid(
            "background_behind_a_table",
            "[film]\nwidth = 9\nbackground = [0, 0, 0]\n",
            &[
                "scene.toml:7:1",
                "unknown key \"background\"",
                "top-level keys go before the first [table]",
            ],
        ),
        Case::new(
            "key_misspelt",
            "[[cylinder]]\nraduis = 1\n",
            &[
                "scene.toml:2:1",
                "unknown key \"raduis\"",
                "did you mean \"radius\"?",
            ],
        ),
        with_solid(
            "table_misspelt",
            "[[cylinders]]\nradius = 1\n",
            &["scene.toml:5:3", "did you mean \"cylinder\"?"],
        ),
        with_solid(
            "film_of_too_many_pixels",
            "[film]\nwidth = 32768\nheight = 16384\n",
            &["scene.toml:6:9", "32768 x 16384", "268435456"],
        ),
        Case::new(
            "radius_that_is_text",
            "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = \"1\"\n",
            &[
                "scene.toml:4:10",
                "invalid type: string \"1\", expected a number",
            ],
        ),
        Case::new(
            "point_of_two_numbers",
            "[[cylinder]]\np0 = [0, 0]\np1 = [0, 0, 1]\nradius = 1\n",
            &[
                "scene.toml:2:6",
                "invalid length 2, expected an array of length 3",
            ],
        ),
        Case::new(
            "point_of_four_numbers",
            "[[cylinder]]\np0 = [0, 0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n",
            &[
                "scene.toml:2:6",
                "invalid length 4, expected an array of length 3",
            ],
        ),
        with_solid(
            "width_with_a_fraction",
            "[film]\nwidth = 12.5\n",
            &["scene.toml:6:9", "expected a whole number, 0 or more"],
        ),
        with_solid(
            "caps_unknown",
            "caps = \"p2\"\n",
            &[
                "scene.toml:5:8",
                "\"p2\" is not a value of caps",
                "did you mean \"p0\"?",
                "\"both\"",
            ],
        ),
        with_solid(
            "integrator_unknown",
            "[render]\nintegrator = \"photons\"\n",
            &[
                "scene.toml:6:14",
                "\"photons\" is not a value of integrator",
                "\"ao\"",
            ],
        ),
        with_solid(
            "camera_type_unknown",
            "[camera]\ntype = \"fisheye\"\n",
            &[
                "scene.toml:6:8",
                "\"fisheye\" is not a value of type",
                "\"orthographic\"",
            ],
        ),
        with_solid(
            "frame_unknown",
            "[camera]\nframe = \"fit\"\n",
            &[
                "scene.toml:6:9",
                "\"fit\" is not a value of frame",
                "\"auto\"",
            ],
        ),
        with_solid(
            "frame_and_position",
            "[camera]\nframe = \"auto\"\nposition = [1, 2, 3]\n",
            &["scene.toml:6:9", "excludes position"],
        ),
        with_solid(
            "position_without_look_at",
            "[camera]\nposition = [1, 2, 3]\n",
            &["scene.toml:6:12", "needs both position and look_at"],
        ),
        with_solid(
            "fov_of_an_orthographic_camera",
            "[camera]\ntype = \"orthographic\"\nfov_degrees = 30\n",
            &["scene.toml:7:15", "an orthographic one has a height"],
        ),
        with_solid(
            "height_of_a_perspective_camera",
            "[camera]\nheight = 30\n",
            &["scene.toml:6:10", "a perspective one has fov_degrees"],
        ),
        with_solid(
            "fov_of_a_panorama",
            "[camera]\ntype = \"panorama\"\nfov_degrees = 30\n",
            &["scene.toml:7:15", "a panorama shows all directions"],
        ),
        with_solid(
            "aperture_of_a_panorama",
            "[camera]\ntype = \"panorama\"\naperture = 0.5\n",
            &["scene.toml:7:12", "a panorama has no lens"],
        ),
        with_solid(
            "sun_with_direction_and_azimuth",
            "[sun]\ndirection = [0, 0, 1]\nazimuth_degrees = 3\n",
            &["scene.toml:6:13", "direction excludes"],
        ),
        with_solid(
            "material_kind_unknown",
            "[[material]]\nname = \"a\"\nkind = \"glas\"\ncolor = [1, 1, 1]\n",
            &[
                "scene.toml:7:8",
                "\"glas\" is not a value of kind",
                "did you mean \"glass\"?",
                "\"diffuse\"",
            ],
        ),
        with_solid(
            "material_number_of_another_kind",
            "[[material]]\nname = \"a\"\nkind = \"metal\"\ncolor = [1, 1, 1]\nior = 2\n",
            &[
                "scene.toml:9:7",
                "ior is for \"plastic\" and \"glass\": this material is \"metal\"",
            ],
        ),
        with_solid(
            "material_number_of_a_diffuse_one",
            "[[material]]\nname = \"a\"\ncolor = [1, 1, 1]\nroughness = 0.5\n",
            &[
                "scene.toml:8:13",
                "roughness is for \"metal\", \"plastic\" and \"glass\"",
                "this material is \"diffuse\"",
            ],
        ),
        with_solid(
            "material_strength_of_no_light",
            "[[material]]\nname = \"a\"\ncolor = [1, 1, 1]\nstrength = 2\n",
            &["scene.toml:8:12", "strength is for \"light\": this"],
        ),
        with_solid(
            "material_without_color",
            "[[material]]\nname = \"gold\"\nkind = \"metal\"\n",
            &["scene.toml:6:8", "\"gold\" has no color", "from 0 to 1"],
        ),
        with_solid(
            "sphere_light_without_radius",
            "[[sphere_light]]\ncenter = [1, 1, 1]\n",
            &["scene.toml:5:1", "missing field `radius`"],
        ),
        with_solid(
            "turbidity_of_a_constant_sky",
            "[sky]\nturbidity = 3\n",
            &[
                "scene.toml:6:13",
                "turbidity is for the clear sky",
                "model =",
            ],
        ),
        with_solid(
            "color_of_a_clear_sky",
            "[sky]\nmodel = \"clear\"\ncolor = [1, 1, 1]\n",
            &["scene.toml:7:9", "color is for the constant sky"],
        ),
        with_solid(
            "clear_sky_at_night",
            "[sun]\nelevation_degrees = -5\n[sky]\nmodel = \"clear\"\n",
            &[
                "scene.toml:8:9",
                "the sun is below the horizon",
                "from 0 to 90",
            ],
        ),
        with_solid(
            "environment_and_sky",
            "[sky]\n[environment]\nfile = \"x.exr\"\n",
            &["scene.toml:7:8", "[environment] excludes [sky]"],
        ),
        with_solid(
            "environment_without_file",
            "[environment]\nfile = \"x.hdr\"\n",
            &[
                "scene.toml:6:8",
                "x.hdr: the file does not exist",
                "relative to",
            ],
        ),
        with_solid(
            "environment_of_another_format",
            "[environment]\nfile = \"x.png\"\n",
            &[
                "scene.toml:6:8",
                "\"x.png\" is not the name",
                ".hdr",
                ".exr",
            ],
        ),
        with_solid(
            "light_as_a_single_table",
            "[sphere_light]\ncenter = [1, 1, 1]\nradius = 1\n",
            &["scene.toml:5:1", "write [[sphere_light]]"],
        ),
        with_solid(
            "material_unknown",
            "material = \"brak\"\n[[material]]\nname = \"bark\"\ncolor = [1, 1, 1]\n",
            &[
                "scene.toml:5:12",
                "unknown material \"brak\"",
                "did you mean \"bark\"?",
            ],
        ),
        with_solid(
            "material_name_twice",
            "[[material]]\nname = \"a\"\ncolor = [1, 1, 1]\n[[material]]\nname = \"a\"\ncolor = [1, 1, 1]\n",
            &[
                "scene.toml:9:8",
                "the material \"a\" is already defined on line 6",
            ],
        ),
        with_solid(
            "material_name_empty",
            "[[material]]\nname = \"\"\ncolor = [1, 1, 1]\n",
            &["scene.toml:6:8", "the name of a material is empty"],
        ),
    ]
}

impl Case {
    fn preceded_by(mut self, line: &str) -> Self {
        self.scene = [line.as_bytes(), &self.scene].concat().into();
        self
    }
}
