//! An XML element of the model: its attributes, and errors that name its line.

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use roxmltree::{Document, Node};

use crate::scene::error::SceneError;
use crate::scene::names::{quoted, suggestion};

/// The core of 3MF.
pub(super) const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
/// The extension for beam lattices.
pub(super) const BEAM_LATTICE: &str =
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
/// Its extension for balls.
pub(super) const BALLS: &str =
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07";
/// Objects in several parts. Its identifiers have no effect; its paths are rejected.
pub(super) const PRODUCTION: &str =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// How far an entry of `MᵀM` may be from that of `s² 1`, relative to `s²`, for `M` to
/// count as a rotation and a scale. Files state entries in decimals. With four
/// decimals the entries of a rotation are off by up to 5e-5, so an entry of `MᵀM`, the
/// product of two unit columns, is off by 5e-5 times the sums of the sizes of their
/// entries, at most `2 √3 · 5e-5`. `s²` is the mean of three entries, and one of them
/// differs from the mean by at most 4/3 of that: `4/3 · 2 √3 · 5e-5 < 2.4e-4`.
const LARGEST_UNEVENNESS: f64 = 2.4e-4;

/// An element.
#[derive(Clone, Copy)]
pub(super) struct Element<'a, 'input> {
    path: &'a Path,
    node: Node<'a, 'input>,
}

/// A rotation or mirror, a scale and a translation.
#[derive(Clone, Copy)]
pub(super) struct Similarity {
    pub parent_from_child: DAffine3,
    /// The factor on every length.
    pub scale: f64,
}

impl Similarity {
    /// The identity.
    pub const IDENTITY: Self = Self {
        parent_from_child: DAffine3::IDENTITY,
        scale: 1.0,
    };

    /// This after `inner`.
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            parent_from_child: self.parent_from_child * inner.parent_from_child,
            scale: self.scale * inner.scale,
        }
    }
}

impl<'a, 'input> Element<'a, 'input> {
    /// The outermost element of a document.
    pub fn root(path: &'a Path, document: &'a Document<'input>) -> Self {
        let node = document.root_element();
        Self { path, node }
    }

    /// Its file and line, for notes.
    pub fn place_text(&self) -> String {
        let line = self.node.document().text_pos_at(self.place()).row;
        format!("{}:{line}", self.path.display())
    }

    /// The byte at which it begins.
    pub fn place(&self) -> usize {
        self.node.range().start
    }

