//! Meshes inside and around solids, as f32 triangles.
//!
//! Rounding moves a vertex by at most `ε` in the mesh (`vertex_error`), which is at most
//! `δ = ε |M⁻¹|` in the solid's own space. So the mesh around a solid is the
//! circumscribed one (`solid::tessellation`) of the solid grown by δ. However
//! its corners are rounded, each stays beyond the supporting plane of its facet; the normal of
//! the facet before rounding serves as the `m` of
//! `proof`. The mesh inside is the inscribed one of the solid shrunk by δ. Every mesh
//! is verified as built. One that fails is built again with a larger margin, in the end
//! with fewer sides as well, because narrow facets of f32 corners may turn over.
//!
//! A *disk* has no inside. The mesh around it is a flat cylinder. In place of a mesh inside,
//! it has two polygons, or *sheets*, one above and one below it, with all corners in
//! the infinite cylinder of the disk's radius. A line that crosses both crosses the
//! disk between them, since the cylinder is convex. Rounding bends a sheet, so a
//! line may cross the same one twice. So the sheet
//! counts, not the side from which it is crossed: the triangles of the upper one are the
//! first half of all.

mod filter;
mod proof;
#[cfg(test)]
pub(crate) mod tests;

use glam::DVec3;

use cyltrace::embree::GREATEST_COORDINATE;
use cyltrace::math::{ChildFromParent, PlacementErrors, UNIT_ROUNDOFF, power_of_two};
use cyltrace::solid::tessellation::{
    Fit, Mesh, corner_error_of, deviation_of, mesh_of, mesh_size_of,
};
use cyltrace::solid::{AnySolid, Disk};
use cyltrace_oracle::ExactVector;

use filter::Rounded;
use proof::Proven;

use super::mesh_frame::MeshFrame;
use super::mesh_map::MeshMap;
use super::window::PlacedSolid;
use crate::solids::{at_origin, displaced, shape};

/// Coordinates smaller than this are 0: Embree treats subnormal numbers as 0.
const LEAST: f64 = power_of_two(-100);

/// Margins in δ, and how often the number of sides is halved for them.
const ATTEMPTS: [(f64, u32); 5] = [(1.0, 0), (2.0, 0), (4.0, 1), (8.0, 2), (16.0, 3)];

/// Fewest sides to which they are halved.
const FEWEST: u32 = 6;

/// A mesh within one solid or around it, in the meshes' space.
#[derive(Debug, Default)]
pub(crate) struct Hull {
    /// The corners.
    pub vertices: Vec<[f32; 3]>,
    /// The corners of each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// At least the triangles of either mesh of a solid with this number of sides.
pub(crate) fn triangles_needed(solid: &AnySolid, segments: u32) -> u64 {
    if shape(solid).flat().is_some() {
        // Around it is a cylinder with both disks.
        return 4 * u64::from(segments);
    }
    let closed = at_origin(solid);
    mesh_size_of(closed.as_ref().unwrap_or(solid), segments).1
}

/// The mesh of a solid on one side of it, proven to be there; `None` if f32 does not
/// resolve the solid.
pub(crate) fn hull(
    frame: &MeshFrame,
    map: &MeshMap,
    placed: &PlacedSolid,
    segments: u32,
    side: Fit,
) -> Option<Hull> {
    let builder = Builder {
        frame,
        map,
        placed,
        here: Rounded::new(frame, map, placed),
        own: at_origin(&placed.solid)?,
    };
    let world_from_object = &placed.frame.world_from_object;
    let back = ChildFromParent::new(world_from_object);
    let shrink = frame.scale() * PlacementErrors::new(world_from_object, &back).shrink;
    let margin = builder.vertex_error(segments) / shrink;
    ATTEMPTS.into_iter().find_map(|(margins, halvings)| {
        let segments = (segments >> halvings).max(FEWEST.min(segments));
        let margin = margins * margin;
        match (shape(&placed.solid).flat(), side) {
            (_, Fit::Circumscribed) => builder.around(segments, margin),
            (Some(disk), Fit::Inscribed) => builder.sheets(disk, segments, margin),
            (None, Fit::Inscribed) => builder.inside(segments, margin),
        }
    })
}

/// What the meshes of one solid have in common.
struct Builder<'a> {
    frame: &'a MeshFrame,
    map: &'a MeshMap,
    placed: &'a PlacedSolid,
    here: Rounded<'a>,
    /// The solid with its anchor at the origin.
    own: AnySolid,
}

