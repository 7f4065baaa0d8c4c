//! Pictures of the scene and of its mesh, and of their differences.
//!
//! The mesh consists of the inscribed meshes of the solids that the picture's own rays
//! hit. An inscribed mesh is inside its solid, so a ray hits the meshes
//! of no other solids, and the picture is that of the whole scene's mesh
//! (up to the first [`DEPTHS`] solids on a ray).
//! Compositions have no mesh of their own: where one is hit first, only the picture of the
//! solids shows it.
//!
//! A difference in `t` is shown in units of the chord error. In the solid's own
//! space, displacing a wall with the unit normal `n` by the sagitta `s` shifts the hit of a
//! ray with direction `d` by `s/|n·d|`. `t` is the same
//! there as in the world, so the unit is `s/|n·d|` for any placement. A cuboid is
//! its own mesh, with a chord error of 0.

use std::collections::HashMap;

use glam::{DAffine3, DVec2, DVec3};
use rayon::prelude::*;

use crate::external::traced_mesh::{TracedMesh, TriangleHit};
use crate::solids::scene_solid::{SceneSolid, find};
use cyltrace::math::Ray;
use cyltrace::scene::{AimedCamera, Film, MaterialIndex, Scene};
use cyltrace::solid::tessellation::{Fit, Mesh, deviation_of, mesh_of, mesh_size_of};
use cyltrace::solid::{AnySolid, SolidKind};
use cyltrace::tracer::{DEFAULT_BATCH, HitFields, PartialHit, Tracer};
use cyltrace_output::{png_bytes, srgb_encode};

/// Numbers of solids along a ray that the mesh contains: the first one that fits into the
/// memory.
const DEPTHS: [usize; 4] = [8, 4, 2, 1];

/// Hits along a ray that are examined.
const MOST_HITS: usize = 64;

/// At least the bytes of a triangle with its share of vertices and of the tree.
const TRIANGLE_BYTES: u64 = 200;

/// Pictures as the bytes of PNG files.
#[derive(Clone, Debug)]
pub(super) struct Pictures {
    /// The solids.
    pub analytic: Vec<u8>,
    /// The meshes.
    pub mesh: Vec<u8>,
    /// The mesh's `t` minus the exact one, in units of the chord error: blue
    /// before, red behind.
    pub distance: Vec<u8>,
    /// The angle between the normals, in units of π/N.
    pub normal: Vec<u8>,
    /// Sides of the meshes.
    pub segments: u32,
    /// Solids in the mesh.
    pub solids: usize,
    /// Pixels in which both are hit, in which the solids alone are, and the mesh
    /// alone.
    pub counts: [u64; 3],
    /// Pixels in which a composition is hit first, which has no mesh.
    pub composed: u64,
}

/// Why there are no pictures.
#[derive(Debug, thiserror::Error)]
pub enum PicturesError {
    /// The encoder failed.
    #[error("cannot encode a picture: {0}")]
    Encoding(String),
}

/// A solid by its path and its number.
type Key = (Vec<u32>, u32);

/// A placed solid.
struct Placed {
    solid: AnySolid,
    object_from_world: DAffine3,
    world_from_object: DAffine3,
    color: DVec3,
}

