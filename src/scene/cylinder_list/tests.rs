//! Lists of cylinders return what was added.

use super::*;
use crate::math::{Random, power_of_two};
use crate::solid::Caps;

fn record(random: &mut Random, primitive: u32) -> CylinderRecord {
    let p0 = random.direction() * random.log_uniform(1e-3, 1e3);
    let p1 = p0 + random.direction();
    let radius = random.log_uniform(1e-3, 1.0);
    let cylinder = Cylinder::new(p0, p1, radius, Caps::P1).expect("a cylinder");
    CylinderRecord::new(&cylinder, primitive, MaterialIndex(primitive as u16 % 7))
}

#[test]
fn f32_list_keeps_any_numbers_and_rounds_each_coordinate_once() {
    let mut random = Random::new(61, 0);
    let numbers: Vec<u32> = (5..40).chain(3..5).chain([90, 92, u32::MAX - 1]).collect();
    let stated: Vec<_> = numbers.iter().map(|&n| record(&mut random, n)).collect();
    let mut list = CylinderList::new(Records::F32);
    for &record in &stated {
        list.push(record).expect("the cylinder is valid in f32");
    }
    assert_eq!(list.iter().len(), stated.len());
    let mut greatest = 0.0_f64;
    for (position, (kept, stated)) in list.iter().zip(&stated).enumerate() {
        assert_eq!(list.primitive(position), numbers[position]);
        assert_eq!(kept.primitive(), stated.primitive());
        assert_eq!(kept.material(), stated.material());
        let (kept, stated) = (kept.cylinder(), stated.cylinder());
        assert_eq!(kept.caps(), stated.caps());
        assert_eq!(kept.radius(), f64::from(stated.radius() as f32));
        for (kept, stated) in [(kept.p0(), stated.p0()), (kept.p1(), stated.p1())] {
            let off = (kept - stated).abs();
            assert!(off.cmple(stated.abs() * power_of_two(-24)).all());
            greatest = greatest.max(off.max_element());
        }
        greatest = greatest.max((kept.radius() - stated.radius()).abs());
    }
    assert_eq!(list.rounding(), greatest);
    assert!(greatest > 0.0);
    // Five runs: 5.., 3.., 90, 92, the last.
    assert_eq!(list.records_bytes(), 32 * stated.len() + 5 * 8);
    assert!(list.as_f64().is_none());
    assert_eq!(list.as_f32().map(<[_]>::len), Some(stated.len()));
}

#[test]
fn f64_list_returns_the_records_added() {
    let mut random = Random::new(62, 0);
    let stated: Vec<_> = (0..9).map(|n| record(&mut random, 2 * n)).collect();
    let list: CylinderList = stated.iter().copied().collect();
    assert_eq!(list.as_f64(), Some(stated.as_slice()));
    assert!(list.iter().eq(stated.iter().copied()));
    assert_eq!((list.rounding(), list.records_bytes()), (0.0, 9 * 64));
    assert_eq!(list.primitive(4), 8);
    assert_eq!((list.position(8), list.position(7)), (Some(4), None));
}

#[test]
fn cylinders_that_are_invalid_in_f32_are_rejected() {
    let rejected = |p0: DVec3, p1: DVec3, radius: f64| {
        let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).expect("an f64 cylinder");
        let mut list = CylinderList::new(Records::F32);
        let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
        let error = list
            .push(record)
            .expect_err("the cylinder is invalid in f32");
        assert!(list.is_empty());
        error
    };
    let far = DVec3::splat(1e6);
    let error = rejected(far, far + DVec3::X * 1e-3, 1.0);
    assert_eq!(error, CylinderError::Length { length: 0.0 });
    let error = rejected(DVec3::ZERO, DVec3::X, Cylinder::LEAST);
    assert_eq!(error, CylinderError::Radius { radius: 0.0 });
    let error = rejected(DVec3::ZERO, DVec3::X * 1e40, 1.0);
    assert!(matches!(error, CylinderError::Endpoint { which: "p1", .. }));
    let error = rejected(DVec3::ZERO, DVec3::X, 1e39);
    assert_eq!(
        error,
        CylinderError::Radius {
            radius: f64::INFINITY
        }
    );
}

/// A cylinder at a random place in a cube, far shorter than the cube is wide.
fn short_record(random: &mut Random, primitive: u32) -> CylinderRecord {
    let p0 = 100.0 * DVec3::new(random.unit(), random.unit(), random.unit());
    let cylinder = Cylinder::new(p0, p0 + random.direction(), 0.1, Caps::Both);
    CylinderRecord::new(&cylinder.expect("a cylinder"), primitive, MaterialIndex(0))
}

/// The mean distance between the first ends of neighbors.
fn mean_jump(list: &CylinderList) -> f64 {
    let ends: Vec<DVec3> = list.iter().map(|record| record.cylinder().p0()).collect();
    let jumps = ends.windows(2).map(|pair| (pair[1] - pair[0]).length());
    jumps.sum::<f64>() / (ends.len() - 1) as f64
}

#[test]
fn arranged_list_contains_the_same_cylinders_with_neighbors_near() {
    let mut random = Random::new(63, 0);
    let stated: Vec<_> = (0..10_000).map(|n| short_record(&mut random, n)).collect();
    let mut list = CylinderList::from(stated.clone());
    let before = mean_jump(&list);
    list.arrange();
    assert!(mean_jump(&list) * 4.0 < before);
    let mut records: Vec<_> = list.iter().collect();
    records.sort_by_key(CylinderRecord::primitive);
    assert_eq!(records, stated);
    for position in 0..10_000 {
        let primitive = list.get(position).primitive();
        assert_eq!(list.primitive(position), primitive);
        assert_eq!(list.position(primitive), Some(position));
    }

    let arranged: Vec<_> = list.iter().collect();
    list.arrange();
    assert!(list.iter().eq(arranged), "the list was in order");
}

#[test]
fn short_lists_and_coincident_cylinders_keep_their_order() {
    let mut random = Random::new(64, 0);
    let few: Vec<_> = (0..4095).map(|n| short_record(&mut random, n)).collect();
    let one = record(&mut random, 0).cylinder();
    let at_one_place = (0..5000).rev();
    let same: Vec<_> = at_one_place
        .map(|n| CylinderRecord::new(&one, n, MaterialIndex(0)))
        .collect();
    for stated in [few, same] {
        let mut list = CylinderList::from(stated.clone());
        list.arrange();
        assert_eq!(list.as_f64(), Some(stated.as_slice()));
    }
}
