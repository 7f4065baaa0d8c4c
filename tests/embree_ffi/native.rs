//! Embree's own triangles, straight curves, spheres and disks.

use cyltrace::embree::{Device, DeviceOptions, Error, NativeHit, Ray32, SceneBuilder};

fn builder() -> SceneBuilder<()> {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    SceneBuilder::new(&device).unwrap()
}

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray32 {
    Ray32 {
        origin,
        direction,
        t_near: 0.0,
        t_far: f32::INFINITY,
    }
}

/// Embree's reciprocals are exact to a few ulps only.
fn is_near(found: f32, expected: f32) -> bool {
    (found - expected).abs() <= 1e-5 * (1.0 + expected.abs())
}

#[test]
fn triangles_ray_through_second_one_reports_all_of_the_hit() {
    let mut builder = builder();
    let vertices = [
        [0.0, 0.0, 2.0],
        [1.0, 0.0, 2.0],
        [0.0, 1.0, 2.0],
        [1.0, 1.0, 2.0],
    ];
    let empty = builder.attach_triangles(&[], &[]).unwrap();
    let mesh = builder
        .attach_triangles(&vertices, &[[0, 1, 2], [3, 2, 1]])
        .unwrap();
    assert_ne!(empty, mesh);
    let scene = builder.commit().unwrap();
    let bounds = scene.bounds().unwrap();
    assert_eq!(
        (bounds.lower, bounds.upper),
        ([0.0, 0.0, 2.0], [1.0, 1.0, 2.0])
    );

    let down = ray([0.875, 0.75, 4.0], [0.0, 0.0, -0.5]);
    let hit = scene.closest_native(&down, &mut ()).unwrap();
    let NativeHit {
        t, normal, u, v, ..
    } = hit;
    assert_eq!((hit.geometry, hit.primitive), (mesh, 1));
    assert!(is_near(t, 4.0), "{hit:?}");
    // u counts towards vertex 2, v towards vertex 1.
    assert!(is_near(u, 0.125) && is_near(v, 0.25), "{hit:?}");
    // Both run counter-clockwise seen from above.
    assert!(
        is_near(normal[2], 1.0) && normal[..2] == [0.0, 0.0],
        "{hit:?}"
    );

    assert!(scene.any(&down, &mut ()));
    let beside = ray([1.5, 0.5, 4.0], [0.0, 0.0, -0.5]);
    assert_eq!(scene.closest_native(&beside, &mut ()), None);
    assert!(!scene.any(&beside, &mut ()));
}

#[test]
fn triangles_last_vertex_at_end_of_buffer_is_read_right() {
    // Each vertex is read with 16 bytes; the last one's reach behind the array.
    for count in [3_u32, 4, 5, 1000] {
        let vertices: Vec<[f32; 3]> = (0..count)
            .map(|i| [i as f32, (i % 2) as f32, (i % 3) as f32])
            .collect();
        let mut builder = builder();
        builder
            .attach_triangles(&vertices, &[[count - 3, count - 2, count - 1]])
            .unwrap();
        let scene = builder.commit().unwrap();
        let bounds = scene.bounds().unwrap();
        assert_eq!(bounds.lower[0], (count - 3) as f32);
        assert_eq!(bounds.upper[0], (count - 1) as f32);
    }
}

#[test]
fn triangles_bad_input_is_refused_before_embree_sees_it() {
    let corner = [[0.0; 3], [1.0; 3], [f32::NAN, 0.0, 0.0]];
    let mut builder = builder();
    let bad_vertex = builder.attach_triangles(&corner, &[]).unwrap_err();
    assert!(
        bad_vertex
            .to_string()
            .starts_with("vertex 2 is [NaN, 0.0, 0.0]")
    );
    let bad_index = builder.attach_triangles(&[[0.0; 3]; 3], &[[0, 1, 2], [0, 3, 1]]);
    assert_eq!(
        bad_index,
        Err(Error::VertexIndex {
            primitive: 1,
            vertex: 3,
            vertices: 3
        })
    );
    assert_eq!(builder.commit().unwrap().bounds(), None);
}

