//! The model of a 3MF file: its unit, and the objects that its `<build>` places directly
//! or through components.

use std::collections::HashMap;

use super::element::{BALLS, BEAM_LATTICE, CORE, Element, PRODUCTION, Similarity};
use super::lattice::Lattice;
use super::notes::Notes;
use crate::scene::error::SceneError;
use crate::scene::limits::MOST_PLACES;
use crate::scene::names::quoted;

/// The extensions that a file may require. Materials do not affect geometry; of the
/// production extension only the identifiers are accepted.
const EXTENSIONS: [&str; 4] = [
    BEAM_LATTICE,
    BALLS,
    PRODUCTION,
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
];

/// The types of objects, and whether each may have a beam lattice.
const TYPES: [(&str, Type); 5] = [
    ("model", Type::WithLattice),
    ("solidsupport", Type::WithLattice),
    ("support", Type::WithoutLattice),
    ("surface", Type::WithoutLattice),
    ("other", Type::Other),
];

/// See [`TYPES`].
#[derive(Clone, Copy, PartialEq)]
enum Type {
    WithLattice,
    WithoutLattice,
    /// Without a lattice, and not an item of the build either.
    Other,
}

/// The units of length in micrometers.
pub(super) const UNITS: [(&str, f64); 6] = [
    ("micron", 1.0),
    ("millimeter", 1e3),
    ("centimeter", 1e4),
    ("inch", 25_400.0),
    ("foot", 304_800.0),
    ("meter", 1e6),
];

/// An object with a lattice, and its placements.
pub(super) struct Placed {
    pub lattice: Lattice,
    pub places: Vec<Similarity>,
}

/// The content of a file, in its own unit.
pub(super) struct Model {
    /// The unit, in micrometers.
    pub unit: f64,
    /// In the order of the objects in the file.
    pub placed: Vec<Placed>,
    /// Notes on ignored content, and on content that other programs may read differently.
    pub notes: Vec<String>,
}

impl Model {
    /// Reads the model from its outermost element.
    pub fn new(model: &Element, skips_meshes: bool) -> Result<Self, SceneError> {
        if !model.is("model") {
            return Err(model.error(format!(
                "this is not a 3MF model: the root must be <model> in {CORE}"
            )));
        }
        check_extensions(model)?;
        let unit = model.choose("unit", &UNITS)?.unwrap_or(1e3);
        let objects = Objects::new(model)?;
        let mut placed = Vec::new();
        let mut notes = Notes::default();
        for (object, places) in objects.list.iter().zip(objects.places(model)?) {
            if places.is_empty() {
                continue;
            }
            if let Some(mesh) = object.first("mesh")
                && let Some(lattice) = Lattice::new(&mesh, skips_meshes, &mut notes.of(object))?
            {
                check_type(object, &mut notes)?;
                placed.push(Placed { lattice, places });
            }
        }
        if placed.iter().all(|placed| placed.lattice.beams.is_empty()) {
            return Err(model.error("the <build> of the file contains no object with beams"));
        }
        if !requires(model, BEAM_LATTICE) {
            notes.add(
                model,
                "the model does not require the extension for beam lattices, so other programs may ignore them: add its prefix to requiredextensions",
            );
        }
        let notes = notes.into_lines();
        Ok(Self {
            unit,
            placed,
            notes,
        })
    }
}

/// Adds a note if an object has a lattice although its type does not allow one.
fn check_type(object: &Element, notes: &mut Notes) -> Result<(), SceneError> {
    let is_for = object.choose("type", &TYPES)?.unwrap_or(Type::WithLattice);
    if is_for != Type::WithLattice {
        let word = quoted(object.attribute("type").unwrap_or_default());
        notes.of(object).add(&format!(
            "its type is {word}, but only objects of type \"model\" or \"solidsupport\" may have a beam lattice: cyltrace reads it, other programs may ignore it"
        ));
    }
    Ok(())
}

