//! Neurons in SWC: each line is a sample (`id type x y z radius parent`). Every sample
//! with a parent gives a solid from the parent's point to the sample's own: a cylinder
//! with the sample's radius or, if `joints` is set, a cone or a rounded cone with the
//! radii of both.
//!
//! `samples` reads the lines, `tree` finds the parents, and `soma` finds the balls and
//! cylinders of cell bodies. `measures` has the columns for data colors.

mod measures;
mod samples;
mod soma;
mod tree;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::{Context, SolidFile, SolidFormat};
use crate::scene::contents::ExpectedSolids;
use crate::scene::error::SceneError;
use crate::scene::named_table::{Tables, rows};
use crate::scene::record::{CylinderRecord, Records};
use crate::scene::solid_collector::{
    Degenerate, Look, SKIP_HELP, SolidCollector, is_degenerate, is_degenerate_cone,
};
use crate::scene::source::Source;
use crate::scene::table::input;
use crate::solid::{
    AnySolid, Caps, Cone, ConeError, Cylinder, CylinderError, RoundedCone, SolidKind, Sphere,
    SphereError,
};
use measures::Measure;
use samples::{Sample, SwcFile};
use soma::Somata;

/// `[[swc]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct SwcKeys {
    file: Spanned<String>,
    joints: Option<Spanned<String>>,
    soma: Option<Spanned<String>>,
    degenerate: Option<Spanned<String>>,
    caps: Option<Spanned<String>>,
    material: Option<Spanned<String>>,
}

/// The bytes of a sample while a file is read: its own, and those in the index and the
/// list of parents.
const SAMPLE_BYTES: u64 = 160;

/// The kinds of solids of a neuron.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shape {
    pub joints: Joints,
    pub has_soma: bool,
}

/// The shape of the segments, and so of their joints.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Joints {
    /// Cylinders with the radius of the segment's own sample.
    Steps,
    /// Cones, which end flat.
    Flat,
    /// Rounded cones, which end in balls.
    Round,
}

impl Shape {
    /// Reads the shape of an `[[swc]]`.
    pub fn new(source: &Source, keys: &SwcKeys) -> Result<Self, SceneError> {
        const JOINTS: [(&str, Joints); 2] = [("flat", Joints::Flat), ("round", Joints::Round)];
        const SOMATA: [(&str, bool); 2] = [("standard", true), ("none", false)];
        let joints = match &keys.joints {
            Some(word) => source.choose("joints", word, &JOINTS)?,
            None => Joints::Steps,
        };
        if let (Some(caps), Joints::Round) = (&keys.caps, joints) {
            return Err(source.error(
                caps.span(),
                "caps apply only to flat ends: with joints = \"round\" segments end in balls",
            ));
        }
        let soma = keys.soma.as_ref();
        let soma = soma.map(|word| source.choose("soma", word, &SOMATA));
        Ok(Self {
            joints,
            has_soma: soma.transpose()?.unwrap_or(true),
        })
    }
}

/// Why a segment is not a valid solid.
struct Fault {
    message: String,
    is_of_radius: bool,
    is_degenerate: bool,
}

impl Joints {
    /// The kind of the segments.
    pub fn kind(self) -> SolidKind {
        match self {
            Self::Steps => SolidKind::Cylinder,
            Self::Flat => SolidKind::Cone,
            Self::Round => SolidKind::RoundedCone,
        }
    }

    /// The segment between a sample and its parent.
    fn segment(self, parent: &Sample, sample: &Sample, look: Look) -> Result<AnySolid, Fault> {
        let (p0, p1) = (parent.point, sample.point);
        let (radius0, radius1) = (parent.radius, sample.radius);
        match self {
            Self::Steps => Cylinder::new(p0, p1, radius1, look.caps)
                .map(AnySolid::from)
                .map_err(Fault::of_cylinder),
            Self::Flat => Cone::new(p0, p1, radius0, radius1, look.caps)
                .map(AnySolid::from)
                .map_err(Fault::of_cone),
            Self::Round => RoundedCone::new(p0, p1, radius0, radius1)
                .map(AnySolid::from)
                .map_err(|error| Fault::of_cone(error.0)),
        }
    }
}

impl Fault {
    fn of_cylinder(error: CylinderError) -> Self {
        Self {
            message: error.to_string(),
            is_of_radius: matches!(error, CylinderError::Radius { .. }),
            is_degenerate: is_degenerate(&error),
        }
    }

    fn of_sphere(error: SphereError) -> Self {
        Self {
            message: error.to_string(),
            is_of_radius: matches!(error, SphereError::Radius { .. }),
            is_degenerate: matches!(error, SphereError::Radius { radius } if (0.0..Cylinder::LEAST).contains(&radius)),
        }
    }

    fn of_cone(error: ConeError) -> Self {
        Self {
            message: error.to_string(),
            is_of_radius: matches!(error, ConeError::Radius { .. } | ConeError::NoRadius),
            is_degenerate: is_degenerate_cone(&error),
        }
    }
}

/// The part of a neuron that a sample gives.
enum Part {
    /// A solid, or why it is invalid.
    Solid(Result<AnySolid, Fault>),
    /// Nothing; the number of the segment stays unused.
    Free,
}

impl SolidFormat for SwcKeys {
    const WHAT: &'static str = "a neuron in SWC";
    const EXTENSIONS: &'static [&'static str] = &["swc"];
}

impl SolidFile for SwcKeys {
    fn file(&self) -> &Spanned<String> {
        &self.file
    }