#[test]
fn cone_curves_unit_ray_hits_wall_and_cap() {
    let mut builder = builder();
    let empty = builder.attach_cone_curves(&[], &[], None).unwrap();
    let vertices = [
        [9.0, 9.0, 9.0, 1.0],
        [0.0, 0.0, 0.0, 0.5],
        [0.0, 0.0, 2.0, 0.5],
    ];
    let curves = builder.attach_cone_curves(&vertices, &[1], None).unwrap();
    assert_ne!(empty, curves);
    let scene = builder.commit().unwrap();

    let side = ray([-3.0, 0.0, 0.5], [1.0, 0.0, 0.0]);
    let hit = scene.closest_native(&side, &mut ()).unwrap();
    assert_eq!((hit.geometry, hit.primitive), (curves, 0));
    assert!(is_near(hit.t, 2.5) && is_near(hit.u, 0.25), "{hit:?}");
    assert!(hit.normal[0] < 0.0, "{hit:?}");

    let cap = ray([0.1, 0.2, 5.0], [0.0, 0.0, -1.0]);
    let hit = scene.closest_native(&cap, &mut ()).unwrap();
    assert!(is_near(hit.t, 3.0) && hit.normal[2] > 0.0, "{hit:?}");
    assert!(scene.any(&cap, &mut ()));
    assert!(!scene.any(&ray([-3.0, 0.0, 2.5], [1.0, 0.0, 0.0]), &mut ()));
}

#[test]
fn cone_curves_end_with_neighbour_has_no_cap() {
    let vertices = [[0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 2.0, 0.5]];
    let along = ray([0.1, 0.2, 5.0], [0.0, 0.0, -1.0]);
    let mut builder = builder();
    builder
        .attach_cone_curves(&vertices, &[0], Some(&[3]))
        .unwrap();
    let scene = builder.commit().unwrap();
    assert_eq!(scene.closest_native(&along, &mut ()), None);
}

#[test]
fn cone_curves_every_hit_enters_and_leaves_each_segment() {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let mut builder = SceneBuilder::<Vec<NativeHit>>::new(&device).unwrap();
    let vertices = [
        [0.0, 0.0, 0.0, 0.5],
        [0.0, 0.0, 2.0, 0.5],
        [3.0, 0.0, 0.0, 0.25],
        [3.0, 0.0, 2.0, 0.25],
    ];
    let curves = builder
        .attach_collecting_cone_curves(&vertices, &[0, 2], None)
        .unwrap();
    let scene = builder.commit().unwrap();
    let mut hits = vec![];
    scene.every_hit(&ray([-3.0, 0.0, 0.5], [1.0, 0.0, 0.0]), &mut hits);
    assert_eq!(hits.len(), 4, "{hits:?}");
    let expected = [(0, 2.5), (0, 3.5), (1, 5.75), (1, 6.25)];
    for (hit, (segment, t)) in hits.iter().zip(expected) {
        assert_eq!((hit.geometry, hit.primitive), (curves, segment));
        assert!(is_near(hit.t, t) && is_near(hit.u, 0.25), "{hit:?}");
    }
    let inside = ray([0.0, 0.0, 0.5], [1.0, 0.0, 0.0]);
    scene.every_hit(&inside, &mut hits);
    assert_eq!(hits.len(), 3, "{hits:?}");
}

#[test]
fn round_curves_end_in_spheres() {
    let mut builder = builder();
    let vertices = [[0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 2.0, 0.5]];
    builder.attach_round_curves(&vertices, &[0], None).unwrap();
    let scene = builder.commit().unwrap();
    let side = ray([-3.0, 0.0, 0.5], [1.0, 0.0, 0.0]);
    let hit = scene.closest_native(&side, &mut ()).unwrap();
    assert!(is_near(hit.t, 2.5), "{hit:?}");
    let beyond = ray([-3.0, 0.0, 2.4], [1.0, 0.0, 0.0]);
    let hit = scene.closest_native(&beyond, &mut ()).unwrap();
    assert!(is_near(hit.t, 2.7), "{hit:?}");
}