/// Draws the scene of `tracer` from its own camera, in the rayon pool that this is
/// called in. `None` if the meshes do not fit into the memory.
///
/// # Errors
/// If the encoder fails.
pub(super) fn pictures(
    tracer: &Tracer,
    segments: u32,
    film: Film,
    max_memory: u64,
) -> Result<Option<Pictures>, PicturesError> {
    let camera = AimedCamera::new(&tracer.scene().camera, &tracer.bounds(), film);
    let pixels: Vec<(Ray, Vec<Seen>)> = (0..film.width * film.height)
        .into_par_iter()
        .map(|pixel| {
            let at = DVec2::new(
                f64::from(pixel % film.width) + 0.5,
                f64::from(pixel / film.width) + 0.5,
            );
            let ray = camera.ray(at);
            (ray, first_of_each_solid(tracer, &ray))
        })
        .collect();
    let Some(solids) = chosen(tracer.scene(), &pixels, segments, max_memory) else {
        return Ok(None);
    };
    let mut mesh = Mesh::default();
    let mut solid_of = Vec::new();
    let mut ordered: Vec<(&Key, &Placed)> = solids.iter().collect();
    ordered.sort_by_key(|(key, _)| *key);
    for (_, solid) in &ordered {
        let mut own = mesh_of(&solid.solid, segments, Fit::Inscribed);
        for vertex in &mut own.vertices {
            *vertex = solid.world_from_object.transform_point3(*vertex);
        }
        solid_of.extend(own.triangles.iter().map(|_| *solid));
        mesh.append(&own);
    }
    let traced = TracedMesh::new(&mesh);
    let shown: Vec<Shown> = pixels
        .par_iter()
        .map(|(ray, hits)| {
            if let Some(hit) = hits.first().filter(|hit| hit.is_composed()) {
                let color = color_of(tracer.scene(), hit);
                return Shown::composition(shade(color, hit.normal, ray));
            }
            let exact = hits.first().and_then(|hit| {
                let solid = solids.get(&hit.key)?;
                Some((hit, solid))
            });
            let found = traced.closest(ray);
            let color = |hit: &TriangleHit| solid_of[hit.triangle as usize].color;
            Shown::of(ray, exact, found.map(|hit| (hit, color(&hit))), segments)
        })
        .collect();
    let encode = |of: fn(&Shown) -> [u8; 4]| {
        let pixels: Vec<[u8; 4]> = shown.iter().map(of).collect();
        png_bytes(film.width, film.height, &pixels)
            .map_err(|error| PicturesError::Encoding(error.to_string()))
    };
    let count = |case: usize| {
        shown
            .iter()
            .filter(|shown| shown.case == Some(case))
            .count() as u64
    };
    Ok(Some(Pictures {
        analytic: encode(|shown| shown.analytic)?,
        mesh: encode(|shown| shown.mesh)?,
        distance: encode(|shown| shown.distance)?,
        normal: encode(|shown| shown.normal)?,
        segments,
        solids: ordered.len(),
        counts: [0, 1, 2].map(count),
        composed: count(COMPOSED),
    }))
}

/// A hit as the pictures need it.
struct Seen {
    t: f64,
    normal: DVec3,
    key: Key,
    kind: SolidKind,
    material: MaterialIndex,
}

impl Seen {
    const FIELDS: HitFields = HitFields::NORMAL.union(HitFields::PATH);

    /// `None` unless the hit has these fields.
    fn new(hit: &PartialHit) -> Option<Self> {
        Some(Self {
            t: hit.t(),
            normal: hit.normal()?,
            key: (hit.instance()?.to_vec(), hit.primitive()),
            kind: hit.solid(),
            material: hit.material(),
        })
    }

    fn is_composed(&self) -> bool {
        use SolidKind::{Difference, Intersection, Union};
        matches!(self.kind, Union | Intersection | Difference)
    }
}

/// The first hit with each of the first solids along a ray.
fn first_of_each_solid(tracer: &Tracer, ray: &Ray) -> Vec<Seen> {
    let mut hits: Vec<Seen> = Vec::new();
    let all = tracer.all_hits(ray, DEFAULT_BATCH).with(Seen::FIELDS);
    for hit in all.take(MOST_HITS).filter_map(|hit| Seen::new(&hit)) {
        if hits.iter().all(|known| known.key != hit.key) {
            hits.push(hit);
            if hits.len() == DEPTHS[0] {
                break;
            }
        }
    }
    hits
}

/// The solids of the mesh; `None` if there are none, or if even the first ones on each
/// ray take more than `max_memory`.
fn chosen(
    scene: &Scene,
    pixels: &[(Ray, Vec<Seen>)],
    segments: u32,
    max_memory: u64,
) -> Option<HashMap<Key, Placed>> {
    let most = max_memory / TRIANGLE_BYTES;
    DEPTHS.into_iter().find_map(|depth| {
        let mut solids = HashMap::new();
        for (_, hits) in pixels {
            for hit in hits.iter().take(depth).filter(|hit| !hit.is_composed()) {
                solids
                    .entry(hit.key.clone())
                    .or_insert_with(|| placed(scene, hit));
            }
        }
        let sizes = solids
            .values()
            .map(|placed| mesh_size_of(&placed.solid, segments).1);
        let triangles: u64 = sizes.sum();
        (!solids.is_empty() && triangles <= most).then_some(solids)
    })
}