/// Whether a model requires an extension.
fn requires(model: &Element, extension: &str) -> bool {
    let required = model.attribute("requiredextensions").unwrap_or_default();
    let mut required = required.split_whitespace();
    required.any(|prefix| model.namespace(prefix) == Some(extension))
}

/// Rejects a model that requires an unsupported extension.
fn check_extensions(model: &Element) -> Result<(), SceneError> {
    let required = model.attribute("requiredextensions").unwrap_or_default();
    for prefix in required.split_whitespace() {
        let namespace = model.namespace(prefix);
        if !namespace.is_some_and(|namespace| EXTENSIONS.contains(&namespace)) {
            let what = quoted(namespace.unwrap_or(prefix));
            return Err(model.error_with_help(
                format!("the file requires the extension {what}, which cyltrace does not support"),
                "the supported extensions are beam lattices, their balls, materials and production",
            ));
        }
    }
    Ok(())
}

/// The objects of a file, in its order.
struct Objects<'a, 'input> {
    list: Vec<Element<'a, 'input>>,
    /// The positions in `list` by id.
    index: HashMap<u32, usize>,
}

impl<'a, 'input> Objects<'a, 'input> {
    fn new(model: &Element<'a, 'input>) -> Result<Self, SceneError> {
        let resources = model.all("resources");
        let list: Vec<_> = resources.flat_map(|list| list.all("object")).collect();
        let mut index = HashMap::with_capacity(list.len());
        for (place, object) in list.iter().enumerate() {
            let id = object.id("id")?;
            if index.insert(id, place).is_some() {
                let id = object.required("id")?;
                return Err(object.error(format!(
                    "the id {} occurs twice: ids must be unique",
                    quoted(id)
                )));
            }
        }
        Ok(Self { list, index })
    }

    /// The object that a build item or a component names, among the first `end`.
    fn named(&self, element: &Element, end: usize) -> Result<usize, SceneError> {
        if element.attribute_of(PRODUCTION, "path").is_some() {
            return Err(element.error(
                "the object is in another part of the archive: only objects of the first part are read",
            ));
        }
        let place = self.index.get(&element.id("objectid")?).copied();
        place.filter(|&place| place < end).ok_or_else(|| {
            let id = quoted(element.attribute("objectid").unwrap_or_default());
            element.error(format!(
                "objectid is {id}: it must be the id of an object before this element"
            ))
        })
    }

    /// The placements of each object. Components only name objects before their own, so in
    /// reverse order the placements of each object are complete before its parts are placed.
    fn places(&self, model: &Element) -> Result<Vec<Vec<Similarity>>, SceneError> {
        let mut places = vec![Vec::new(); self.list.len()];
        let mut count = 0;
        let mut add = |places: &mut Vec<Similarity>, more: Vec<Similarity>, element: &Element| {
            count += more.len();
            if count > MOST_PLACES {
                let message = format!("the file places objects more than {MOST_PLACES} times");
                return Err(element.error(message));
            }
            places.extend(more);
            Ok(())
        };
        let items = model.all("build").flat_map(|build| build.all("item"));
        for item in items {
            let of = self.named(&item, self.list.len())?;
            if self.list[of].attribute("type") == Some("other") {
                return Err(item.error_with_help(
                    "the object is of type \"other\", which cannot be an item of the <build>",
                    "give the object type=\"model\", or use it as a component of such an object",
                ));
            }
            add(&mut places[of], vec![item.transform()?], &item)?;
        }
        for place in (0..self.list.len()).rev() {
            let components = self.list[place].all("components");
            for component in components.flat_map(|list| list.all("component")) {
                let of = self.named(&component, place)?;
                let inner = component.transform()?;
                let more = places[place].iter().map(|outer| outer.after(&inner));
                let more = more.collect();
                add(&mut places[of], more, &component)?;
            }
        }
        Ok(places)
    }
}