/// With as many normals as fill the last 16 bytes of their buffer, and fewer.
#[test]
fn disks_are_met_from_both_sides_within_their_radius() {
    for count in [1_u8, 3, 4, 8] {
        let disks: Vec<[f32; 4]> = (0..count)
            .map(|i| [10.0 * f32::from(i), 0.0, 1.0, 0.5])
            .collect();
        // Of any length, and the last one tilted.
        let mut normals = vec![[0.0, 0.0, 3.0]; disks.len()];
        *normals.last_mut().unwrap() = [1.0, 0.0, 1.0];
        let mut builder = builder();
        let attached = builder.attach_disks(&disks, &normals).unwrap();
        let scene = builder.commit().unwrap();
        let x = 10.0 * f32::from(count - 1);
        for (from, towards) in [(5.0, -1.0), (-5.0, 1.0)] {
            let slanting = ray([x + 0.25, 0.0, from], [0.0, 0.0, towards]);
            let hit = scene.closest_native(&slanting, &mut ()).unwrap();
            assert_eq!(
                (hit.geometry, hit.primitive),
                (attached, u32::from(count) - 1)
            );
            assert!(is_near(hit.t, (0.75 - from).abs()), "{hit:?}");
            // Within the radius of a disk that is seen from above, not of this one.
            let beside = ray([x + 0.4, 0.0, from], [0.0, 0.0, towards]);
            assert_eq!(scene.closest_native(&beside, &mut ()), None);
            if count > 1 {
                let first = ray([0.4, 0.0, from], [0.0, 0.0, towards]);
                let hit = scene.closest_native(&first, &mut ()).unwrap();
                assert_eq!(hit.primitive, 0);
                assert!(is_near(hit.t, (1.0 - from).abs()), "{hit:?}");
            }
        }
    }
}

#[test]
fn spheres_are_met_from_outside_and_from_inside() {
    let mut builder = builder();
    let spheres = [[9.0, 9.0, 9.0, 1.0], [0.0, 0.0, 1.0, 0.5]];
    let attached = builder.attach_spheres(&spheres).unwrap();
    let scene = builder.commit().unwrap();
    for (origin, t, normal) in [(-3.0, 3.5, -1.0), (1.25, 0.25, 1.0)] {
        let along = ray([0.0, 0.0, origin], [0.0, 0.0, 1.0]);
        let hit = scene.closest_native(&along, &mut ()).unwrap();
        assert_eq!((hit.geometry, hit.primitive), (attached, 1));
        assert!(is_near(hit.t, t) && hit.normal[2] * normal > 0.0, "{hit:?}");
    }
    let beside = ray([0.51, 0.0, -3.0], [0.0, 0.0, 1.0]);
    assert_eq!(scene.closest_native(&beside, &mut ()), None);
}

#[test]
fn points_bad_input_is_refused_before_embree_sees_it() {
    let mut builder = builder();
    let disk = [0.0, 0.0, 0.0, 1.0];
    assert_eq!(
        builder.attach_disks(&[disk], &[]),
        Err(Error::NormalCount {
            normals: 0,
            disks: 1
        })
    );
    let bad_normal = builder.attach_disks(&[disk; 2], &[[0.0, 0.0, 1.0], [f32::NAN, 0.0, 1.0]]);
    let message = bad_normal.unwrap_err().to_string();
    assert!(
        message.starts_with("disk 1 has the normal [NaN, 0.0, 1.0]: "),
        "{message}"
    );
    let negative = builder.attach_spheres(&[disk, [0.0, 0.0, 0.0, -1.0]]);
    assert!(negative.unwrap_err().to_string().starts_with("vertex 1"));
}

#[test]
fn cone_curves_bad_input_is_refused_before_embree_sees_it() {
    let mut builder = builder();
    let line = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]];
    assert_eq!(
        builder.attach_cone_curves(&line, &[0, 1], None),
        Err(Error::VertexIndex {
            primitive: 1,
            vertex: 2,
            vertices: 2
        })
    );
    let huge = builder.attach_cone_curves(&line, &[u32::MAX], None);
    assert!(huge.unwrap_err().to_string().contains("4294967296"));
    assert_eq!(
        builder.attach_cone_curves(&line, &[0], Some(&[0, 0])),
        Err(Error::FlagCount {
            flags: 2,
            segments: 1
        })
    );
    let negative = [[0.0, 0.0, 0.0, -1.0], line[1]];
    assert!(builder.attach_cone_curves(&negative, &[0], None).is_err());
}
