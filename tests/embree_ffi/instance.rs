//! Embree's own instances.

use std::sync::Arc;

use cyltrace::embree::{
    Box32, Coherence, Device, DeviceOptions, Error, GREATEST_PACKET, GeometryId, NativeHit,
    PacketWidth, Query, Ray32, RaySet, Rays32, Reached, Scene, SceneBuilder, UserGeometry,
};

const IDENTITY: [[f32; 4]; 3] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
];

fn device() -> Device {
    Device::new(&DeviceOptions::default()).unwrap()
}

fn builder(device: &Device) -> SceneBuilder<()> {
    SceneBuilder::new(device).unwrap()
}

/// A triangle around the z axis at z = 1, as the second geometry.
fn triangle(device: &Device) -> Arc<Scene<()>> {
    let mut builder = builder(device);
    builder.attach_triangles(&[], &[]).unwrap();
    let corners = [[-1.0, -1.0, 1.0], [3.0, -1.0, 1.0], [-1.0, 3.0, 1.0]];
    builder.attach_triangles(&corners, &[[0, 1, 2]]).unwrap();
    Arc::new(builder.commit().unwrap())
}

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray32 {
    Ray32 {
        origin,
        direction,
        t_near: 0.0,
        t_far: f32::INFINITY,
    }
}

fn is_near(found: f32, expected: f32) -> bool {
    (found - expected).abs() <= 1e-5 * (1.0 + expected.abs())
}

#[test]
fn instance_map_is_rows_and_hits_name_the_instance() {
    let device = device();
    let child = triangle(&device);
    let mut builder = builder(&device);
    let silent = builder.attach_triangles(&[], &[]).unwrap();
    // x to 2y, y to 3z, z to 4x, then a shift.
    let turned = [
        [0.0, 0.0, 4.0, 10.0],
        [2.0, 0.0, 0.0, 20.0],
        [0.0, 3.0, 0.0, 30.0],
    ];
    let first = builder.attach_instance(&child, &turned).unwrap();
    let second = builder.attach_instance(&child, &IDENTITY).unwrap();
    assert_eq!(
        [silent, first, second],
        [GeometryId(0), GeometryId(1), GeometryId(2)]
    );
    // The instances keep it.
    drop(child);
    let scene = builder.commit().unwrap();
    let bounds = scene.bounds().unwrap();
    assert!(is_near(bounds.upper[1], 26.0) && is_near(bounds.upper[2], 39.0));

    // The triangle's plane z = 1 is x = 14 there.
    let along = ray([0.0, 20.0, 30.0], [0.5, 0.0, 0.0]);
    let hit = scene.closest_native(&along, &mut ()).unwrap();
    assert_eq!(
        (hit.instance, hit.geometry, hit.primitive),
        (Some(first), GeometryId(1), 0)
    );
    assert!(is_near(hit.t, 28.0), "{hit:?}");
    assert!(scene.any(&along, &mut ()));
    let up = ray([0.0; 3], [0.0, 0.0, 1.0]);
    let hit = scene.closest_native(&up, &mut ()).unwrap();
    assert_eq!(hit.instance, Some(second));
    assert!(!scene.any(&ray([5.0; 3], [0.0, 0.0, 1.0]), &mut ()));
}

/// A box with its lower side at z = `.0`.
struct Slab(f32);

impl UserGeometry for Slab {
    type Query = ();

