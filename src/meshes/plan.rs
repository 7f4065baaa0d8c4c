//! The size of a mesh, and a bound of its distance from the true surface.
//!
//! Both are computed once for each prototype, innermost first, so the time does
//! not grow with the number of placed solids. For the content of a prototype, in
//! its own coordinates, let
//!
//! - D bound the distance of the meshes from the surfaces and of the surfaces from
//!   the meshes: [`deviation_of`];
//! - E bound the distance of a computed vertex from the exact one:
//!   [`corner_error_of`];
//! - P bound the distance of any vertex from the origin.
//!
//! A placement `x -> L x + T` lengthens vectors, and so distances, by at most
//! `s = |L|`: D becomes `s D`. A vertex passes through one placement after
//! another. In `L x + T` every component is three products and three sums, with a
//! relative error of at most 4 u each (u = 2^-53), so the error of a vertex grows
//! by `4 u (|L|_F P + |T|)`, with `|L|_F <= √3 s`:
//!
//! `D' = s D`,  `E' = s E + 5 u (2 s P + |T|)`,  `P' = s P + |T|`
//!
//! where 5 and 2 instead of 4 and √3 leave room for terms of second order. A
//! point of a triangle moves no farther than its corners, so D + E bounds the
//! distance of the written mesh from the surface, and of the surface from the
//! mesh. The factor `1 + 2^-36` covers the rounding of the bounds themselves, six
//! roundings a level on at most a few thousand levels.

use super::MeshFileError;
use crate::math::{ChildFromParent, PlacementErrors, UNIT_ROUNDOFF, power_of_two};
use crate::scene::{Placement, Prototype, PrototypeIndex, Scene};
use crate::solid::SolidKind;
use crate::solid::tessellation::{
    Fit, GREATEST_SEGMENTS, LEAST_SEGMENTS, corner_error_of, deviation_of, mesh_size_of, reach_of,
};

/// Digits of the greatest placement number, and the `/` before it.
const LONGEST_STEP: u128 = 11;

/// The size and accuracy of a scene's mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    segments: u32,
    fit: Fit,
    whole: Whole,
}

/// The totals of a prototype and everything placed in it, in its own coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Whole {
    solids: u128,
    /// The solids whose meshes are prisms.
    cylinders: u128,
    vertices: u128,
    triangles: u128,
    /// Placed prototypes that have solids of their own.
    groups: u128,
    /// An upper bound of the bytes of their names and paths.
    names: u128,
    deviation: f64,
    rounding: f64,
    reach: f64,
}

impl Plan {
    /// Computes the size and accuracy of the mesh of a scene.
    ///
    /// # Errors
    /// If the number of segments is out of range, or a solid is composed of others.
    pub fn new(scene: &Scene, segments: u32, fit: Fit) -> Result<Self, MeshFileError> {
        if !(LEAST_SEGMENTS..=GREATEST_SEGMENTS).contains(&segments) {
            return Err(MeshFileError::Segments { segments });
        }
        let mut wholes = vec![None; scene.prototypes.len()];
        let whole = whole(scene, PrototypeIndex::ROOT, segments, fit, &mut wholes);
        let placed = scene.prototypes.iter().zip(&wholes);
        let composed = placed.filter(|(_, whole)| whole.is_some());
        let solids = composed.map(|(prototype, _)| prototype.solids.compositions.len() as u64);
        let solids = solids.sum();
        if solids > 0 {
            return Err(MeshFileError::ComposedSolids { solids });
        }
        Ok(Self {
            segments,
            fit,
            whole,
        })
    }

    /// Sides around an axis.
    #[must_use]
    pub fn segments(&self) -> u32 {
        self.segments
    }

    /// On which side of the surfaces the meshes stay.
    #[must_use]
    pub fn fit(&self) -> Fit {
        self.fit
    }

    /// Solids, with every placement counted.
    #[must_use]
    pub fn solids(&self) -> u128 {
        self.whole.solids
    }

    /// Whether all solids are cylinders, so that their meshes are prisms.
    #[must_use]
    pub fn are_prisms(&self) -> bool {
        self.whole.cylinders == self.whole.solids
    }

    /// Vertices of the mesh.
    #[must_use]
    pub fn vertices(&self) -> u128 {
        self.whole.vertices
    }

