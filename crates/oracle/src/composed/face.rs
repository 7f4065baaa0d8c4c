//! Pieces of surface that a composition really has at a point.

use glam::DVec3;

use cyltrace::solid::Part;

use super::ring::Vector;

/// A part of an operand's surface that separates inside from outside at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Whose surface it is, a position in
    /// [`Composition::operands`](cyltrace::solid::Composition::operands).
    pub leaf: u32,
    /// The part of its surface.
    pub part: Part,
    /// Whether the composition is on the inner side of the operand's surface.
    pub is_outward: bool,
    /// The unit normal that points out of the composition; `None` at an apex.
    pub normal: Option<DVec3>,
}

/// Adds a face with the normal of a sheet's gradient, unless it is there.
pub(super) fn note(faces: &mut Vec<Face>, face: Face, gradient: &Vector) {
    let is_same = |one: &Face| {
        (one.leaf, one.part, one.is_outward) == (face.leaf, face.part, face.is_outward)
    };
    if faces.iter().any(is_same) {
        return;
    }
    let side = if face.is_outward { 1.0 } else { -1.0 };
    let outward = gradient.approximation();
    let normal = (outward / outward.abs().max_element()).try_normalize();
    faces.push(Face {
        normal: normal.map(|normal| normal * side),
        ..face
    });
}