impl Builder<'_> {
    /// `ε`: by how much a vertex is off in the mesh. Rounding to f32 takes half an ulp of
    /// its coordinates, which are within the solid's box and what a mesh of few sides
    /// sticks out of it; the corner in f64 is a sum of products that rounds 16 times at
    /// most, and off by what [`corner_error_of`] says.
    fn vertex_error(&self, segments: u32) -> f64 {
        let fewest = FEWEST.min(segments);
        let bounds = self.placed.bounds();
        let corners = [bounds.lower, bounds.upper].map(|corner| self.frame.mesh_from_world(corner));
        let farthest = corners[0].abs().max(corners[1].abs()).length();
        let beyond = 1.5 * deviation_of(&self.own, fewest, Fit::Circumscribed);
        let reach = farthest + self.map.stretch * beyond;
        let sums = self.here.anchor().base.length() + self.map.stretch * self.own.size();
        let corner = 2.0 * corner_error_of(&self.own, segments);
        let single = power_of_two(-24) * reach;
        let double = 16.0 * UNIT_ROUNDOFF * (reach + sums) + self.map.stretch * corner;
        (single + double) * (1.0 + power_of_two(-20)) + 2.0 * LEAST
    }

    /// The corners of a mesh of the solid's own space, rounded.
    fn placed(&self, mesh: &Mesh) -> Option<Vec<[f32; 3]>> {
        let base = self.here.anchor().base;
        let corners = mesh.vertices.iter();
        let vertices: Vec<[f32; 3]> = corners
            .map(|&corner| rounded(base + self.map.matrix * corner))
            .collect();
        let is_legal = |vertex: &[f32; 3]| vertex.iter().all(|x| x.abs() < GREATEST_COORDINATE);
        vertices.iter().all(is_legal).then_some(vertices)
    }

    fn hull(&self, mesh: Mesh, vertices: Vec<[f32; 3]>) -> Hull {
        let mut triangles = mesh.triangles;
        if self.map.is_mirrored {
            for [_, b, c] in &mut triangles {
                std::mem::swap(b, c);
            }
        }
        Hull {
            vertices,
            triangles,
        }
    }

    fn proven<'c>(&self, cell: &'c mut Option<Proven>) -> &'c Proven {
        cell.get_or_insert_with(|| Proven::new(self.placed))
    }

    fn in_world(&self, vertex: [f32; 3]) -> ExactVector {
        self.frame.exact_world_from_mesh(wide(vertex))
    }

    fn inside(&self, segments: u32, margin: f64) -> Option<Hull> {
        let shrunk = displaced(&self.own, -margin)?;
        let mesh = mesh_of(&shrunk, segments, Fit::Inscribed);
        let vertices = self.placed(&mesh)?;
        let mut exactly = None;
        let are_inside = vertices.iter().all(|&vertex| {
            self.here.surely_contains(wide(vertex))
                || self.proven(&mut exactly).contains(&self.in_world(vertex))
        });
        are_inside.then(|| self.hull(mesh, vertices))
    }

    fn around(&self, segments: u32, margin: f64) -> Option<Hull> {
        let grown = displaced(&self.own, margin)?;
        let mesh = mesh_of(&grown, segments, Fit::Circumscribed);
        let vertices = self.placed(&mesh)?;
        let hull = self.hull(mesh.clone(), vertices);
        self.is_around(&mesh, &hull).then_some(hull)
    }

    /// Whether a mesh is proven to be around the solid: `own` as it is before it is
    /// placed and rounded.
    fn is_around(&self, own: &Mesh, hull: &Hull) -> bool {
        let mut exactly = None;
        let mut is_closed = false;
        let mut triangles = own.triangles.iter().zip(&hull.triangles);
        let are_beyond = triangles.all(|(facet, corners)| {
            let [a, b, c] = facet.map(|i| own.vertices[i as usize]);
            let m = (b - a).cross(c - a).normalize_or_zero();
            let corners = corners.map(|i| hull.vertices[i as usize]);
            let is_beyond = corners.iter().all(|&vertex| {
                self.here.is_surely_beyond(wide(vertex), m)
                    || self
                        .proven(&mut exactly)
                        .is_beyond(&self.in_world(vertex), m)
            });
            if is_beyond && self.here.is_surely_around_middle(corners.map(wide)) {
                is_closed = true;
                return true;
            }
            let world = || corners.map(|vertex| self.in_world(vertex));
            is_beyond
                && match self.proven(&mut exactly).is_around_middle(&world()) {
                    None => true,
                    Some(is_around) => {
                        is_closed |= is_around;
                        is_around
                    }
                }
        });
        are_beyond && is_closed
    }

    /// The sheets above and below a disk with this radius and unit normal.
    fn sheets(&self, (radius, up): (f64, DVec3), segments: u32, margin: f64) -> Option<Hull> {
        let radius = radius - margin;
        // Rounding moves a sheet by at most one margin, and another one separates them.
        let sheet = |side: f64| {
            let (center, normal) = (up * (side * 2.0 * margin), up * side);
            let sheet = Disk::new(center, normal, radius).ok()?;
            Some(mesh_of(&sheet.into(), segments, Fit::Inscribed))
        };
        let mut mesh = sheet(1.0)?;
        let of_one = mesh.vertices.len();
        mesh.append(&sheet(-1.0)?);
        let vertices = self.placed(&mesh)?;
        let mut exactly = None;
        let are_there = vertices.iter().zip(0..).all(|(&vertex, number)| {
            let side = if number < of_one { 1.0 } else { -1.0 };
            self.here.is_surely_on_side(wide(vertex), side)
                || self
                    .proven(&mut exactly)
                    .side_of_disk(&self.in_world(vertex))
                    == Some(side)
        });
        are_there.then(|| self.hull(mesh, vertices))
    }
}

/// A vertex in f32.
fn rounded(vertex: DVec3) -> [f32; 3] {
    let nearest = |x: f64| if x.abs() < LEAST { 0.0 } else { x as f32 };
    vertex.to_array().map(nearest)
}

/// A point of f32 numbers in f64.
pub(crate) fn wide(vertex: [f32; 3]) -> DVec3 {
    DVec3::from_array(vertex.map(f64::from))
}
