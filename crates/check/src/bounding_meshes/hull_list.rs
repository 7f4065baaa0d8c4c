//! The hulls of all solids of a window as one mesh, and the memory that it takes.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::hull::{Hull, hull, triangles_needed, wide};
use super::mesh_frame::MeshFrame;
use super::mesh_map::MeshMap;
use super::window::Window;
use cyltrace::solid::tessellation::Fit;

/// Solids that a thread builds at a time.
const CHUNK: usize = 256;

/// Bytes of a triangle with its share of the corners, in these lists and in
/// Embree. Measured with Embree 3.13.5 on struts of `scenes/lattice.toml`:
/// 96 with 16 sides, 94 with 64 and 90 with 512.
const BYTES_PER_TRIANGLE: u64 = 93;

/// Hulls as one mesh; every one is verified.
#[derive(Debug, Default)]
pub(crate) struct HullList {
    /// All of them, one after another.
    pub hull: Hull,
    /// The number of triangles up to the end of each solid's hull.
    triangles_up_to: Vec<u32>,
    /// Solids without a hull: f32 does not resolve them.
    pub missing: Vec<u32>,
}

impl HullList {
    fn add_triangles(&mut self, hull: &Hull) {
        let first = self.hull.vertices.len() as u32;
        let triangles = hull.triangles.iter();
        let shifted = triangles.map(|&corners| corners.map(|i| first + i));
        self.hull.triangles.extend(shifted);
        self.hull.vertices.extend_from_slice(&hull.vertices);
    }

    fn append(&mut self, other: &Self) {
        let triangles = self.hull.triangles.len() as u32;
        self.add_triangles(&other.hull);
        let ends = other.triangles_up_to.iter();
        self.triangles_up_to.extend(ends.map(|end| triangles + end));
        self.missing.extend_from_slice(&other.missing);
    }

    fn push(&mut self, solid: u32, hull: Option<&Hull>) {
        match hull {
            Some(hull) => self.add_triangles(hull),
            None => self.missing.push(solid),
        }
        self.triangles_up_to.push(self.hull.triangles.len() as u32);
    }

    /// The solid that a triangle belongs to.
    pub fn solid_of(&self, triangle: u32) -> u32 {
        let before = |&end: &u32| end <= triangle;
        self.triangles_up_to.partition_point(before) as u32
    }

    /// Whether a triangle is in the first half of those of its hull: for a disk, in the upper
    /// sheet.
    pub fn is_in_first_half(&self, triangle: u32) -> bool {
        let all = self.triangles_of(self.solid_of(triangle));
        2 * (triangle as usize - all.start) < all.len()
    }

    /// The triangles of a solid's hull; none without a hull.
    pub fn triangles_of(&self, solid: u32) -> Range<usize> {
        let end = |solid: u32| self.triangles_up_to[solid as usize] as usize;
        let start = solid.checked_sub(1).map_or(0, end);
        start..end(solid)
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let vertices = &self.hull.vertices;
        self.hull.triangles[triangle].map(|vertex| wide(vertices[vertex as usize]))
    }
}

/// The hulls of all solids of a window, with `segments` sides, at least 3. They have fewer
/// than 2^32 corners in all.
pub(crate) fn hulls(window: &Window, frame: &MeshFrame, segments: u32, side: Fit) -> HullList {
    assert!(segments >= 3, "a hull has at least 3 sides, not {segments}");
    let parts: Vec<HullList> = window
        .solids
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, solids)| {
            let mut part = HullList::default();
            let mut maps = None;
            for (placed, number) in solids.iter().zip((chunk * CHUNK) as u32..) {
                // Solids of one placement follow each other.
                let (_, map) = match &mut maps {
                    Some((place, map)) if Arc::ptr_eq(place, &placed.frame) => (place, map),
                    other => {
                        let map = MeshMap::new(frame, &placed.frame);
                        let (place, map) = other.insert((Arc::clone(&placed.frame), map));
                        (place, map)
                    }
                };
                let hull = hull(frame, map, placed, segments, side);
                part.push(number, hull.as_ref());
            }
            part
        })
        .collect();
    let count = |of: fn(&HullList) -> usize| parts.iter().map(of).sum::<usize>();
    let corners = count(|part| part.hull.vertices.len());
    assert!(
        corners <= u32::MAX as usize,
        "{corners} corners are too many for a mesh"
    );
    let mut all = HullList::default();
    all.hull.vertices.reserve_exact(corners);
    all.hull
        .triangles
        .reserve_exact(count(|part| part.hull.triangles.len()));
    for part in parts {
        all.append(&part);
    }
    all
}

/// Bytes of both meshes of a window with this number of triangles each, with Embree's
/// trees over them. While the second tree is built, Embree uses up to a third more of
/// its own.
pub(crate) fn bytes_needed(triangles: u64) -> u64 {
    triangles.saturating_mul(2 * BYTES_PER_TRIANGLE)
}

/// The triangles of either mesh that fit into this number of bytes, and that Embree can
/// count: no mesh has more corners than twice its triangles.
pub(crate) fn triangles_within(bytes: u64) -> u64 {
    (bytes / (2 * BYTES_PER_TRIANGLE)).min(u64::from(u32::MAX / 2))
}

/// Bytes of the meshes of a window.
pub(crate) fn window_bytes(window: &Window, segments: u32) -> u64 {
    let solids = window.solids.iter();
    let triangles = solids.map(|placed| triangles_needed(&placed.solid, segments));
    bytes_needed(triangles.sum())
}

#[cfg(test)]
mod tests;
