//! The validated description of a scene: everything that `tracer` and `render` need,
//! independent of the files it came from.

use super::background::Background;
use super::clip::Clip;
use super::colors::{PlacementValues, ValueList};
use super::environment::Environment;
use super::illustration::Illustration;
use super::legend::Legend;
use super::light::{ClearSky, Light, Sky, Sun};
use super::material::{Color, Material};
use super::origins::Origins;
use super::record::Records;
use super::solid_lists::Solids;
use crate::solid::AnySolid;
use glam::{DAffine3, DVec3};

/// A whole scene. Loading validates its content.
#[derive(Clone, Debug)]
pub struct Scene {
    /// All prototypes; the first is the root, the scene itself. Prototypes
    /// refer to each other by index and never in a cycle.
    pub prototypes: Vec<Prototype>,
    /// All materials; the first is the default one.
    pub materials: Vec<Material>,
    /// The camera of `render`.
    pub camera: Camera,
    /// The picture's size.
    pub film: Film,
    /// What `render` computes unless the command line says otherwise.
    pub render: RenderSettings,
    /// The sun, if any.
    pub sun: Option<Sun>,
    /// The sky, if any.
    pub sky: Option<Sky>,
    /// The clear sky, if any; a scene with one has no other sky.
    pub clear_sky: Option<ClearSky>,
    /// The light from infinitely far away as a picture, if any; a scene with one has no sky.
    pub environment: Option<Environment>,
    /// The lights with a place, which integrator `path` sees.
    pub lights: Vec<Light>,
    /// The planes that cut the picture open. What all of them leave is visible.
    pub clips: Vec<Clip>,
    /// The legend over the picture, if any.
    pub legend: Option<Legend>,
    /// Scale bar, axes, outlines and depth cue, if any.
    pub illustration: Illustration,
    /// What camera rays see that miss.
    pub background: Background,
    /// The number of table rows skipped because of `degenerate = "skip"`.
    pub skipped_rows: u64,
    /// Notes on the files for the user, such as ignored columns.
    pub notes: Vec<String>,
}

impl Scene {
    /// The precision of cylinders: f32 if the cylinders of any prototype are in f32.
    #[must_use]
    pub fn records(&self) -> Records {
        let is_rounded =
            |prototype: &Prototype| prototype.solids.cylinders.records() == Records::F32;
        match self.prototypes.iter().any(is_rounded) {
            true => Records::F32,
            false => Records::F64,
        }
    }

    /// The bytes of the images on surfaces.
    #[must_use]
    pub fn images_bytes(&self) -> usize {
        let bytes = self.materials.iter().map(|material| match &material.color {
            Color::Image(image) => image.bytes(),
            Color::Constant(_) | Color::Checker(_) | Color::Stripes(_) | Color::Data(_) => 0,
        });
        bytes.sum()
    }

    /// The greatest difference of a stored number from the stated one.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let lists = self.prototypes.iter();
        let roundings = lists.map(|prototype| prototype.solids.cylinders.rounding());
        roundings.fold(0.0, f64::max)
    }
}

/// The position of a prototype in [`Scene::prototypes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrototypeIndex(pub u32);

impl PrototypeIndex {
    /// The scene itself.
    pub const ROOT: Self = Self(0);
}

/// A named list of solids and of placements of other prototypes.
#[derive(Clone, Debug, Default)]
pub struct Prototype {
    /// The name in the scene file; empty for the root.
    pub name: String,
    /// The solids.
    pub solids: Solids,
    /// The placements, in the order of their instance numbers.
    pub placements: Vec<Placement>,
    /// The values of solids whose material has a data color, by primitive number.
    pub solid_values: ValueList,
    /// The values of placements for data colors, by column.
    pub placement_values: Vec<PlacementValues>,
    /// The source files of the solids.
    pub solid_origins: Origins,
    /// The source files of the placements.
    pub placement_origins: Origins,
}

impl Prototype {
    /// As [`Solids::simple`].
    pub fn singles(&self) -> impl Iterator<Item = (u32, AnySolid)> {
        self.solids.simple()
    }

    /// The bytes of the values for data colors.
    #[must_use]
    pub fn values_bytes(&self) -> usize {
        let placements = self.placement_values.iter();
        let placements = placements.map(|column| column.values.bytes());
        self.solid_values.bytes() + placements.sum::<usize>()
    }

    /// As [`Solids::find_simple`].
    #[must_use]
    pub fn single(&self, primitive: u32) -> Option<AnySolid> {
        self.solids.find_simple(primitive)
    }
}

/// Another prototype placed in this one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The placed prototype.
    pub of: PrototypeIndex,
    /// Maps points of the placed prototype to points of the one that contains the
    /// placement: `L x + translation`, with finite entries and `L` invertible.
    pub parent_from_child: DAffine3,
}

/// The camera: projection and viewpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The kind of projection.
    pub projection: Projection,
    /// The viewpoint.
    pub frame: Frame,
    /// The lens; `None` shows everything sharp. A panorama has none.
    pub lens: Option<Lens>,
}

/// A thin lens, which shows points in front of and behind one plane as disks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// The diameter in scene units, greater than 0.
    pub aperture: f64,
    /// The distance of the sharp plane along the view, in scene units and greater than 0. `None`
    /// is the distance of the point that the camera looks at, or of the center of the scene's
    /// box if the frame is automatic.
    pub focus: Option<f64>,
}

/// How points are projected onto the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through a point.
    Perspective {
        /// The vertical angle of view, in degrees, between 0 and 180.
        fov_degrees: f64,
    },
    /// Along parallel lines.
    Orthographic {
        /// Scene units across the picture's height; `None` fits the scene.
        height: Option<f64>,
    },
    /// All directions, as on a map: longitude across and latitude upward.
    Panorama,
}

/// The viewpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Chosen so that the whole scene is in the picture; for a panorama, the center of the
    /// scene's box.
    Auto,
    /// Stated by the user.
    LookAt {
        /// The eye.
        position: DVec3,
        /// The point at the center of the picture, other than `position`.
        look_at: DVec3,
        /// The upward direction in the picture, not parallel to the view.
        up: DVec3,
    },
}

/// The size of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Pixels across, at least 1.
    pub width: u32,
    /// Pixels down, at least 1.
    pub height: u32,
}

/// What `render` computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// The meaning of a pixel.
    pub integrator: Integrator,
    /// Samples a pixel, at least 1.
    pub spp: u32,
    /// How samples are spread.
    pub sampler: Sampler,
    /// The most rays of a path of integrator `path`, at least 1: with 1, only lights are seen.
    pub max_depth: u32,
    /// The distance beyond which surfaces do not occlude under integrator `ao`, greater than 0.
    pub ao_distance: f64,
}

/// How the samples of a pixel are spread over it and over directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sampler {
    /// Evenly, along a scrambled sequence of Sobol'.
    Sobol,
    /// By independent uniform numbers: noise that falls as the root of their number.
    Random,
}

impl Sampler {
    /// All samplers.
    pub const ALL: [Self; 2] = [Self::Sobol, Self::Random];

    /// The name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::Random => "random",
        }
    }
}

/// The quantity that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Integrator {
    /// The world normal as a color.
    Normal,
    /// Ambient occlusion.
    Ao,
    /// Sun and sky with shadows.
    Sun,
    /// Light that is scattered any number of times.
    Path,
}

impl Integrator {
    /// All integrators.
    pub const ALL: [Self; 4] = [Self::Sun, Self::Normal, Self::Ao, Self::Path];

    /// The name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Normal => "normal",
            Self::Ao => "ao",
            Self::Path => "path",
        }
    }
}
