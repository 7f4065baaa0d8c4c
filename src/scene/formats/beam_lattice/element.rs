//! An element of the model's XML: its attributes, and errors that name its line.

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use roxmltree::{Document, Node};

use crate::scene::error::SceneError;
use crate::scene::names::{quoted, suggestion};

/// 3MF itself.
pub(super) const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
/// The extension for beam lattices.
pub(super) const BEAM_LATTICE: &str =
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
/// Its extension for balls.
pub(super) const BALLS: &str =
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07";
/// Objects in several parts. Its identifiers change nothing; its paths are refused.
pub(super) const PRODUCTION: &str =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// How far `MᵀM` may be from `s² 1`, as a share of `s²`, for `M` to count as a
/// rotation and a scale. Files state entries in decimals: with four of them those of
/// a rotation are off by 5e-5 each, so an entry of `MᵀM`, the product of two unit
/// columns, by 5e-5 times the sums of their entries' sizes, at most `2 √3 · 5e-5`.
/// `s²` is the mean of three of them, from which one is 4/3 of that away at most:
/// `4/3 · 2 √3 · 5e-5 < 2.4e-4`.
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
    /// Leaves everything as it is.
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

    /// Where it begins, in bytes.
    pub fn place(&self) -> usize {
        self.node.range().start
    }

    /// That `message` is true of this element.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        self.error_at(self.place(), message, None)
    }

    /// That `message` is true of this element, and what to do about it.
    pub fn error_with_help(&self, message: impl Into<String>, help: &str) -> SceneError {
        self.error_at(self.place(), message, Some(help))
    }

    /// That `message` is true of a place in this element's document.
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

    /// Whether it is the element of a name in 3MF itself.
    pub fn is(&self, name: &str) -> bool {
        self.node.has_tag_name((CORE, name))
    }

    /// Whether it is the element of a name in one of the two extensions for
    /// beam lattices.
    fn is_of_lattice(&self, name: &str) -> bool {
        self.node.has_tag_name((BEAM_LATTICE, name)) || self.node.has_tag_name((BALLS, name))
    }

    /// Refuses a child with one of these names that is in no namespace of a beam
    /// lattice: what it states would be left out silently.
    pub fn refuse_foreign(&self, names: &[&str]) -> Result<(), SceneError> {
        let mut children = self.children();
        let foreign = children
            .find(|child| names.contains(&child.name()) && !child.is_of_lattice(child.name()));
        foreign.map_or(Ok(()), |child| {
            let name = child.name();
            let namespace = quoted(child.node.tag_name().namespace().unwrap_or_default());
            Err(child.error(format!(
                "<{name}> is in the namespace {namespace}: that of beam lattices is {BEAM_LATTICE}"
            )))
        })
    }

    /// The elements in it.
    fn children(&self) -> impl Iterator<Item = Self> + use<'a, 'input> {
        let path = self.path;
        let elements = self.node.children().filter(Node::is_element);
        elements.map(move |node| Self { path, node })
    }

    /// The elements in it of a name in 3MF itself.
    pub fn all<'n>(&self, name: &'n str) -> impl Iterator<Item = Self> + use<'a, 'input, 'n> {
        self.children().filter(move |child| child.is(name))
    }

    /// The first of them.
    pub fn first(&self, name: &str) -> Option<Self> {
        self.all(name).next()
    }

    /// The elements in it of a name in the extensions for beam lattices.
    pub fn all_of_lattice<'n>(
        &self,
        name: &'n str,
    ) -> impl Iterator<Item = Self> + use<'a, 'input, 'n> {
        self.children()
            .filter(move |child| child.is_of_lattice(name))
    }

    /// An attribute of no namespace.
    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name).map(str::trim)
    }

    /// An attribute of a namespace.
    pub fn attribute_of(&self, namespace: &str, name: &str) -> Option<&'a str> {
        self.node.attribute((namespace, name)).map(str::trim)
    }

    /// The namespace that a prefix means.
    pub fn namespace(&self, prefix: &str) -> Option<&'a str> {
        self.node.lookup_namespace_uri(Some(prefix))
    }

    /// The name of the element, for messages.
    fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// That an attribute must be there.
    fn missing(&self, name: &str) -> SceneError {
        self.error(format!("<{}> has no {name}", self.name()))
    }

    /// An attribute that must be there.
    pub fn required(&self, name: &str) -> Result<&'a str, SceneError> {
        self.attribute(name).ok_or_else(|| self.missing(name))
    }

    /// The number of a resource, which must be stated.
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

    /// The finite number that a text of this element is.
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

    /// A length that is stated here, 0 or more.
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

    /// A length that must be stated here.
    pub fn required_length(&self, name: &str) -> Result<f64, SceneError> {
        self.length(name)?.ok_or_else(|| self.missing(name))
    }

    /// The number of one of `count` vertices.
    pub fn vertex(&self, name: &str, count: usize) -> Result<usize, SceneError> {
        let text = self.required(name)?;
        let number = text.parse().ok().filter(|&number: &usize| number < count);
        number.ok_or_else(|| {
            let element = self.name();
            self.error(format!(
                "{name} of <{element}> is {}: it must be the number of one of the {count} vertices, which count from 0",
                quoted(text)
            ))
        })
    }

    /// The meaning of an attribute that is one of a few words, where it is stated.
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

    /// The `transform`, four rows of three numbers for points as rows, or the
    /// identity.
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
        // Rows for points as rows are columns for points as columns.
        let parent_from_child = DAffine3::from_cols_array(&numbers);
        let matrix = parent_from_child.matrix3;
        let gram = matrix.transpose() * matrix;
        let squared = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
        let off = gram - DMat3::from_diagonal(DVec3::splat(squared));
        let off = off.to_cols_array().into_iter();
        let off = off.fold(0.0, |greatest: f64, entry| greatest.max(entry.abs()));
        // Neither zeros nor numbers beyond f64 pass this.
        if !(off <= LARGEST_UNEVENNESS * squared && squared > 0.0 && squared.is_finite()) {
            return Err(self.error_with_help(
                "transform does more than to turn, mirror, scale evenly and move: beams would no longer be round",
                "take it out of the file, put the lattice into a [[prototype]] and the transform into the matrix of an [[instance]]",
            ));
        }
        Ok(Similarity {
            parent_from_child,
            scale: squared.sqrt(),
        })
    }
}