    /// Triangles of the mesh.
    #[must_use]
    pub fn triangles(&self) -> u128 {
        self.whole.triangles
    }

    /// An upper bound of the distance of any point of the mesh from the surface of
    /// the scene, and of any point of the surface from the mesh, in scene units. It
    /// includes rounding.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        (self.whole.deviation + self.whole.rounding) * (1.0 + power_of_two(-36))
    }

    /// The part of [`Plan::deviation`] that is rounding: an inscribed mesh may
    /// leave its solid by this distance, and a circumscribed one may enter it.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        self.whole.rounding * (1.0 + power_of_two(-36))
    }

    /// An upper bound of the bytes of the names of all groups, and the number of groups.
    pub(super) fn group_names(&self) -> (u128, u128) {
        (self.whole.names, self.whole.groups)
    }

    /// The comment lines of a mesh file.
    pub(super) fn comment(&self, name: &str) -> [String; 6] {
        let printable = |c: char| if c.is_control() { ' ' } else { c };
        let name: String = name.chars().map(printable).collect();
        [
            format!("cyltrace {} tessellate", env!("CARGO_PKG_VERSION")),
            format!("scene {name}"),
            format!("segments {}", self.segments),
            format!("fit {}", self.fit.name()),
            format!("deviation {:?}", self.deviation()),
            "The mesh is within the deviation, in scene units, of the true surface.".to_owned(),
        ]
    }
}

/// The totals of a prototype. The description contains no cycles.
fn whole(
    scene: &Scene,
    index: PrototypeIndex,
    segments: u32,
    fit: Fit,
    wholes: &mut [Option<Whole>],
) -> Whole {
    if let Some(whole) = wholes[index.0 as usize] {
        return whole;
    }
    let prototype = &scene.prototypes[index.0 as usize];
    let mut whole = Whole::of_solids(prototype, segments, fit);
    for placement in &prototype.placements {
        let child = self::whole(scene, placement.of, segments, fit, wholes);
        whole.add(&child.placed(placement));
    }
    wholes[index.0 as usize] = Some(whole);
    whole
}

impl Whole {
    /// The solids of a prototype alone.
    fn of_solids(prototype: &Prototype, segments: u32, fit: Fit) -> Self {
        let is_group = !prototype.solids.is_empty();
        let mut whole = Self {
            groups: u128::from(is_group),
            names: u128::from(is_group) * prototype.name.len() as u128,
            ..Self::default()
        };
        for (_, solid) in prototype.singles() {
            let (vertices, triangles) = mesh_size_of(&solid, segments);
            whole.add(&Self {
                solids: 1,
                cylinders: u128::from(solid.kind() == SolidKind::Cylinder),
                vertices: vertices.into(),
                triangles: triangles.into(),
                deviation: deviation_of(&solid, segments, fit),
                rounding: corner_error_of(&solid, segments),
                reach: reach_of(&solid, segments),
                ..Self::default()
            });
        }
        whole
    }

    /// The totals in the coordinates of the parent.
    fn placed(self, placement: &Placement) -> Self {
        let map = &placement.parent_from_child;
        let stretch = PlacementErrors::new(map, &ChildFromParent::new(map)).stretch;
        let translation = map.translation.length();
        let applied = 5.0 * UNIT_ROUNDOFF * (2.0 * stretch * self.reach + translation);
        Self {
            names: self
                .names
                .saturating_add(self.groups.saturating_mul(LONGEST_STEP)),
            deviation: stretch * self.deviation,
            rounding: stretch * self.rounding + applied,
            reach: stretch * self.reach + translation,
            ..self
        }
    }

    fn add(&mut self, other: &Self) {
        for (count, more) in [
            (&mut self.solids, other.solids),
            (&mut self.cylinders, other.cylinders),
            (&mut self.vertices, other.vertices),
            (&mut self.triangles, other.triangles),
            (&mut self.groups, other.groups),
            (&mut self.names, other.names),
        ] {
            *count = count.saturating_add(more);
        }
        self.deviation = self.deviation.max(other.deviation);
        self.rounding = self.rounding.max(other.rounding);
        self.reach = self.reach.max(other.reach);
    }
}