    fn primitive_count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Box32 {
        Box32 {
            lower: [-1.0, -1.0, self.0],
            upper: [1.0, 1.0, self.0 + 1.0],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, (): &mut ()) -> Option<f32> {
        Some(self.0)
    }

    fn occluded(&self, _: Reached, _: &Ray32, (): &mut ()) -> bool {
        true
    }

    fn intersect_packet(
        &self,
        _: Reached,
        rays: RaySet,
        _: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        (): &mut (),
    ) -> RaySet {
        *t_far = [self.0; _];
        rays
    }

    fn occluded_packet(&self, _: Reached, rays: RaySet, _: &Rays32, (): &mut ()) -> RaySet {
        rays
    }
}

#[test]
fn instance_with_user_geometry_in_it_blocks_a_packet() {
    let device = device();
    let mut child = builder(&device);
    child.attach_user(Slab(2.0)).unwrap();
    let child = Arc::new(child.commit().unwrap());
    let mut parent = builder(&device);
    parent.attach_instance(&child, &IDENTITY).unwrap();
    let scene = parent.commit().unwrap();
    let rays = Rays32 {
        origin: [[0.0; _]; 3],
        direction: [[0.0; _], [0.0; _], [1.0; _]],
        t_far: [f32::INFINITY; _],
    };
    let active = RaySet::from_bits(0x7BDF);
    for width in PacketWidth::ALL {
        let any = scene.any_packet(&rays, active, width, Coherence::Incoherent, &mut ());
        assert_eq!(any, active, "{width:?}");
    }
}

#[test]
fn instance_is_told_with_user_geometry_in_it_and_not_with_one_before_it() {
    let device = device();
    let up = ray([0.0; 3], [0.0, 0.0, 1.0]);
    let hit_of = |parent: SceneBuilder<()>| {
        let scene = parent.commit().unwrap();
        let NativeHit { t, instance, .. } = scene.closest_native(&up, &mut ()).unwrap();
        (t, instance)
    };
    let mut child = builder(&device);
    child.attach_user(Slab(2.0)).unwrap();
    let child = Arc::new(child.commit().unwrap());
    let mut parent = builder(&device);
    parent.attach_instance(&child, &IDENTITY).unwrap();
    assert_eq!(hit_of(parent), (2.0, Some(GeometryId(0))));

    // Wherever the tree puts them, so that the triangle is found first in some.
    let child = triangle(&device);
    for slab_first in [true, false] {
        let mut parent = builder(&device);
        if slab_first {
            parent.attach_user(Slab(0.5)).unwrap();
        }
        parent.attach_instance(&child, &IDENTITY).unwrap();
        if !slab_first {
            parent.attach_user(Slab(0.5)).unwrap();
        }
        assert_eq!(hit_of(parent), (0.5, None), "slab first: {slab_first}");
    }
}

#[test]
fn instanced_scene_is_freed_with_the_last_that_holds_it() {
    let device = device();
    let child = triangle(&device);
    let watch = Arc::downgrade(&child);
    let mut unfinished = builder(&device);
    unfinished.attach_instance(&child, &IDENTITY).unwrap();
    let mut parent = builder(&device);
    parent.attach_instance(&child, &IDENTITY).unwrap();
    drop((child, unfinished));
    let parent = parent.commit().unwrap();
    assert!(watch.upgrade().is_some());
    drop(parent);
    assert!(watch.upgrade().is_none());
    assert_eq!(device.memory_bytes(), 0);
}

#[test]
fn instance_bad_input_is_refused_before_embree_sees_it() {
    let device = device();
    let child = triangle(&device);
    let mut parent = builder(&device);
    let mut refused = |row: [f32; 4]| {
        let map = [row, IDENTITY[1], IDENTITY[2]];
        let found = parent.attach_instance(&child, &map);
        assert!(matches!(found, Err(Error::InstanceMap { .. })), "{found:?}");
    };
    refused([f32::NAN, 0.0, 0.0, 0.0]);
    refused([1.0, 0.0, 0.0, f32::INFINITY]);
    refused([1.0, 0.0, 0.0, 1e19]);
    refused([0.0, 1.0, 0.0, 0.0]);
    refused([1e-40, 0.0, 0.0, 0.0]);
    assert_eq!(
        parent.attach_instance(&child, &IDENTITY),
        Ok(GeometryId(0)),
        "what was refused left nothing"
    );
    let parent = Arc::new(parent.commit().unwrap());
    let mut grandparent = builder(&device);
    assert_eq!(
        grandparent.attach_instance(&parent, &IDENTITY),
        Err(Error::NestedInstance)
    );
}

#[test]
fn instance_of_another_device_s_scene_is_refused() {
    let child = triangle(&device());
    let other = device();
    let found = builder(&other).attach_instance(&child, &IDENTITY);
    assert_eq!(found, Err(Error::OtherDevice));
}

/// The instances that callbacks were in, in order.
#[derive(Default)]
struct Visits(Vec<Option<GeometryId>>);

impl Query for Visits {
    type Packet = Self;
}

/// The unit cube, which says where it is reached and is never hit.
struct Witness;

impl UserGeometry for Witness {
    type Query = Visits;