    /// An error about this element.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        self.error_at(self.place(), message, None)
    }

    /// An error about this element, with advice.
    pub fn error_with_help(&self, message: impl Into<String>, help: &str) -> SceneError {
        self.error_at(self.place(), message, Some(help))
    }

    /// An error about a place in this element's document.
    pub fn error_at(
        &self,
        place: usize,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        SceneError::Row {
            path: self.path.to_owned(),
            line: u64::from(self.node.document().text_pos_at(place).row),
            column: None,
            message: message.into(),
            help: help.map(str::to_owned),
        }
    }

    /// Whether it is the core element of this name.
    pub fn is(&self, name: &str) -> bool {
        self.node.has_tag_name((CORE, name))
    }

    /// Whether it is the element of this name in one of the two extensions for beam
    /// lattices.
    fn is_of_lattice(&self, name: &str) -> bool {
        self.node.has_tag_name((BEAM_LATTICE, name)) || self.node.has_tag_name((BALLS, name))
    }

    /// Rejects a child with one of these names that is in no namespace of beam lattices:
    /// its content would be ignored silently.
    pub fn refuse_foreign(&self, names: &[&str]) -> Result<(), SceneError> {
        let mut children = self.children();
        let foreign = children
            .find(|child| names.contains(&child.name()) && !child.is_of_lattice(child.name()));
        foreign.map_or(Ok(()), |child| {
            let name = child.name();
            let namespace = quoted(child.node.tag_name().namespace().unwrap_or_default());
            Err(child.error(format!(
                "<{name}> is in the namespace {namespace}: the namespace of beam lattices is {BEAM_LATTICE}"
            )))
        })
    }

    /// The child elements.
    fn children(&self) -> impl Iterator<Item = Self> + use<'a, 'input> {
        let path = self.path;
        let elements = self.node.children().filter(Node::is_element);
        elements.map(move |node| Self { path, node })
    }

    /// The core child elements of a name.
    pub fn all<'n>(&self, name: &'n str) -> impl Iterator<Item = Self> + use<'a, 'input, 'n> {
        self.children().filter(move |child| child.is(name))
    }

    /// The first core child element of a name.
    pub fn first(&self, name: &str) -> Option<Self> {
        self.all(name).next()
    }

    /// The child elements of a name in the extensions for beam lattices.
    pub fn all_of_lattice<'n>(
        &self,
        name: &'n str,
    ) -> impl Iterator<Item = Self> + use<'a, 'input, 'n> {
        self.children()
            .filter(move |child| child.is_of_lattice(name))
    }

    /// An attribute without a namespace.
    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name).map(str::trim)
    }

    /// An attribute of a namespace.
    pub fn attribute_of(&self, namespace: &str, name: &str) -> Option<&'a str> {
        self.node.attribute((namespace, name)).map(str::trim)
    }

    /// The namespace of a prefix.
    pub fn namespace(&self, prefix: &str) -> Option<&'a str> {
        self.node.lookup_namespace_uri(Some(prefix))
    }

    /// The name of the element, for messages.
    fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The error of a missing attribute.
    fn missing(&self, name: &str) -> SceneError {
        self.error(format!("<{}> has no {name}", self.name()))
    }

    /// A required attribute.
    pub fn required(&self, name: &str) -> Result<&'a str, SceneError> {
        self.attribute(name).ok_or_else(|| self.missing(name))
    }

    /// The number of a resource, a required attribute.
    pub fn id(&self, name: &str) -> Result<u32, SceneError> {
        let text = self.required(name)?;
        let id = text.parse().ok();
        id.filter(|id| (1..1 << 31).contains(id)).ok_or_else(|| {
            let element = self.name();
            self.error(format!(
                "{name} of <{element}> is {}: it must be a whole number from 1 to {}",
                quoted(text),
                (1_u32 << 31) - 1
            ))
        })
    }

    /// Parses a text of this element as a finite number.
    fn finite(&self, name: &str, text: &str) -> Result<f64, SceneError> {
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| {
            let element = self.name();
            self.error(format!(
                "{name} of <{element}> is {}: it must be a finite number",
                quoted(text)
            ))
        })
    }

    /// The coordinates of a `<vertex>`.
    pub fn point(&self) -> Result<DVec3, SceneError> {
        let coordinate = |name| self.finite(name, self.required(name)?);
        Ok(DVec3::new(
            coordinate("x")?,
            coordinate("y")?,
            coordinate("z")?,
        ))
    }

    /// An optional length, 0 or more.
    pub fn length(&self, name: &str) -> Result<Option<f64>, SceneError> {
        let text = self
            .attribute(name)
            .or_else(|| self.attribute_of(BALLS, name));
        text.map(|text| {
            let length = self.finite(name, text)?;
            if length < 0.0 {
                let element = self.name();
                let message = format!("{name} of <{element}> is {length}: it must not be negative");
                return Err(self.error(message));
            }
            Ok(length)
        })
        .transpose()
    }

    /// A required length.
    pub fn required_length(&self, name: &str) -> Result<f64, SceneError> {
        self.length(name)?.ok_or_else(|| self.missing(name))
    }

    /// The number of a vertex, below `count`.
    pub fn vertex(&self, name: &str, count: usize) -> Result<usize, SceneError> {
        let text = self.required(name)?;
        let number = text.parse().ok().filter(|&number: &usize| number < count);
        number.ok_or_else(|| {
            let element = self.name();
            self.error(format!(
                "{name} of <{element}> is {}: it must be a vertex number, from 0 and below {count}",
                quoted(text)
            ))
        })
    }

    /// The meaning of an optional attribute that is one of a few words.
    pub fn choose<T: Copy>(
        &self,
        name: &str,
        choices: &[(&str, T)],
    ) -> Result<Option<T>, SceneError> {
        let text = self
            .attribute(name)
            .or_else(|| self.attribute_of(BALLS, name));
        let Some(text) = text else {
            return Ok(None);
        };
        let found = choices.iter().find(|(word, _)| *word == text);
        found.map(|(_, meaning)| Some(*meaning)).ok_or_else(|| {
            let words = choices.iter().map(|(word, _)| *word);
            self.error_with_help(
                format!("{} is not a value of {name}", quoted(text)),
                &suggestion(text, words, "values"),
            )
        })
    }

    /// The `transform`: four rows of three numbers, for points as row vectors. The
    /// default is the identity.
    pub fn transform(&self) -> Result<Similarity, SceneError> {
        let Some(text) = self.attribute("transform") else {
            return Ok(Similarity::IDENTITY);
        };
        let numbers = text.split_whitespace();
        let numbers = numbers.map(|number| self.finite("transform", number));
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        let Ok(numbers) = <[f64; 12]>::try_from(numbers.as_slice()) else {
            let count = numbers.len();
            return Err(self.error(format!("transform has {count} numbers: it needs 12")));
        };
        // The rows for row vectors are the columns for column vectors.
        let parent_from_child = DAffine3::from_cols_array(&numbers);
        let matrix = parent_from_child.matrix3;
        let gram = matrix.transpose() * matrix;
        let squared = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
        let off = gram - DMat3::from_diagonal(DVec3::splat(squared));
        let off = off.to_cols_array().into_iter();
        let off = off.fold(0.0, |greatest: f64, entry| greatest.max(entry.abs()));
        // Zeros and numbers beyond f64 fail this.
        if !(off <= LARGEST_UNEVENNESS * squared && squared > 0.0 && squared.is_finite()) {
            return Err(self.error_with_help(
                "transform does more than rotate, mirror, scale uniformly and translate: beams would no longer be round",
                "remove it from the file, put the lattice into a [[prototype]] and place that by an [[instance]] with the transform as its matrix",
            ));
        }
        Ok(Similarity {
            parent_from_child,
            scale: squared.sqrt(),
        })
    }
}
