//! The keys of a scene file, as written: their types are checked, their meaning
//! is not. Values that are validated later keep their place in the file
//! ([`Spanned`]).

use serde::Deserialize;
use toml::Spanned;

use super::background::BackgroundKey;
use super::clip_keys::ClipKeys;
use super::colors::ValueKeys;
use super::defaults;
use super::description::Integrator;
use super::formats::{
    BeamLatticeKeys, CylinderTableKeys, SolidFile, SwcKeys, for_each_solid_format,
};
use super::illustration_keys::{AxesKeys, DepthCueKeys, OutlinesKeys, ScaleBarKeys};
use super::legend_keys::LegendKeys;
use super::materials::MaterialKeys;
use super::set_operations::{CompositionKeys, Operation};
use super::solid_keys::RotationKeys;
use super::solids::SceneSolid;
use super::table::ColumnKey;
use super::values::{ColumnOrList, Keys, List, Number, NumberOrList, ThreeColumns, Triple, Whole};
use crate::for_each_solid;
use crate::solid::SolidKind;

/// Declares the tables that contain solids and placements, and [`Body`], which borrows
/// their lists. Each table repeats the lists after its own keys, because serde cannot
/// reject unknown keys in a flattened struct.
macro_rules! containers {
    (
        [$($others:tt)*], $($(#[$meta:meta])* $name:ident $keys:tt)*;
        $({ $type:ident $solid:ident $($rest:tt)* })*
    ) => {
        containers! {
            @ [$($solid: <crate::solid::$type as SceneSolid>::Keys,)* $($others)*]
            $($(#[$meta])* $name $keys)*
        }
    };
    (@ $lists:tt $($(#[$meta:meta])* $name:ident $keys:tt)*) => {
        $(container!($lists $(#[$meta])* $name $keys);)*
        body!($lists);
    };
}

macro_rules! container {
    ([$($list:ident: $entry:ty,)*]
     $(#[$meta:meta])* $name:ident {
        $($(#[$attribute:meta])* pub $key:ident: $kind:ty,)*
     }) => {
        $(#[$meta])*
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $name {
            $($(#[$attribute])* pub $key: $kind,)*
            $(#[serde(default)] $list: Vec<Keys<$entry>>,)*
        }

        impl $name {
            /// Its lists, under a name.
            fn body<'a>(&'a self, name: &'a str) -> Body<'a> {
                Body { name, $($list: &self.$list,)* }
            }
        }
    };
}

macro_rules! body {
    ([$($list:ident: $entry:ty,)*]) => {
        /// The lists of the root or a prototype.
        #[derive(Clone, Copy)]
        pub(super) struct Body<'a> {
            pub name: &'a str,
            $(pub $list: &'a [Keys<$entry>],)*
        }
    };
}

/// Adds the lists of files to those of `containers`.
macro_rules! with_files {
    ([$($others:tt)*] [$($structs:tt)*] $({ $keys:ident $name:ident })*) => {
        for_each_solid! { containers [$($name: $keys,)* $($others)*], $($structs)*; }

        impl<'a> Body<'a> {
            /// The files of solids, in the order of the primitive numbers.
            pub fn files(self) -> impl Iterator<Item = &'a dyn SolidFile> {
                std::iter::empty()
                    $(.chain(self.$name.iter().map(|Keys(keys)| keys as &dyn SolidFile)))*
            }
        }
    };
}

for_each_solid_format! {
    with_files
    [
        union: CompositionKeys,
        intersection: CompositionKeys,
        difference: CompositionKeys,
        instance: InstanceKeys,
        instance_table: InstanceTableKeys,
        scatter: ScatterKeys,
    ]
    [

    /// The whole file.
    Document {
        pub background: Option<Spanned<BackgroundKey>>,
        pub records: Option<Spanned<String>>,
        pub camera: Option<Keys<CameraKeys>>,
        pub film: Option<Keys<FilmKeys>>,
        pub render: Option<Keys<RenderKeys>>,
        pub sun: Option<Keys<SunKeys>>,
        pub sky: Option<Keys<SkyKeys>>,
        pub legend: Option<Keys<LegendKeys>>,
        pub scale_bar: Option<Spanned<Keys<ScaleBarKeys>>>,
        pub axes: Option<Keys<AxesKeys>>,
        pub outlines: Option<Keys<OutlinesKeys>>,
        pub depth_cue: Option<Keys<DepthCueKeys>>,
        pub environment: Option<Keys<EnvironmentKeys>>,
        #[serde(default)]
        pub clip: Vec<Keys<ClipKeys>>,
        #[serde(default)]
        pub point_light: Vec<Keys<PointLightKeys>>,
        #[serde(default)]
        pub sphere_light: Vec<Keys<SphereLightKeys>>,
        #[serde(default)]
        pub rectangle_light: Vec<Keys<RectangleLightKeys>>,
        #[serde(default)]
        pub material: Vec<Keys<MaterialKeys>>,
        #[serde(default)]
        pub prototype: Vec<Keys<PrototypeKeys>>,
    }

    /// `[[prototype]]`
    PrototypeKeys {
        pub name: Spanned<String>,
    }
    ]
}

impl Document {
    /// The root and the prototypes, in the order of their numbers.
    pub fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        let prototypes = self.prototype.iter();
        let prototypes = prototypes.map(|Keys(keys)| keys.body(keys.name.get_ref()));
        std::iter::once(self.body("")).chain(prototypes)
    }

    /// The integrator of a file that states none: paths, if other integrators would not show
    /// a material or a light of the file.
    pub fn default_integrator(&self) -> Integrator {
        let is_diffuse = |Keys(keys): &Keys<MaterialKeys>| keys.is_diffuse();
        let is_plain = self.material.iter().all(is_diffuse)
            && self.point_light.is_empty()
            && self.sphere_light.is_empty()
            && self.rectangle_light.is_empty()
            && self.environment.is_none()
            && self
                .sky
                .as_ref()
                .is_none_or(|Keys(sky)| sky.model.is_none());
        match is_plain {
            true => defaults::RENDER.integrator,
            false => Integrator::Path,
        }
    }
}

macro_rules! body_solids {
    ($({ $type:ident $name:ident $($rest:tt)* })*) => {
        impl Body<'_> {
            /// The number of tables of each kind of solid.
            pub fn solids(&self) -> impl Iterator<Item = (SolidKind, usize)> {
                [$((SolidKind::$type, self.$name.len())),*].into_iter()
            }
        }
    };
}

for_each_solid!(body_solids);

impl<'a> Body<'a> {
    /// The tables of set operations, in the order of their numbers.
    pub fn operations(&self) -> [(Operation, &'a [Keys<CompositionKeys>]); 3] {
        [
            (Operation::Union, self.union),
            (Operation::Intersection, self.intersection),
            (Operation::Difference, self.difference),
        ]
    }
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
    pub aperture: Option<Spanned<Number>>,
    pub focus: Option<Spanned<Number>>,
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
    pub sampler: Option<Spanned<String>>,
    pub max_depth: Option<Spanned<Whole>>,
    pub ao_distance: Option<Spanned<Number>>,
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
    pub angle_degrees: Option<Spanned<Number>>,
}

/// `[sky]`
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyKeys {
    pub model: Option<Spanned<String>>,
    pub turbidity: Option<Spanned<Number>>,
    pub ground: Option<Triple>,
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[environment]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentKeys {
    pub file: Spanned<String>,
    pub strength: Option<Spanned<Number>>,
    pub rotate_degrees: Option<Number>,
}

/// `[[point_light]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointLightKeys {
    pub position: Triple,
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[[sphere_light]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereLightKeys {
    pub center: Triple,
    pub radius: Spanned<Number>,
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[[rectangle_light]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RectangleLightKeys {
    pub corner: Triple,
    pub edges: Spanned<List<Triple, 2>>,
    pub color: Option<Triple>,
    pub strength: Option<Spanned<Number>>,
}

/// `[[instance]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceKeys {
    pub of: Spanned<String>,
    pub scale: Option<Spanned<NumberOrList<3>>>,
    pub rotate_x: Option<Number>,
    pub rotate_y: Option<Number>,
    pub rotate_z: Option<Number>,
    pub rotate: Option<Vec<Keys<RotationKeys>>>,
    pub translate: Option<Triple>,
    pub values: Option<Spanned<ValueKeys>>,
    pub matrix: Option<Spanned<List<List<Number, 4>, 3>>>,
}

/// `[[instance_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceTableKeys {
    pub of: Spanned<String>,
    pub file: Spanned<String>,
    pub columns: Spanned<Keys<InstanceColumns>>,
    pub delimiter: Option<Spanned<String>>,
    pub decimal: Option<Spanned<String>>,
}

/// `columns` of `[[instance_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceColumns {
    pub position: Option<ThreeColumns>,
    pub axis: Option<ThreeColumns>,
    pub degrees: Option<Spanned<ColumnKey>>,
    pub quaternion: Option<List<Spanned<ColumnKey>, 4>>,
    pub scale: Option<Spanned<ColumnOrList<3>>>,
    pub matrix: Option<List<List<Spanned<ColumnKey>, 4>, 3>>,
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
