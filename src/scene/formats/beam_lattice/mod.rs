//! Beam lattices in 3MF: `archive` unpacks the file, `package` finds the model, `model`
//! reads the objects that it builds, `lattice` the beams and balls of one, `element` reads
//! XML, `limits` rejects texts that would take too long, `notes` collects notes for the
//! user, `counted` counts the solids in advance. This file makes the solids.
//!
//! **Beams.** The specification (3MF Beam Lattice Extension, 2.1.1) defines a beam as the
//! union of a frustum and a cap at either end: nothing for `butt`, the ball of the end's
//! radius for `sphere`, the outer half of that ball for `hemisphere`. A lattice is the
//! union of its beams and balls. So a frustum becomes a [`Cylinder`] or, if its radii
//! differ, a [`Cone`], and each vertex gets one [`Sphere`]: the largest of its balls, which
//! contains the others. (A rounded cone is another solid: its side is tangent to its balls,
//! while a beam's passes through the circles at its vertices.)
//!
//! **Half balls.** If the other half is inside the frustum, the whole ball gives the same
//! union. It is inside where the radius of the frustum is nowhere less than the end's: at
//! the end that is not thicker than the other, if the beam is at least as long as that
//! radius. Otherwise the half ball is the intersection of the ball with a cylinder that
//! begins at the end and is wider and higher than the half. It is omitted if the ball at
//! the vertex contains it.

#[cfg_attr(not(feature = "three-mf"), path = "no_archive.rs")]
mod archive;
mod counted;
mod element;
mod lattice;
mod limits;
mod model;
mod notes;
mod package;
mod part;

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use self::counted::count;
use self::element::{Element, Similarity};
use self::lattice::{Beam, End, Lattice};
use self::model::{Model, UNITS};
use self::part::{Part, parsed};
use super::{Context, SolidFile, SolidFormat};
use crate::scene::colors::DataColor;
use crate::scene::contents::ExpectedSolids;
use crate::scene::error::SceneError;
use crate::scene::record::{MaterialIndex, Records};
use crate::scene::solid_collector::{
    Degenerate, Refusal, SKIP_HELP, SolidCollector, is_degenerate, is_degenerate_cone,
};
use crate::scene::source::Source;
use crate::solid::{AnySolid, Caps, Composition, Cone, Cylinder, Sphere};

/// `[[beam_lattice]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct BeamLatticeKeys {
    file: Spanned<String>,
    unit: Option<Spanned<String>>,
    meshes: Option<Spanned<String>>,
    degenerate: Option<Spanned<String>>,
    material: Option<Spanned<String>>,
}

/// The settings for reading a file.
struct BeamLattice {
    /// The unit of the scene, in micrometers; the file's unit by default.
    unit: Option<f64>,
    /// Whether meshes are ignored; otherwise they are an error.
    skips_meshes: bool,
    material: MaterialIndex,
    degenerate: Degenerate,
}

impl SolidFormat for BeamLatticeKeys {
    const WHAT: &'static str = "a model in 3MF";
    const EXTENSIONS: &'static [&'static str] = &["3mf"];
}

impl SolidFile for BeamLatticeKeys {
    fn file(&self) -> &Spanned<String> {
        &self.file
    }

    fn count(&self, source: &Source, records: Records, solids: &mut ExpectedSolids) {
        // Loading reports the errors, and adds no solids then.
        let _ = count(source, &self.file, records, solids);
    }

    fn material(&self) -> Option<&Spanned<String>> {
        self.material.as_ref()
    }

