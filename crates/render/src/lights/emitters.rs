//! Solids that emit light, as lights that a surface samples.
//!
//! Every direction from a point outside a convex box into it enters through one of the faces
//! turned to the point. Samples are uniform on those faces, by area, so that a direction that
//! enters through a face at the distance `d` and the cosine `c` has the density `d² / (A c)`,
//! with `A` the area of all faces turned to the point. The ray in that direction may miss the
//! solid in its box; then it contributes nothing. That is true of solids of all kinds, composed
//! ones too, and for all placements, which map boxes to parallelepipeds.

use std::collections::HashMap;
use std::f64::consts::PI;

use cyltrace::math::Bounds;
use cyltrace::scene::{Material, MaterialIndex, MaterialKind, PrototypeIndex, Scene};
use cyltrace::solid::AnySolid;
use cyltrace::tracer::PartialHit;
use glam::{DAffine3, DMat3, DVec3};

/// Most solids that are sampled as lights. More are seen only by the rays that hit them, which
/// is as exact and noisier.
const MOST_EMITTERS: usize = 1 << 16;

/// The placed solids that emit light.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    pub list: Vec<Emitter>,
    /// The numbers of solids by their placements and primitive.
    numbers: HashMap<(Vec<u32>, u32), u32>,
    /// Whether there are more than [`MOST_EMITTERS`]. Then the list is empty.
    pub are_too_many: bool,
}

/// A placed solid that emits light.
#[derive(Clone, Debug)]
pub(super) struct Emitter {
    /// The middle of its box.
    center: DVec3,
    /// Half of the edges of its box.
    half_edges: DMat3,
    radiance: DVec3,
}

/// The solids that emit light in one prototype.
struct Emitting {
    /// Number, material and box of each.
    solids: Vec<(u32, MaterialIndex, Bounds)>,
    /// Whether it or a prototype that it places has any.
    is_any: bool,
}

impl Emitters {
    pub fn new(scene: &Scene) -> Self {
        let mut emitters = Self::default();
        let radiance: Vec<_> = scene.materials.iter().map(radiance).collect();
        if radiance.iter().all(Option::is_none) {
            return emitters;
        }
        let is_light = |material: MaterialIndex| radiance[usize::from(material.0)].is_some();
        let prototypes = scene.prototypes.iter();
        let solids = prototypes.map(|prototype| prototype.solids.of_materials(is_light));
        let mut emitting: Vec<_> = solids
            .map(|solids| Emitting {
                is_any: !solids.is_empty(),
                solids,
            })
            .collect();
        spread(scene, &mut emitting);
        let (root, identity) = (PrototypeIndex::ROOT, DAffine3::IDENTITY);
        let walk = Walk {
            scene,
            emitting: &emitting,
            radiance: &radiance,
        };
        walk.add(&mut emitters, root, &mut Vec::new(), &identity);
        if emitters.are_too_many {
            emitters.list.clear();
            emitters.numbers.clear();
        }
        emitters
    }

    /// Whether solids emit light.
    pub fn are_any(&self) -> bool {
        self.are_too_many || !self.list.is_empty()
    }

    /// The number of the emitter that a hit is on.
    pub fn number(&self, hit: &PartialHit) -> Option<usize> {
        if self.list.is_empty() {
            return None;
        }
        let key = (hit.instance()?.to_vec(), hit.primitive());
        self.numbers.get(&key).map(|&number| number as usize)
    }
}

/// Marks the prototypes that place one with emitting solids. Each round reaches one level.
fn spread(scene: &Scene, emitting: &mut [Emitting]) {
    loop {
        let mut is_changed = false;
        for (number, prototype) in scene.prototypes.iter().enumerate() {
            let placed = prototype.placed();
            if !emitting[number].is_any
                && placed
                    .iter()
                    .any(|placed| emitting[placed.of.0 as usize].is_any)
            {
                emitting[number].is_any = true;
                is_changed = true;
            }
        }
        if !is_changed {
            return;
        }
    }
}

/// What the walk over all placements reads.
struct Walk<'a> {
    scene: &'a Scene,
    emitting: &'a [Emitting],
    radiance: &'a [Option<DVec3>],
}

impl Walk<'_> {
    /// Adds the solids of a prototype and of those that it places.
    fn add(
        &self,
        emitters: &mut Emitters,
        index: PrototypeIndex,
        path: &mut Vec<u32>,
        world_from_object: &DAffine3,
    ) {
        let emitting = &self.emitting[index.0 as usize];
        if emitters.are_too_many || !emitting.is_any {
            return;
        }
        if emitters.list.len() + emitting.solids.len() > MOST_EMITTERS {
            emitters.are_too_many = true;
            return;
        }
        let prototype = &self.scene.prototypes[index.0 as usize];
        for &(primitive, material, bounds) in &emitting.solids {
            let solid = prototype.solids.find_simple(primitive);
            let (center, half_edges) = match solid.as_ref().and_then(box_along) {
                Some(aligned) => aligned,
                None => (bounds.center(), DMat3::from_diagonal(bounds.extent() * 0.5)),
            };
            let number = emitters.list.len() as u32;
            emitters.numbers.insert((path.clone(), primitive), number);
            emitters.list.push(Emitter {
                center: world_from_object.transform_point3(center),
                half_edges: world_from_object.matrix3 * half_edges,
                radiance: self.radiance[usize::from(material.0)].unwrap_or_default(),
            });
        }
        for (number, placement) in (0..).zip(&prototype.placements) {
            path.push(number);
            let placed = *world_from_object * placement.parent_from_child;
            self.add(emitters, placement.of, path, &placed);
            path.pop();
        }
    }
}

