//! What a mesh will hold, and how far it may be from the true surface.
//!
//! Both are worked out once a prototype, innermost first, so that the time does
//! not grow with what is placed. For the content of a prototype, in its own
//! coordinates, let
//!
//! - D bound the distance between meshes and surfaces, each from the other:
//!   [`deviation_of`], what falls short or reaches beyond;
//! - E bound how far a vertex, as computed, is from the one that is meant:
//!   [`corner_error_of`];
//! - P bound how far any vertex is from the origin.
//!
//! A placement `x -> L x + T` lengthens vectors by `s = |L|` at most, and
//! distances likewise: D becomes `s D`. A vertex goes through one placement
//! after another. In `L x + T` every component is three products and three
//! sums, of relative error 4 u each at most (u = 2^-53), so a vertex is off by
//! `4 u (|L|_F P + |T|)` more, with `|L|_F <= √3 s`:
//!
//! `D' = s D`,  `E' = s E + 5 u (2 s P + |T|)`,  `P' = s P + |T|`
//!
//! where 5 and 2 for 4 and √3 leave room for terms of second order. A
//! point of a triangle is moved no farther than its corners, so D + E bounds
//! the distance of the mesh as written from the surface, and of the surface from
//! the mesh. The roundings of the bounds themselves, six a level on at most a
//! few thousand levels, are covered by a factor `1 + 2^-36`.

use super::MeshFileError;
use crate::math::{ChildFromParent, PlacementErrors, UNIT_ROUNDOFF, power_of_two};
use crate::scene::{Placement, Prototype, PrototypeIndex, Scene};
use crate::solid::SolidKind;
use crate::solid::tessellation::{
    Fit, GREATEST_SEGMENTS, LEAST_SEGMENTS, corner_error_of, deviation_of, mesh_size_of, reach_of,
};

/// Digits of the greatest placement number, and the `/` before it.
const LONGEST_STEP: u128 = 11;

/// What the mesh of a scene comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    segments: u32,
    fit: Fit,
    whole: Whole,
}

/// What a prototype comes to with all that it places, in its own coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Whole {
    solids: u128,
    /// Those of them whose meshes are prisms.
    cylinders: u128,
    vertices: u128,
    triangles: u128,
    /// Prototypes with solids of their own, each time they are placed.
    groups: u128,
    /// At least the bytes of their names and paths.
    names: u128,
    deviation: f64,
    rounding: f64,
    reach: f64,
}

impl Plan {
    /// Counts what the meshes of a scene come to.
    ///
    /// # Errors
    /// When there are no meshes with this many sides, or solids that are composed of others.
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

    /// Every point of the mesh is at most this far from the surface of the
    /// scene, and every point of that from the mesh, in scene units. Roundings
    /// are part of it.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        (self.whole.deviation + self.whole.rounding) * (1.0 + power_of_two(-36))
    }

    /// The part of [`Plan::deviation`] that is rounding: by so much an inscribed
    /// mesh may reach out of its solid, and a circumscribed one into it.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        self.whole.rounding * (1.0 + power_of_two(-36))
    }

    /// At least the bytes of the names of all groups, and how many there are.
    pub(super) fn group_names(&self) -> (u128, u128) {
        (self.whole.names, self.whole.groups)
    }

    /// What a file says of itself, line by line.
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

/// What a prototype comes to. The description contains no cycles.
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

    /// The same, as it is where it is placed.
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