    fn add(&self, context: &Context, solids: &mut SolidCollector) -> Result<(), SceneError> {
        let (source, file) = (context.source, &self.file);
        let keys = self.stated(context)?;
        let part = package::model_part(source, file)?;
        let document = parsed(&part)?;
        let root = Element::root(&part.path, &document);
        let model = Model::new(&root, keys.skips_meshes)?;
        for note in &model.notes {
            solids.note(note);
        }
        let shows_radius = context
            .known_column(keys.material, &[("radius", ())], solids)
            .is_some();
        let units = keys
            .unit
            .map_or((1.0, 1.0), |unit| lowest(model.unit, unit));
        for placed in &model.placed {
            for place in &placed.places {
                let mut lowering = Lowering {
                    source,
                    file,
                    root,
                    place,
                    units,
                    keys: &keys,
                    shows_radius,
                    solids: &mut *solids,
                };
                lowering.add(&placed.lattice)?;
            }
        }
        Ok(())
    }
}

impl BeamLatticeKeys {
    fn stated(&self, context: &Context) -> Result<BeamLattice, SceneError> {
        const MESHES: [(&str, bool); 2] = [("error", false), ("skip", true)];
        let (source, unit, meshes) = (context.source, self.unit.as_ref(), self.meshes.as_ref());
        let unit = unit.map(|word| source.choose("unit", word, &UNITS));
        let meshes = meshes.map(|word| source.choose("meshes", word, &MESHES));
        Ok(BeamLattice {
            unit: unit.transpose()?,
            skips_meshes: meshes.transpose()?.unwrap_or(false),
            material: context.material(self.material.as_ref())?,
            degenerate: context.degenerate(self.degenerate.as_ref())?,
        })
    }
}

/// The number of beams in the model part of a 3MF file, given its text without the archive.
///
/// # Errors
/// The same as [`scene::load`](crate::scene::load()) for such a file.
pub fn beams_of_model(text: &str) -> Result<u64, SceneError> {
    let part = Part {
        path: "model".into(),
        text: text.to_owned(),
    };
    let document = parsed(&part)?;
    let model = Model::new(&Element::root(&part.path, &document), true)?;
    let beams = model.placed.iter();
    let beams = beams.map(|placed| (placed.lattice.beams.len() * placed.places.len()) as u64);
    Ok(beams.sum())
}

/// Divides two whole numbers by their greatest common divisor.
fn lowest(one: f64, other: f64) -> (f64, f64) {
    let (mut factor, mut rest) = (one, other);
    while rest != 0.0 {
        (factor, rest) = (rest, factor % rest);
    }
    (one / factor, other / factor)
}

/// Turns a lattice into solids of a scene.
struct Lowering<'a, 'input> {
    source: &'a Source,
    file: &'a Spanned<String>,
    root: Element<'a, 'input>,
    place: &'a Similarity,
    /// The factor and divisor of lengths; they cause one rounding if one of them is 1.
    units: (f64, f64),
    keys: &'a BeamLattice,
    /// Whether the material shows the radius.
    shows_radius: bool,
    solids: &'a mut SolidCollector,
}

impl Lowering<'_, '_> {
    fn point(&self, point: DVec3) -> DVec3 {
        self.place.parent_from_child.transform_point3(point) * self.units.0 / self.units.1
    }

    fn length(&self, length: f64) -> f64 {
        length * self.place.scale * self.units.0 / self.units.1
    }