    fn primitive_count(&self) -> u32 {
        1
    }

    fn bounds(&self, _: u32) -> Box32 {
        Box32 {
            lower: [0.0; 3],
            upper: [1.0; 3],
        }
    }

    fn intersect(&self, at: Reached, ray: &Ray32, visits: &mut Visits) -> Option<f32> {
        // Embree's ray is in the child's space: the instances below move by 10 each.
        assert!(ray.origin[0].abs() < 1.0, "{ray:?}");
        visits.0.push(at.instance);
        None
    }

    fn occluded(&self, at: Reached, ray: &Ray32, visits: &mut Visits) -> bool {
        self.intersect(at, ray, visits).is_some()
    }

    fn intersect_packet(
        &self,
        at: Reached,
        _: RaySet,
        _: &Rays32,
        _: &mut [f32; GREATEST_PACKET],
        visits: &mut Visits,
    ) -> RaySet {
        visits.0.push(at.instance);
        RaySet::EMPTY
    }

    fn occluded_packet(&self, at: Reached, _: RaySet, _: &Rays32, visits: &mut Visits) -> RaySet {
        visits.0.push(at.instance);
        RaySet::EMPTY
    }
}

#[test]
fn callbacks_learn_the_number_that_was_chosen_for_their_instance() {
    let device = device();
    let mut child = SceneBuilder::<Visits>::new(&device).unwrap();
    child.attach_user(Witness).unwrap();
    let child = Arc::new(child.commit().unwrap());
    let mut parent = SceneBuilder::<Visits>::new(&device).unwrap();
    let numbers = [7, 2, 1000].map(GeometryId);
    for (place, number) in numbers.into_iter().enumerate() {
        let mut map = IDENTITY;
        map[0][3] = 10.0 * (place as f32 + 1.0);
        parent.attach_instance_as(number, &child, &map).unwrap();
    }
    let taken = parent.attach_instance_as(GeometryId(7), &child, &IDENTITY);
    assert!(taken.is_err(), "{taken:?}");
    // Further geometry gets a number that is free.
    let further = parent.attach_instance(&child, &IDENTITY).unwrap();
    assert!(!numbers.contains(&further), "{further:?}");
    let scene = parent.commit().unwrap();

    let all = [further, numbers[0], numbers[1], numbers[2]];
    for (place, number) in all.into_iter().enumerate() {
        let expected = vec![Some(number)];
        let x = 10.0 * place as f32 + 0.5;
        let up = ray([x, 0.5, -1.0], [0.0, 0.0, 1.0]);
        let mut visits = Visits::default();
        scene.closest(&up, &mut visits);
        assert_eq!(visits.0, expected);
        visits.0.clear();
        assert!(!scene.any(&up, &mut visits));
        assert_eq!(visits.0, expected);
        let rays = Rays32 {
            origin: [[x; _], [0.5; _], [-1.0; _]],
            direction: [[0.0; _], [0.0; _], [1.0; _]],
            t_far: [f32::INFINITY; _],
        };
        for width in PacketWidth::ALL {
            let all = RaySet::first(width.rays());
            visits.0.clear();
            scene.closest_packet(&rays, all, width, Coherence::Incoherent, &mut visits);
            scene.any_packet(&rays, all, width, Coherence::Incoherent, &mut visits);
            assert!(!visits.0.is_empty(), "{width:?}");
            assert!(visits.0.iter().all(|one| *one == expected[0]), "{width:?}");
        }
    }
}