/// The solid of a hit.
fn placed(scene: &Scene, hit: &Seen) -> Placed {
    let (instance, number) = &hit.key;
    let (placements, solid) = find(scene, instance, *number);
    let SceneSolid::Single(solid) = solid else {
        unreachable!("compositions have no mesh");
    };
    let identity = DAffine3::IDENTITY;
    let world_from_object = placements.iter().fold(identity, |whole, &one| whole * *one);
    Placed {
        solid,
        object_from_world: world_from_object.inverse(),
        world_from_object,
        color: color_of(scene, hit),
    }
}

fn color_of(scene: &Scene, hit: &Seen) -> DVec3 {
    scene.materials[usize::from(hit.material.0)].color.average()
}

const NOTHING: [u8; 4] = [0; 4];
/// The mesh is missed where a solid is hit.
const SOLID_ALONE: [u8; 4] = [0xe6, 0x9f, 0x00, 0xff];
/// The mesh is hit where nothing is.
const MESH_ALONE: [u8; 4] = [0x9b, 0x30, 0xff, 0xff];

/// A composition is hit first.
const COMPOSED: usize = 3;

/// A pixel of each picture.
struct Shown {
    analytic: [u8; 4],
    mesh: [u8; 4],
    distance: [u8; 4],
    normal: [u8; 4],
    /// 0: both hit; 1: the solid alone; 2: the mesh alone; or [`COMPOSED`].
    case: Option<usize>,
}

impl Shown {
    /// A hit of a composition, which has no mesh.
    fn composition(analytic: [u8; 4]) -> Self {
        Self {
            analytic,
            mesh: NOTHING,
            distance: NOTHING,
            normal: NOTHING,
            case: Some(COMPOSED),
        }
    }

    fn of(
        ray: &Ray,
        exact: Option<(&Seen, &Placed)>,
        found: Option<(TriangleHit, DVec3)>,
        segments: u32,
    ) -> Self {
        let mesh = found.map_or(NOTHING, |(hit, color)| shade(color, hit.normal, ray));
        let analytic = exact.map_or(NOTHING, |(hit, solid)| shade(solid.color, hit.normal, ray));
        let (distance, normal, case) = match (exact, found) {
            (None, None) => (NOTHING, NOTHING, None),
            (Some(_), None) => (SOLID_ALONE, SOLID_ALONE, Some(1)),
            (None, Some(_)) => (MESH_ALONE, MESH_ALONE, Some(2)),
            (Some((hit, solid)), Some((triangle, _))) => {
                let chord = chord_error(ray, hit, solid, segments);
                let chords = if chord > 0.0 {
                    (triangle.t - hit.t) / chord
                } else {
                    0.0
                };
                let cos = hit.normal.dot(triangle.normal).abs().min(1.0);
                let angles = libm::acos(cos) * f64::from(segments) / std::f64::consts::PI;
                (
                    heat(chords, [0xd7, 0x30, 0x27], [0x1f, 0x66, 0xc8]),
                    heat(angles, [0xb0, 0x3a, 0x9d], [0xb0, 0x3a, 0x9d]),
                    Some(0),
                )
            }
        };
        Self {
            analytic,
            mesh,
            distance,
            normal,
            case,
        }
    }
}

/// By how much `t` may differ to first order; see the head of this file.
fn chord_error(ray: &Ray, hit: &Seen, solid: &Placed, segments: u32) -> f64 {
    let direction = solid.object_from_world.transform_vector3(ray.direction);
    let normal = solid.world_from_object.matrix3.transpose() * hit.normal;
    deviation_of(&solid.solid, segments, Fit::Inscribed) / normal.normalize().dot(direction).abs()
}

/// A color under a lamp at the eye.
fn shade(color: DVec3, normal: DVec3, ray: &Ray) -> [u8; 4] {
    let light = 0.1 + 0.9 * normal.dot(ray.direction.normalize()).abs();
    let [r, g, b] = (color * light).to_array().map(|x| srgb_encode(x as f32));
    [r, g, b, 0xff]
}

/// A value from -1 to 1 as a color's opacity, visible on light and dark backgrounds.
fn heat(value: f64, above: [u8; 3], below: [u8; 3]) -> [u8; 4] {
    let [r, g, b] = if value < 0.0 { below } else { above };
    let opacity = 24.0 + 231.0 * value.abs().min(1.0);
    [r, g, b, opacity as u8]
}