    /// Adds the beams in their order, then the balls in the order of their
    /// vertices, then the halves of balls in the order of their beams.
    fn add(&mut self, lattice: &Lattice) -> Result<(), SceneError> {
        let points: Vec<_> = lattice.vertices.iter().map(|&at| self.point(at)).collect();
        let mut balls = BTreeMap::new();
        for (&vertex, &radius) in &lattice.balls {
            balls.insert(vertex, self.length(radius));
        }
        let mut halves = Vec::new();
        for beam in &lattice.beams {
            let ends = beam.vertices.map(|vertex| points[vertex]);
            let radii = beam.radii.map(|radius| self.length(radius));
            let Some(solid) = self.frustum(beam, ends, radii)? else {
                self.solids
                    .skip()
                    .map_err(|refusal| self.refused(&refusal))?;
                self.value(f64::NAN);
                continue;
            };
            self.push(&solid)?;
            self.value((radii[0] + radii[1]) / 2.0);
            for end in [0, 1] {
                let half = Half {
                    vertex: beam.vertices[end],
                    center: ends[end],
                    outward: ends[end] - ends[1 - end],
                    radius: radii[end],
                };
                match beam.end(end, radii, half.outward.length()) {
                    End::Flat => {}
                    End::Half => halves.push(half),
                    End::Ball => {
                        let radius = balls.entry(half.vertex).or_insert(half.radius);
                        *radius = radius.max(half.radius);
                    }
                }
            }
        }
        for (&vertex, &radius) in &balls {
            let ball = Sphere::new(points[vertex], radius);
            let ball = ball.map_err(|error| self.root.error(error.to_string()))?;
            self.push(&ball.into())?;
            self.value(radius);
        }
        for half in halves {
            if balls
                .get(&half.vertex)
                .is_none_or(|&radius| radius < half.radius)
            {
                let solid = half.solid().map_err(|message| self.root.error(message))?;
                let pushed = self.solids.push_composition(solid, self.keys.material);
                pushed.map_err(|refusal| self.refused(&refusal))?;
                self.value(half.radius);
            }
        }
        Ok(())
    }

    fn push(&mut self, solid: &AnySolid) -> Result<(), SceneError> {
        let pushed = self.solids.push_any(solid, self.keys.material);
        pushed.map_err(|refusal| self.refused(&refusal))
    }

    /// Sets the radius of the solid that was added last as its value, if it is shown.
    fn value(&mut self, radius: f64) {
        if self.shows_radius {
            self.solids
                .value(self.keys.material, DataColor::stored(radius));
        }
    }

    /// The error that a solid cannot be added.
    fn refused(&self, refusal: &Refusal) -> SceneError {
        let in_file = |message, help: Option<&str>| self.root.error_at(0, message, help);
        refusal.in_row(self.source, self.file, in_file)
    }

    /// The beam without its caps, or `None` if it is skipped.
    fn frustum(
        &self,
        beam: &Beam,
        [p0, p1]: [DVec3; 2],
        [radius0, radius1]: [f64; 2],
    ) -> Result<Option<AnySolid>, SceneError> {
        if beam.is_short {
            return Ok(None);
        }
        let (message, degenerate) = match radius0 == radius1 {
            true => match Cylinder::new(p0, p1, radius0, Caps::Both) {
                Ok(solid) => return Ok(Some(solid.into())),
                Err(error) => (error.to_string(), is_degenerate(&error)),
            },
            false => match Cone::new(p0, p1, radius0, radius1, Caps::Both) {
                Ok(solid) => return Ok(Some(solid.into())),
                Err(error) => (error.to_string(), is_degenerate_cone(&error)),
            },
        };
        if degenerate && self.keys.degenerate == Degenerate::Skip {
            return Ok(None);
        }
        let help = degenerate.then_some(SKIP_HELP);
        Err(self.root.error_at(beam.place, message, help))
    }
}

/// The half of a ball beyond the end of a beam.
struct Half {
    vertex: usize,
    center: DVec3,
    /// The outward vector along the beam, of the beam's length.
    outward: DVec3,
    radius: f64,
}

impl Half {
    fn solid(&self) -> Result<Composition, String> {
        let mut axis = self.outward;
        // Doubling is exact, and keeps the direction.
        while axis.length() < 2.0 * self.radius {
            axis *= 2.0;
        }
        let ball = Sphere::new(self.center, self.radius).map_err(|error| error.to_string())?;
        let width = 2.0 * self.radius;
        let stand = Cylinder::new(self.center, self.center + axis, width, Caps::Both);
        let stand = stand.map_err(|error| error.to_string())?;
        let parts = [AnySolid::from(ball), stand.into()].map(Composition::Solid);
        Ok(Composition::Intersection(parts.into()))
    }
}