/// What a material emits, if it emits light.
fn radiance(material: &Material) -> Option<DVec3> {
    match material.kind {
        MaterialKind::Light { strength } => {
            let radiance = material.color.average() * strength;
            (radiance != DVec3::ZERO).then_some(radiance)
        }
        _ => None,
    }
}

/// The middle and half of the edges of a box along the axis of a solid that has one.
fn box_along(solid: &AnySolid) -> Option<(DVec3, DMat3)> {
    let (p0, p1, radius, rounding) = match solid {
        AnySolid::Cylinder(one) => (one.p0(), one.p1(), one.radius(), 0.0),
        AnySolid::Cone(one) => (one.p0(), one.p1(), one.radius0().max(one.radius1()), 0.0),
        AnySolid::RoundedCone(one) => {
            let radius = one.radius0().max(one.radius1());
            (one.p0(), one.p1(), radius, radius)
        }
        _ => return None,
    };
    let half_axis = (p1 - p0) * 0.5;
    let along = half_axis.normalize();
    let (right, up) = along.any_orthonormal_pair();
    let edges = DMat3::from_cols(right * radius, up * radius, half_axis + along * rounding);
    Some(((p0 + p1) * 0.5, edges))
}

impl Emitter {
    /// The radiant power, if the whole box emitted.
    pub fn power(&self) -> DVec3 {
        let areas = (0..3).map(|axis| self.area(axis).length());
        self.radiance * (2.0 * PI * areas.sum::<f64>())
    }

    /// The normal of the two faces across an edge, as long as their area.
    fn area(&self, axis: usize) -> DVec3 {
        let edges = &self.half_edges;
        let normal = edges.col((axis + 1) % 3).cross(edges.col((axis + 2) % 3)) * 4.0;
        // A placement that mirrors turns the cross product around.
        if normal.dot(edges.col(axis)) < 0.0 {
            -normal
        } else {
            normal
        }
    }

    /// For each axis, 1 or -1 for the face that is turned to a point, with its area, or 0.
    fn turned_to(&self, point: DVec3) -> [(f64, f64); 3] {
        let from_center = point - self.center;
        std::array::from_fn(|axis| {
            let normal = self.area(axis);
            let (height, half) = (
                normal.dot(from_center),
                normal.dot(self.half_edges.col(axis)),
            );
            match height.abs() > half {
                true => (height.signum(), normal.length()),
                false => (0.0, 0.0),
            }
        })
    }

    /// A unit direction into the box, and its density; `None` from inside the box.
    pub fn sample(&self, point: DVec3, (first, second): (f64, f64)) -> Option<(DVec3, f64)> {
        let faces = self.turned_to(point);
        let area: f64 = faces.iter().map(|face| face.1).sum();
        if area == 0.0 {
            return None;
        }
        let mut place = first * area;
        let mut axis = 0;
        while axis < 2 && place >= faces[axis].1 {
            place -= faces[axis].1;
            axis += 1;
        }
        let across = (place / faces[axis].1).min(1.0) * 2.0 - 1.0;
        let edges = &self.half_edges;
        let target = self.center
            + edges.col(axis) * faces[axis].0
            + edges.col((axis + 1) % 3) * across
            + edges.col((axis + 2) % 3) * (second * 2.0 - 1.0);
        let to_target = target - point;
        let squared = to_target.length_squared();
        let direction = to_target / squared.sqrt();
        let cosine = (self.area(axis).dot(direction) / faces[axis].1).abs();
        let density = squared / (area * cosine);
        density.is_finite().then_some((direction, density))
    }

    /// The density of samples in a unit direction.
    pub fn density(&self, point: DVec3, direction: DVec3) -> f64 {
        let faces = self.turned_to(point);
        let area: f64 = faces.iter().map(|face| face.1).sum();
        let from_center = point - self.center;
        // The ray enters the box through the face that it reaches last.
        let mut entry = (0.0, 0.0);
        for (axis, (side, face)) in faces.into_iter().enumerate() {
            if side == 0.0 {
                continue;
            }
            let normal = self.area(axis);
            let half = normal.dot(self.half_edges.col(axis)) * side;
            let rate = normal.dot(direction);
            let distance = (half - normal.dot(from_center)) / rate;
            if distance > entry.0 {
                entry = (distance, rate.abs() / face);
            }
        }
        match entry.1 > 0.0 {
            true => entry.0 * entry.0 / (area * entry.1),
            false => 0.0,
        }
    }
}
