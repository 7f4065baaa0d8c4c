//! Rivals that Embree intersects by itself, below its own instances where a scene has
//! placements.
//!
//! One Embree scene a prototype and one instance a place; a scene without
//! placements is traced without instances.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use super::flat::Flat;
use super::rays::{Kind, Rays};
use super::representation::{Met, Representative, SolidId};
use crate::rivals::Shape;
use cyltrace::embree::{
    Device, DeviceOptions, Error, NativeHit, PacketWidth, Ray32, Scene, SceneBuilder,
};
use cyltrace::scene::{Prototype, PrototypeIndex};
use cyltrace::solid::AnySolid;

/// Which solids the primitives of a prototype are.
struct Primitives {
    /// The first one of each solid.
    first: Vec<u32>,
    /// The solids' numbers.
    numbers: Vec<u32>,
}

impl Primitives {
    /// Of a prototype in which a solid becomes `count` primitives.
    fn new(prototype: &Prototype, count: impl Fn(&AnySolid) -> u64) -> Self {
        let mut next = 0;
        let (first, numbers) = prototype
            .singles()
            .map(|(number, solid)| {
                let first = next;
                next += count(&solid) as u32;
                (first, number)
            })
            .unzip();
        Self { first, numbers }
    }

    /// The number of the solid of a primitive.
    fn number(&self, primitive: u32) -> u32 {
        let after = self.first.partition_point(|&first| first <= primitive);
        self.numbers[after - 1]
    }
}

/// A scene as Embree traces it.
pub struct Native {
    device: Device,
    scene: Scene<()>,
    flat: Arc<Flat>,
    /// What Embree's primitives are, by prototype.
    primitives: HashMap<PrototypeIndex, Primitives>,
}

impl Native {
    /// Builds the scene.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(flat: &Arc<Flat>, shape: Shape, options: &DeviceOptions) -> Result<Self, Error> {
        let device = Device::new(options)?;
        let attach = |builder: &mut SceneBuilder<()>, prototype| {
            shape.attach(builder, flat.solids(prototype))
        };
        let mut builder = SceneBuilder::new(&device)?;
        if flat.has_placements() {
            let mut scenes = HashMap::new();
            for prototype in flat.prototypes() {
                let mut below = SceneBuilder::new(&device)?;
                attach(&mut below, prototype)?;
                scenes.insert(prototype, Arc::new(below.commit()?));
            }
            for placed in &flat.placed {
                let rows = rows_of(&placed.world_from_object);
                builder.attach_instance(&scenes[&placed.prototype], &rows)?;
            }
        } else if !flat.placed.is_empty() {
            attach(&mut builder, PrototypeIndex::ROOT)?;
        }
        let count = |solid: &AnySolid| shape.primitives(solid);
        let primitives = flat
            .prototypes()
            .into_iter()
            .map(|one| (one, Primitives::new(flat.prototype(one), count)))
            .collect();
        Ok(Self {
            device,
            scene: builder.commit()?,
            flat: Arc::clone(flat),
            primitives,
        })
    }

    /// How many rays Embree takes together, if it does.
    pub fn packet_width(&self) -> Option<PacketWidth> {
        self.device.packet_width()
    }

    /// Whether rays go through Embree's instances.
    pub fn has_instances(&self) -> bool {
        self.flat.has_placements()
    }

    /// Embree's scene.
    pub fn scene(&self) -> &Scene<()> {
        &self.scene
    }

    /// What a hit of Embree's is a hit of.
    pub fn met(&self, hit: &NativeHit) -> Met {
        // Instances are attached in the order of the places, and alone.
        let placed = hit.instance.map_or(0, |geometry| geometry.0);
        let prototype = self.flat.placed[placed as usize].prototype;
        Met {
            t: f64::from(hit.t),
            solid: SolidId {
                placed,
                primitive: self.primitives[&prototype].number(hit.primitive),
            },
        }
    }
}

