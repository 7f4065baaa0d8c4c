//! The keys of a scene file, as they stand there: types are checked, meaning
//! is not. Where a value may turn out wrong later it keeps its place in the
//! file ([`Spanned`]).

use serde::Deserialize;
use toml::Spanned;

use super::values::{Keys, List, NameOrList, Number, NumberOrList, Whole};

/// Three numbers and their place.
pub(super) type Triple = Spanned<List<Number, 3>>;
/// The names of three columns, each with its place.
pub(super) type ThreeNames = List<Spanned<String>, 3>;

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub background: Option<Triple>,
    pub records: Option<Spanned<String>>,
    pub camera: Option<Keys<CameraKeys>>,
    pub film: Option<Keys<FilmKeys>>,
    pub render: Option<Keys<RenderKeys>>,
    pub sun: Option<Keys<SunKeys>>,
    pub sky: Option<Keys<SkyKeys>>,
    #[serde(default)]
    pub material: Vec<Keys<MaterialKeys>>,
    #[serde(default)]
    pub prototype: Vec<Keys<PrototypeKeys>>,
    #[serde(default)]
    pub cylinder: Vec<Keys<CylinderKeys>>,
    #[serde(default)]
    pub cylinder_table: Vec<Keys<CylinderTableKeys>>,
    #[serde(default)]
    pub swc: Vec<Keys<SwcKeys>>,
    #[serde(default)]
    pub instance: Vec<Keys<InstanceKeys>>,
    #[serde(default)]
    pub instance_table: Vec<Keys<InstanceTableKeys>>,
    #[serde(default)]
    pub scatter: Vec<Keys<ScatterKeys>>,
}

/// What the root and every prototype hold.
#[derive(Clone, Copy)]
pub(super) struct Body<'a> {
    pub name: &'a str,
    pub cylinder: &'a [Keys<CylinderKeys>],
    pub cylinder_table: &'a [Keys<CylinderTableKeys>],
    pub swc: &'a [Keys<SwcKeys>],
    pub instance: &'a [Keys<InstanceKeys>],
    pub instance_table: &'a [Keys<InstanceTableKeys>],
    pub scatter: &'a [Keys<ScatterKeys>],
}

impl Document {
    /// The root and the prototypes, in the order of their numbers.
    pub fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        let root = Body {
            name: "",
            cylinder: &self.cylinder,
            cylinder_table: &self.cylinder_table,
            swc: &self.swc,
            instance: &self.instance,
            instance_table: &self.instance_table,
            scatter: &self.scatter,
        };
        let prototypes = self.prototype.iter().map(|Keys(keys)| Body {
            name: keys.name.get_ref(),
            cylinder: &keys.cylinder,
            cylinder_table: &keys.cylinder_table,
            swc: &keys.swc,
            instance: &keys.instance,
            instance_table: &keys.instance_table,
            scatter: &keys.scatter,
        });
        std::iter::once(root).chain(prototypes)
    }
}

/// `[[prototype]]`. Its lists repeat those of [`Document`] because serde
/// cannot refuse unknown keys in a flattened struct.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PrototypeKeys {
    pub name: Spanned<String>,
    #[serde(default)]
    pub cylinder: Vec<Keys<CylinderKeys>>,
    #[serde(default)]
    pub cylinder_table: Vec<Keys<CylinderTableKeys>>,
    #[serde(default)]
    pub swc: Vec<Keys<SwcKeys>>,
    #[serde(default)]
    pub instance: Vec<Keys<InstanceKeys>>,
    #[serde(default)]
    pub instance_table: Vec<Keys<InstanceTableKeys>>,
    #[serde(default)]
    pub scatter: Vec<Keys<ScatterKeys>>,
}

/// `[camera]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraKeys {
    pub r#type: Option<Spanned<String>>,
    pub frame: Option<Spanned<String>>,
    pub position: Option<Triple>,
    pub look_at: Option<Triple>,
    pub up: Option<Triple>,
    pub fov_degrees: Option<Spanned<Number>>,
    pub height: Option<Spanned<Number>>,
}

/// `[film]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FilmKeys {
    pub width: Option<Spanned<Whole>>,
    pub height: Option<Spanned<Whole>>,
}

/// `[render]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RenderKeys {
    pub integrator: Option<Spanned<String>>,
    pub spp: Option<Spanned<Whole>>,
}

/// `[sun]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SunKeys {
    pub elevation_degrees: Option<Spanned<Number>>,
    pub azimuth_degrees: Option<Spanned<Number>>,
    pub direction: Option<Triple>,
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[sky]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyKeys {
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[[material]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialKeys {
    pub name: Spanned<String>,
    pub kind: Option<Spanned<String>>,
    pub color: Triple,
}

/// `[[cylinder]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderKeys {
    pub p0: Triple,
    pub p1: Triple,
    pub radius: Spanned<Number>,
    pub caps: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}

/// `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderTableKeys {
    pub file: Spanned<String>,
    pub columns: Spanned<Keys<CylinderColumns>>,
    pub degenerate: Option<Spanned<String>>,
    pub caps: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}

/// `columns` of `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderColumns {
    #[serde(alias = "start")]
    pub p0: ThreeNames,
    pub p1: Option<ThreeNames>,
    pub axis: Option<ThreeNames>,
    pub length: Option<Spanned<String>>,
    pub radius: Option<Spanned<String>>,
    pub diameter: Option<Spanned<String>>,
}

/// `[[swc]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SwcKeys {
    pub file: Spanned<String>,
    pub degenerate: Option<Spanned<String>>,
    pub caps: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}

/// `[[instance]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceKeys {
    pub of: Spanned<String>,
    pub scale: Option<Spanned<NumberOrList<3>>>,
    pub rotate: Option<Vec<Keys<RotationKeys>>>,
    pub translate: Option<Triple>,
    pub matrix: Option<Spanned<List<List<Number, 4>, 3>>>,
}

/// One rotation of `rotate`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotationKeys {
    pub axis: Triple,
    pub degrees: Number,
}

/// `[[instance_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceTableKeys {
    pub of: Spanned<String>,
    pub file: Spanned<String>,
    pub columns: Spanned<Keys<InstanceColumns>>,
}

/// `columns` of `[[instance_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceColumns {
    pub position: ThreeNames,
    pub axis: Option<ThreeNames>,
    pub degrees: Option<Spanned<String>>,
    pub quaternion: Option<List<Spanned<String>, 4>>,
    pub scale: Option<Spanned<NameOrList<3>>>,
}

/// `[[scatter]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScatterKeys {
    pub of: Spanned<String>,
    pub pattern: Spanned<String>,
    pub count: Spanned<Whole>,
    pub spacing: Spanned<Number>,
    pub yaw: Option<Spanned<String>>,
    pub scale: Option<Spanned<NumberOrList<2>>>,
    pub seed: Option<Whole>,
}
