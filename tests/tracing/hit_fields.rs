//! A hit with some of its fields has the bits of the whole hit, for every set of fields,
//! every kind of solid, placed or not, and every way to ask; the other fields are not
//! there.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test tracing hit_fields` is the full run; the
//! default is a tenth of it.

use std::collections::HashSet;

use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::scene::{MaterialIndex, Prototype, SolidRecord};
use cyltrace::solid::{AnySolid, Caps, Composition, Cuboid, Cylinder, SolidKind, Sphere};
use cyltrace::tracer::{DEFAULT_BATCH, Hit, HitFields, Options, PartialHit, Tracer};
use glam::DVec3;
use test_support::solids::{crowd, prototype_of, ray_through};
use test_support::{aim, bits, nested_placements, ray_count, scene_of};

const SEED: u64 = 20_261_129;

/// All sets of fields.
fn all_sets() -> impl Iterator<Item = HitFields> + Clone {
    (0..=HitFields::all().bits()).map(HitFields::from_bits_truncate)
}

/// Solids of all kinds in the unit cube, each set operation among them.
fn all_kinds(seed: u64) -> Prototype {
    let mut prototype = prototype_of(&crowd(seed, 60));
    let operands = |center: DVec3| {
        let half_widths = DVec3::splat(0.15);
        let cuboid = Cuboid::new(center, half_widths, Orientation::IDENTITY).unwrap();
        let sphere = Sphere::new(center, 0.2).unwrap();
        let end = center + DVec3::Z * 0.3;
        let cylinder = Cylinder::new(center, end, 0.1, Caps::Both).unwrap();
        let solids: [AnySolid; 3] = [cuboid.into(), sphere.into(), cylinder.into()];
        solids.map(Composition::Solid).to_vec()
    };
    let operations = [
        Composition::Union(operands(DVec3::new(0.2, 0.2, 0.2))),
        Composition::Intersection(operands(DVec3::new(0.8, 0.2, 0.6))),
        Composition::Difference(operands(DVec3::new(0.5, 0.8, 0.4))),
    ];
    for (number, operation) in (60..).zip(operations) {
        let record = SolidRecord::new(operation, number, MaterialIndex(0));
        prototype.solids.compositions.push(record);
    }
    prototype
}

const OUTWARD: DVec3 = DVec3::new(0.3, -0.5, 0.8);

/// The bits of each field, `None` where it is not there.
type Fields = [Option<Vec<u64>>; 6];

fn vector(vector: DVec3) -> Vec<u64> {
    vector.to_array().map(f64::to_bits).to_vec()
}

fn ray(ray: Ray) -> Vec<u64> {
    [vector(ray.origin), vector(ray.direction)].concat()
}

fn path(path: &[u32]) -> Vec<u64> {
    path.iter().map(|&number| number.into()).collect()
}

fn fields_of_partial(hit: &PartialHit) -> Fields {
    [
        hit.point().map(vector),
        hit.normal().map(vector),
        hit.uv().map(|(u, v)| vec![u.to_bits(), v.to_bits()]),
        hit.error().map(|error| vec![error.to_bits()]),
        hit.instance().map(path),
        hit.spawn(OUTWARD).map(ray),
    ]
}

/// The same of a whole hit, without the fields that are not in a set.
fn fields_of_whole(hit: &Hit, fields: HitFields) -> Fields {
    [
        (HitFields::POINT, vector(hit.point)),
        (HitFields::NORMAL, vector(hit.normal)),
        (HitFields::UV, vec![hit.u.to_bits(), hit.v.to_bits()]),
        (HitFields::ERROR, vec![hit.error.to_bits()]),
        (HitFields::PATH, path(&hit.instance)),
        (HitFields::SPAWN, ray(hit.spawn(OUTWARD))),
    ]
    .map(|(field, bits)| fields.contains(field).then_some(bits))
}

#[track_caller]
fn assert_same(partial: &PartialHit, whole: &Hit, fields: HitFields, case: &str) {
    assert_eq!(partial.fields(), fields, "{case}");
    assert_eq!(
        fields_of_partial(partial),
        fields_of_whole(whole, fields),
        "{fields:?}, {case}"
    );
    assert_eq!(
        (partial.t().to_bits(), partial.part(), partial.crossing()),
        (whole.t.to_bits(), whole.part, whole.crossing),
        "{fields:?}, {case}"
    );
    assert_eq!(
        (partial.prototype(), partial.primitive(), partial.solid()),
        (whole.prototype, whole.primitive, whole.solid),
        "{fields:?}, {case}"
    );
    assert_eq!(partial.material(), whole.material, "{fields:?}, {case}");
}

/// Compares all sets of fields of the hits of some rays.
fn compare(tracer: &Tracer, rays: &[Ray], kinds: &mut HashSet<SolidKind>) {
    let mut whole_batch = Vec::new();
    tracer.closest_batch(rays, &mut whole_batch);
    for fields in all_sets() {
        let mut batch = Vec::new();
        tracer.closest_batch_with(rays, fields, &mut batch);
        assert_eq!(batch.len(), rays.len());
        for ((ray, whole), in_batch) in rays.iter().zip(&whole_batch).zip(&batch) {
            let case = bits(ray);
            let alone = tracer.closest_with(ray, fields);
            assert_eq!(
                (alone.is_some(), in_batch.is_some()),
                (whole.is_some(), whole.is_some()),
                "{case}"
            );
            let (Some(whole), Some(in_batch), Some(alone)) = (whole, in_batch, alone) else {
                continue;
            };
            assert_same(in_batch, whole, fields, &case);
            assert_same(&alone, whole, fields, &case);
            kinds.insert(whole.solid);
        }
    }
    for (ray, fields) in rays.iter().zip(all_sets().cycle()) {
        let case = bits(ray);
        let whole: Vec<Hit> = tracer.all_hits(ray, DEFAULT_BATCH).collect();
        let partial: Vec<PartialHit> = tracer.all_hits(ray, 3).with(fields).collect();
        assert_eq!(partial.len(), whole.len(), "{case}");
        for (partial, whole) in partial.iter().zip(&whole) {
            assert_same(partial, whole, fields, &case);
        }
    }
}

/// How many rays of a scene are compared.
fn rays_of_a_scene() -> u64 {
    ray_count() / 250
}

#[test]
fn every_set_of_fields_of_every_kind_has_the_bits_of_the_whole_hit() {
    let tracer = Tracer::new(scene_of(vec![all_kinds(SEED)]), &Options::default()).unwrap();
    let mut random = Random::new(SEED, 0);
    let rays: Vec<Ray> = (0..rays_of_a_scene())
        .map(|_| ray_through(&mut random))
        .collect();
    let mut kinds = HashSet::new();
    compare(&tracer, &rays, &mut kinds);
    assert_eq!(kinds.len(), 9, "{kinds:?}");
}

#[test]
fn so_has_every_set_of_fields_of_placed_solids() {
    for (number, nested) in (1..).zip(nested_placements(SEED)) {
        let mut prototypes = nested.scene.prototypes.clone();
        prototypes[3] = all_kinds(SEED + number);
        let tracer = Tracer::new(scene_of(prototypes), &Options::default()).unwrap();
        let mut random = Random::new(SEED, number);
        let rays: Vec<Ray> = (0..rays_of_a_scene())
            .map(|_| {
                let image = nested.any_image(&mut random);
                aim::carried(&image, &ray_through(&mut random))
            })
            .collect();
        let mut kinds = HashSet::new();
        compare(&tracer, &rays, &mut kinds);
        assert_eq!(kinds.len(), 9, "{kinds:?}");
    }
}