    fn count(&self, source: &Source, records: Records, solids: &mut ExpectedSolids) {
        let Ok(shape) = Shape::new(source, self) else {
            return;
        };
        solids.add(shape.joints.kind(), rows(source, &self.file), records);
        if shape.has_soma {
            let path = source.resolve(self.file.get_ref());
            solids.add(SolidKind::Sphere, most_balls(&path), records);
        }
    }

    fn material(&self) -> Option<&Spanned<String>> {
        self.material.as_ref()
    }

    /// The bytes of all samples, which are read before the first solid is made.
    fn reading_bytes(&self, source: &Source) -> u64 {
        rows(source, &self.file).saturating_mul(SAMPLE_BYTES)
    }

    /// Adds the segments in the order of their samples, then the balls of somata.
    fn add(&self, context: &Context, solids: &mut SolidCollector) -> Result<(), SceneError> {
        let source = context.source;
        let look = context.look(self.caps.as_ref(), self.material.as_ref())?;
        let degenerate = context.degenerate(self.degenerate.as_ref())?;
        let shape = Shape::new(source, self)?;
        let path = source.resolve(self.file.get_ref());
        let file = SwcFile { path: &path };
        let neuron = input::open(&path)
            .and_then(|input| Neuron::read(&file, input, context.tables))
            .map_err(|error| source.unreadable(&self.file, error))?;
        let shown = context.known_column(look.material, &Measure::NAMES, solids);
        let values = shown.map(|(_, measure)| neuron.measures(measure));
        neuron.parts(shape, look, |place, part| {
            let sample = &neuron.samples[place];
            match part {
                Part::Solid(Ok(solid)) => solids.push_any(&solid, look.material),
                Part::Solid(Err(fault))
                    if fault.is_degenerate && degenerate == Degenerate::Skip =>
                {
                    solids.skip()
                }
                Part::Solid(Err(fault)) => {
                    let column = fault.is_of_radius.then_some("radius");
                    let help = fault.is_degenerate.then_some(SKIP_HELP);
                    return Err(file.error(sample.line, column, fault.message, help));
                }
                Part::Free => solids.leave_free(),
            }
            .map_err(|refusal| {
                refusal.in_row(source, &self.file, |message, help| {
                    file.error(sample.line, None, message, help)
                })
            })?;
            if let Some(values) = &values {
                solids.value(look.material, values[place]);
            }
            Ok(())
        })
    }
}

/// Reads the samples of a neuron in SWC and checks that they form trees, as loading a
/// scene does. Errors name the file `path`.
///
/// # Errors
/// If the text is not SWC, or exceeds a limit.
pub fn check_swc(input: impl Read, path: &Path) -> Result<(), SceneError> {
    let file = SwcFile { path };
    let (samples, _) = file.samples(input, |_| Ok(()))?;
    file.parents(&samples)
        .map(|parents| drop(Somata::of(&samples, &parents)))
}

/// An upper bound of the balls of a file's somata: one for each sample of a soma. 0 if the
/// file cannot be read, or only once, such as a pipe.
fn most_balls(path: &Path) -> u64 {
    if !path.is_file() {
        return 0;
    }
    input::open(path).map_or(0, |input| SwcFile { path }.soma_samples(input))
}

/// The samples of a file and their parents.
struct Neuron {
    samples: Vec<Sample>,
    parents: Vec<Option<usize>>,
}

impl Neuron {
    fn read(file: &SwcFile, input: File, tables: &Tables) -> Result<Self, SceneError> {
        let is_pipe = !file.path.is_file();
        let (samples, has_more_cells) = file.samples(input, |line| {
            let bytes = SAMPLE_BYTES + 2 * size_of::<CylinderRecord>() as u64;
            match !is_pipe || tables.take(bytes) {
                true => Ok(()),
                false => Err(tables.refused(file.path, line)),
            }
        })?;
        if has_more_cells {
            let path = file.path.display();
            tables.note(format!("{path}: cells after the seventh are ignored"));
        }
        let parents = file.parents(&samples)?;
        Ok(Self { samples, parents })
    }

    /// Calls `add` with the parts of the neuron and the positions of their samples, in the order
    /// of their numbers.
    fn parts(
        &self,
        shape: Shape,
        look: Look,
        mut add: impl FnMut(usize, Part) -> Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        let somata = match shape.has_soma {
            true => Somata::of(&self.samples, &self.parents),
            false => Somata::default(),
        };
        for (place, (sample, parent)) in self.samples.iter().zip(&self.parents).enumerate() {
            let Some(parent) = *parent else {
                continue;
            };
            let part = match somata.cylinder_at(place) {
                Some(cylinder) if cylinder.ends[0] == place => {
                    let [p0, p1] = cylinder.ends.map(|end| self.samples[end].point);
                    let radius = self.samples[cylinder.center].radius;
                    let caps = match shape.joints {
                        Joints::Round => Caps::Both,
                        Joints::Steps | Joints::Flat => look.caps,
                    };
                    let cylinder = Cylinder::new(p0, p1, radius, caps);
                    Part::Solid(cylinder.map(AnySolid::from).map_err(Fault::of_cylinder))
                }
                Some(_) => Part::Free,
                None => Part::Solid(shape.joints.segment(&self.samples[parent], sample, look)),
            };
            add(place, part)?;
        }
        for &place in &somata.balls {
            let sample = &self.samples[place];
            let ball = Sphere::new(sample.point, sample.radius);
            add(
                place,
                Part::Solid(ball.map(AnySolid::from).map_err(Fault::of_sphere)),
            )?;
        }
        Ok(())
    }
}
