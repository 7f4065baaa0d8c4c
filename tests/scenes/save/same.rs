//! What makes two scenes the same.

use std::borrow::Borrow;
use std::fmt::Debug;

use cyltrace::scene::{Prototype, Records, Scene, SolidList, ValueList};

/// Compares all that a scene file states. The text of a float that `Debug` writes is another
/// for every f64, zeros of both signs included.
#[track_caller]
pub fn assert_same(one: &Scene, other: &Scene, name: &str) {
    same(&one.materials, &other.materials, name);
    same(&one.camera, &other.camera, name);
    same(&one.film, &other.film, name);
    same(&one.render, &other.render, name);
    same(&one.sun, &other.sun, name);
    same(&one.clear_sky, &other.clear_sky, name);
    same(&one.sky, &other.sky, name);
    let bits = |scene: &Scene| {
        let environment = scene.environment.as_ref()?;
        let pixels = environment.pixels().as_flattened().iter();
        let pixels: Vec<u32> = pixels.map(|component| component.to_bits()).collect();
        Some((format!("{environment:?}"), pixels))
    };
    assert_eq!(bits(one), bits(other), "{name}");
    same(&one.lights, &other.lights, name);
    same(&one.clips, &other.clips, name);
    same(&one.legend, &other.legend, name);
    same(&one.illustration, &other.illustration, name);
    same(&one.background, &other.background, name);
    assert_eq!(one.records(), other.records(), "{name}");
    assert_eq!(one.prototypes.len(), other.prototypes.len(), "{name}");
    for (one, other) in one.prototypes.iter().zip(&other.prototypes) {
        same_prototype(one, other, &format!("{name}, prototype {:?}", one.name));
    }
}

#[track_caller]
fn same_prototype(one: &Prototype, other: &Prototype, name: &str) {
    assert_eq!(one.name, other.name, "{name}");
    let (solids, copies) = (&one.solids, &other.solids);
    same_list(&solids.cylinders, &copies.cylinders, name);
    same_list(&solids.spheres, &copies.spheres, name);
    same_list(&solids.cuboids, &copies.cuboids, name);
    same_list(&solids.cones, &copies.cones, name);
    same_list(&solids.rounded_cones, &copies.rounded_cones, name);
    same_list(&solids.disks, &copies.disks, name);
    same_list(&solids.compositions, &copies.compositions, name);
    same_values(one, other, name);
    if solids.cylinders.records() == Records::F32 && !solids.cylinders.is_empty() {
        assert_eq!(copies.cylinders.records(), Records::F32, "{name}");
        assert_eq!(copies.cylinders.rounding(), 0.0, "{name}");
    }
    assert_eq!(one.placements.len(), other.placements.len(), "{name}");
    for (index, (one, other)) in one.placements.iter().zip(&other.placements).enumerate() {
        let bits = |affine: glam::DAffine3| affine.to_cols_array().map(f64::to_bits);
        assert_eq!(one.of, other.of, "{name}, placement {index}");
        assert_eq!(
            bits(one.parent_from_child),
            bits(other.parent_from_child),
            "{name}, placement {index}"
        );
    }
}

/// Compares the values of solids and placements for data colors.
#[track_caller]
fn same_values(one: &Prototype, other: &Prototype, name: &str) {
    let values = |list: &ValueList| -> Vec<(u32, u32)> {
        let known = list.iter().filter(|(_, value)| !value.is_nan());
        known
            .map(|(number, value)| (number, value.to_bits()))
            .collect()
    };
    assert_eq!(
        values(&one.solid_values),
        values(&other.solid_values),
        "{name}"
    );
    let placed = |prototype: &Prototype| -> Vec<_> {
        let columns = prototype.placement_values.iter();
        let columns = columns.map(|shown| (shown.column.clone(), values(&shown.values)));
        columns.collect()
    };
    assert_eq!(placed(one), placed(other), "{name}");
}

/// Compares lists in the order of their numbers.
#[track_caller]
fn same_list<L: SolidList<Solid: Debug>>(one: &L, other: &L, name: &str) {
    assert_eq!(one.len(), other.len(), "{name}");
    let [numbered, copies] = [one, other].map(|list| {
        let mut positions: Vec<usize> = (0..list.len()).collect();
        positions.sort_by_key(|&position| list.primitive(position));
        positions
    });
    for (position, copy) in numbered.into_iter().zip(copies) {
        let place = format!("{name}, solid {}", one.primitive(position));
        same(&one.primitive(position), &other.primitive(copy), &place);
        same(&one.material(position), &other.material(copy), &place);
        same(
            one.solid(position).borrow(),
            other.solid(copy).borrow(),
            &place,
        );
    }
}

#[track_caller]
fn same(one: &impl Debug, other: &impl Debug, name: &str) {
    assert_eq!(format!("{one:?}"), format!("{other:?}"), "{name}");
}