/// The map in f32, by rows.
fn rows_of(map: &DAffine3) -> [[f32; 4]; 3] {
    [0, 1, 2].map(|row| {
        let matrix = map.matrix3.row(row).as_vec3();
        [matrix.x, matrix.y, matrix.z, map.translation[row] as f32]
    })
}

impl Representative for Native {
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>> {
        let met = |ray| Some(self.met(&self.scene.closest_native(ray, &mut ())?));
        rays.narrow[range].iter().map(met).collect()
    }

    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool> {
        let rays = rays.narrow[range].iter();
        rays.map(|ray| self.scene.any(ray, &mut ())).collect()
    }

    fn run(&self, rays: &Rays, range: Range<usize>) -> u64 {
        let asked = rays.narrow[range].iter();
        match rays.kind {
            Kind::Shadow => {
                let blocked = |ray: &Ray32| u64::from(self.scene.any(ray, &mut ()));
                asked.fold(0, |sum, ray| sum + blocked(ray))
            }
            Kind::Coherent | Kind::Incoherent => asked.fold(0, |sum: u64, ray| {
                let hit = self.scene.closest_native(ray, &mut ());
                sum + hit.map_or(0, |hit| u64::from(hit.t.to_bits()))
            }),
        }
    }

    fn bytes(&self) -> usize {
        self.device.memory_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::super::ours;
    use super::super::random_scene::{random_scene, sticks};
    use super::super::witness::Witness;
    use super::*;
    use cyltrace::solid::SolidKind;
    use cyltrace::tracer::Options;

    const SEED: u64 = 31;

    /// Rays with a wrong answer are few, and the others are off by no more than `most`
    /// radii, for all shapes that represent the solids of a scene.
    fn agrees(scene: cyltrace::scene::Scene, shapes: &[(Shape, f64)]) {
        let flat = Arc::new(Flat::new(Arc::new(scene)));
        let modes = ours::modes(&flat, &Options::default()).unwrap();
        let tracer = modes[0].1.tracer();
        let witness = Witness::new(&flat);
        for rays in Rays::of_scene(&flat, tracer, 2048, SEED) {
            let judged = witness.judge(&rays, 512);
            for &(shape, most) in shapes {
                let native = Native::new(&flat, shape, &DeviceOptions::default()).unwrap();
                let single = judged.errors(&native, &rays);
                let mut all = vec![single];
                if !matches!(shape, Shape::Mesh(_) | Shape::Faces) {
                    let packets = super::super::native_packets::by_packets(native).unwrap();
                    all.push(judged.errors(packets.as_ref(), &rays));
                }
                for errors in all {
                    let context = format!("{shape:?}, {} rays: {errors:?}", rays.kind.name());
                    assert!(errors.wrong_percent() < 2.0, "{context}");
                    assert!(errors.p99_r.is_none_or(|p99| p99 < most), "{context}");
                    assert_eq!(
                        errors.p99_r.is_none(),
                        rays.kind == Kind::Shadow,
                        "{context}"
                    );
                }
            }
        }
    }

    #[test]
    fn embree_s_own_solids_are_nearly_those_that_they_represent() {
        let of = |kind| random_scene(kind, 1000, SEED);
        agrees(
            sticks(1000, SEED),
            &[(Shape::Cone, 1e-2), (Shape::Mesh(64), 0.1)],
        );
        agrees(
            of(SolidKind::Cone),
            &[(Shape::Cone, 1e-2), (Shape::Mesh(64), 0.1)],
        );
        agrees(
            of(SolidKind::RoundedCone),
            &[(Shape::Round, 1e-2), (Shape::Mesh(64), 0.1)],
        );
        agrees(
            of(SolidKind::Sphere),
            &[(Shape::Sphere, 1e-2), (Shape::Mesh(64), 0.1)],
        );
        agrees(
            of(SolidKind::Disk),
            &[(Shape::Disk, 1e-2), (Shape::Mesh(64), 0.1)],
        );
        agrees(of(SolidKind::Cuboid), &[(Shape::Faces, 1e-2)]);
    }
}
