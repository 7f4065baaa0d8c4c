//! Solids of other kinds than cylinders, and poses, that are wrong.

use super::Case;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            "sphere_of_no_radius",
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 0\n",
            &["scene.toml:3:10", "radius is 0.0", "3 | radius = 0"],
        ),
        Case::new(
            "sphere_beyond_all_numbers",
            "[[sphere]]\nradius = 1\ncenter = [0, 1e50, 0]\n",
            &["scene.toml:3:10", "the center is (0.0, 1e50, 0.0)"],
        ),
        Case::new(
            "sphere_without_a_center",
            "[[sphere]]\nradius = 1\n",
            &["scene.toml:1:1", "missing field `center`"],
        ),
        Case::new(
            "sphere_stated_as_one_table",
            "[sphere]\ncenter = [0, 0, 0]\nradius = 1\n",
            &["scene.toml:1:1", "write [[sphere]]"],
        ),
        Case::new(
            "cuboid_without_a_width",
            "[[cuboid]]\nhalf_widths = [1, 2, -3]\n",
            &["scene.toml:2:15", "the half width along z is -3.0"],
        ),
        Case::new(
            "cuboid_of_two_widths",
            "[[cuboid]]\nhalf_widths = [1, 2]\n",
            &[
                "scene.toml:2:15",
                "invalid length 2, expected an array of length 3",
            ],
        ),
        Case::new(
            "cuboid_with_whole_widths",
            "[[cuboid]]\nwidths = [1, 2, 3]\n",
            &[
                "scene.toml:2:1",
                "unknown key \"widths\"",
                "\"half_widths\"",
                "\"rotate_x\"",
            ],
        ),
        Case::new(
            "cone_of_no_radius",
            "[[cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius1 = 0\nradius0 = 0\n",
            &["scene.toml:5:11", "radius0 and radius1 are both zero"],
        ),
        Case::new(
            "cone_of_a_negative_radius",
            "[[cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius0 = 1\nradius1 = -2\n",
            &["scene.toml:5:11", "radius1 is -2.0"],
        ),
        Case::new(
            "cone_of_no_length",
            "[[cone]]\np0 = [0, 0, 1]\nradius0 = 1\nradius1 = 2\np1 = [0, 0, 1]\n",
            &["scene.toml:5:6", "p0 and p1 are 0.0 apart"],
        ),
        Case::new(
            "cone_with_caps_of_another_name",
            "[[cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius0 = 1\nradius1 = 2\ncaps = \"flat\"\n",
            &["scene.toml:6:8", "\"flat\" is not a value of caps"],
        ),
        Case::new(
            "rounded_cone_with_caps",
            "[[rounded_cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius0 = 1\nradius1 = 2\ncaps = \"both\"\n",
            &["scene.toml:6:1", "unknown key \"caps\""],
        ),
        Case::new(
            "rounded_cone_beyond_all_numbers",
            "[[rounded_cone]]\np0 = [0, 0, 0]\nradius0 = 1\nradius1 = 2\np1 = [1e60, 0, 1]\n",
            &["scene.toml:5:6", "p1 is (1e60, 0.0, 1.0)"],
        ),
        Case::new(
            "disk_without_a_normal",
            "[[disk]]\ncenter = [0, 0, 0]\nradius = 1\nnormal = [0, 0, 0]\n",
            &["scene.toml:4:10", "the normal is (0.0, 0.0, 0.0)"],
        ),
        Case::new(
            "disk_of_a_negative_radius",
            "[[disk]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = -1\n",
            &["scene.toml:4:10", "radius is -1.0"],
        ),
        Case::new(
            "pose_about_no_axis",
            "[[cuboid]]\nhalf_widths = [1, 2, 3]\nrotate = [{ axis = [0, 0, 0], degrees = 9 }]\n",
            &["scene.toml:3:20", "the rotation axis is zero"],
        ),
        Case::new(
            "pose_by_nan_degrees",
            "[[cuboid]]\nhalf_widths = [1, 2, 3]\nrotate_y = nan\n",
            &["scene.toml:3:12", "the number is NaN: it must be finite"],
        ),
        Case::new(
            "pose_beyond_all_numbers",
            "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\ntranslate = [0, 0, 1e60]\n",
            &[
                "scene.toml:5:13",
                "after the solid is rotated and translated, p0 is (0.0, 0.0, 1e60)",
            ],
        ),
        Case::new(
            "pose_that_loses_the_length",
            "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\ntranslate = [0, 0, 1e30]\n",
            &[
                "scene.toml:5:13",
                "after the solid is rotated and translated, p0 and p1 are 0.0 apart",
            ],
        ),
        Case::new(
            "pose_of_a_misspelt_key",
            "[[cuboid]]\nhalf_widths = [1, 2, 3]\nrotatez = 3\n",
            &[
                "scene.toml:3:1",
                "unknown key \"rotatez\"",
                "did you mean \"rotate_z\"?",
            ],
        ),
        Case::new(
            "matrix_beside_rotate_x",
            "[[prototype]]\nname = \"a\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
             [[instance]]\nof = \"a\"\nrotate_x = 5\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n",
            &["scene.toml:9:10", "matrix excludes", "rotate_x"],
        ),
        Case::new(
            "material_of_a_sphere_that_is_not_there",
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"bark\"\n",
            &["scene.toml:4:12", "unknown material \"bark\""],
        ),
        Case::new(
            "neuron_of_unknown_joints",
            "[[swc]]\nfile = \"neuron.swc\"\njoints = \"ball\"\n",
            &[
                "scene.toml:3:10",
                "\"ball\" is not a value of joints",
                "\"round\"",
            ],
        )
        .with("neuron.swc", "1 1 0 0 0 1 -1\n"),
        Case::new(
            "neuron_of_round_joints_and_caps",
            "[[swc]]\nfile = \"neuron.swc\"\njoints = \"round\"\ncaps = \"both\"\n",
            &["scene.toml:4:8", "caps apply only to flat ends"],
        )
        .with("neuron.swc", "1 1 0 0 0 1 -1\n"),
        Case::new(
            "neuron_with_a_negative_radius_at_the_parent",
            "[[swc]]\nfile = \"neuron.swc\"\njoints = \"flat\"\ndegenerate = \"skip\"\n",
            &["neuron.swc:2: column \"radius\"", "radius0 is -1.0"],
        )
        .with("neuron.swc", "1 1 0 0 0 -1 -1\n2 1 0 0 1 1 1\n"),
        Case::new(
            "neuron_with_a_cone_of_no_length",
            "[[swc]]\nfile = \"neuron.swc\"\njoints = \"flat\"\n",
            &["neuron.swc:2", "0.0 apart", "degenerate = \"skip\""],
        )
        .with("neuron.swc", "1 1 0 0 0 1 -1\n2 1 0 0 0 1 1\n"),
    ]
}
