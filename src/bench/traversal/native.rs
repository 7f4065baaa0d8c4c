//! Rivals that Embree traces: what it intersects by itself, or C callbacks,
//! below its own instances where a scene has placements.
//!
//! One Embree scene a prototype and one instance a place; a scene without
//! placements is traced without instances.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use super::c_callback;
use super::flat::Flat;
use super::rays::{Kind, Rays};
use super::representation::{Met, Representative, SolidId};
use crate::bench::rivals::Shape;
use crate::embree::{
    Device, DeviceOptions, Error, NativeHit, PacketWidth, Ray32, Scene, SceneBuilder,
};
use crate::scene::PrototypeIndex;

/// What a prototype's cylinders become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solids {
    /// Geometry that Embree intersects by itself.
    Shape(Shape),
    /// User geometry with callbacks in C, on Embree's f32 ray.
    Narrow,
}

/// A scene as Embree traces it.
pub struct Native {
    device: Device,
    scene: Scene<()>,
    flat: Arc<Flat>,
    /// The first primitive of each cylinder, for prototypes in which a cylinder
    /// is several.
    first_primitives: HashMap<PrototypeIndex, Vec<u32>>,
    /// Bytes beside Embree's.
    records_bytes: usize,
}

impl Native {
    /// Builds the scene.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(flat: &Arc<Flat>, solids: Solids, options: &DeviceOptions) -> Result<Self, Error> {
        let device = Device::new(options)?;
        let attach = |builder: &mut SceneBuilder<()>, prototype| match solids {
            Solids::Shape(shape) => {
                let records = flat.cylinders(prototype).iter();
                shape.attach(builder, records.map(|record| record.cylinder()))
            }
            Solids::Narrow => c_callback::attach_narrow(builder, flat.cylinders(prototype)),
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
        let (first_primitives, records_bytes) = match solids {
            Solids::Shape(shape @ Shape::Mesh(_)) => {
                let prototypes = flat.prototypes().into_iter();
                let firsts = prototypes.map(|one| (one, first_primitives(flat, one, shape)));
                (firsts.collect(), 0)
            }
            Solids::Shape(Shape::Cone) => (HashMap::new(), 0),
            Solids::Narrow => (HashMap::new(), flat.stored() * c_callback::RECORD_BYTES),
        };
        Ok(Self {
            device,
            scene: builder.commit()?,
            flat: Arc::clone(flat),
            first_primitives,
            records_bytes,
        })
    }

    /// How many rays Embree takes together, if it does.
    pub fn packet_width(&self) -> Option<PacketWidth> {
        self.device.packet_width()
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
        let cylinder = match self.first_primitives.get(&prototype) {
            None => hit.primitive as usize,
            Some(firsts) => firsts.partition_point(|&first| first <= hit.primitive) - 1,
        };
        Met {
            t: f64::from(hit.t),
            solid: SolidId {
                placed,
                primitive: self.flat.cylinders(prototype).primitive(cylinder),
            },
        }
    }
}

fn first_primitives(flat: &Flat, prototype: PrototypeIndex, shape: Shape) -> Vec<u32> {
    let mut next = 0;
    let records = flat.cylinders(prototype).iter();
    records
        .map(|record| {
            let first = next;
            next += shape.primitives(record.cylinder().caps()) as u32;
            first
        })
        .collect()
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
        self.device.memory_bytes() + self.records_bytes
    }
}
