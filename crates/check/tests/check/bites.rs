//! Slightly wrong intersectors, which the check must catch.

use std::sync::Arc;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, MaterialIndex, Scene};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::Tracer;
use cyltrace_check::{Class, Intersector, Outcome, ReportedHit, Settings, Witness};
use glam::{DAffine3, DVec3};

use super::scenes::{prototype, random_cylinder, random_scene};
use super::{checked, tracer};

/// An intersector that changes the answers of another.
pub struct Tampered<F>(pub F);

impl<F: Fn(&Ray) -> Option<ReportedHit> + Sync> Intersector for Tampered<F> {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        (self.0)(ray)
    }
}

fn settings(rays: u64) -> Settings {
    Settings {
        rays,
        ..Settings::default()
    }
}

/// 30 cylinders with disks, some of them placed.
fn scene() -> Scene {
    let mut random = Random::new(77, 0);
    let mut cylinders = |count| {
        let cylinder = |_| random_cylinder(&mut random, 6.0, Caps::Both);
        prototype((0..count).map(cylinder).collect::<Vec<_>>())
    };
    let mut scene = Scene::new(vec![cylinders(20), cylinders(10)]);
    let placed = &random_scene(3).prototypes[0].placements;
    scene.prototypes[0].placements.clone_from(placed);
    scene
}

/// The scene with every cylinder changed.
fn changed(scene: &Scene, change: impl Fn(&Cylinder) -> Cylinder) -> Tracer {
    let mut scene = scene.clone();
    for prototype in &mut scene.prototypes {
        let records = prototype.solids.cylinders.iter().map(|record| {
            let cylinder = change(&record.cylinder());
            CylinderRecord::new(&cylinder, record.primitive(), MaterialIndex(0))
        });
        prototype.solids.cylinders = records.collect();
    }
    tracer(&Arc::new(scene))
}

fn cylinder(p0: DVec3, p1: DVec3, radius: f64, caps: Caps) -> Cylinder {
    Cylinder::new(p0, p1, radius, caps).expect("a cylinder")
}

/// The intersector is found wrong, in each of `classes` by violations.
fn bites(name: &str, scene: &Scene, wrong: &impl Intersector, rays: u64, classes: &[Class]) {
    let outcome: Outcome = checked(name, scene, wrong, &settings(rays));
    assert!(!outcome.holds(), "{name} went through");
    for &class in classes {
        let found: u64 = outcome
            .rows
            .iter()
            .filter(|row| row.class == class.name())
            .map(|row| row.violations)
            .sum();
        assert!(found > 0, "{name} went through in class {class}");
        let mut listed = outcome.violations.iter();
        assert!(
            listed.any(|violation| violation.class == class.name()),
            "{name}: {class}"
        );
    }
}

#[test]
fn radius_off_by_a_ten_thousandth_is_caught() {
    let scene = scene();
    let wrong = changed(&scene, |c| {
        cylinder(c.p0(), c.p1(), c.radius() * (1.0 + 1e-4), c.caps())
    });
    bites("radius", &scene, &wrong, 3_000, &Class::ALL[1..4]);
}

#[test]
fn dropped_caps_are_caught() {
    let scene = scene();
    let wrong = changed(&scene, |c| cylinder(c.p0(), c.p1(), c.radius(), Caps::None));
    bites("caps", &scene, &wrong, 1_000, &Class::ALL);
}

#[test]
fn far_root_is_caught() {
    let scene = scene();
    let tracer = tracer(&Arc::new(scene.clone()));
    let wrong = Tampered(|ray: &Ray| {
        let first = Intersector::closest(&tracer, ray)?;
        let far = tracer.all_hits(ray, 8).nth(1);
        Some(far.map_or(first.clone(), |far| ReportedHit { t: far.t, ..first }))
    });
    bites("far root", &scene, &wrong, 1_000, &Class::ALL);
}

#[test]
fn ignored_range_is_caught() {
    let scene = scene();
    let tracer = tracer(&Arc::new(scene.clone()));
    let classes = [Class::Inside, Class::Grazing, Class::Axial];
    let no_start = Tampered(|ray: &Ray| {
        let t_min = 0.0;
        Intersector::closest(&tracer, &Ray { t_min, ..*ray })
    });
    bites("start of the range", &scene, &no_start, 1_000, &classes);
    let no_end = Tampered(|ray: &Ray| {
        let t_max = f64::INFINITY;
        Intersector::closest(&tracer, &Ray { t_max, ..*ray })
    });
    bites("end of the range", &scene, &no_end, 1_000, &classes);
}

#[test]
fn empty_settings_are_rejected() {
    let scene = scene();
    let tracer = tracer(&Arc::new(scene.clone()));
    let settings = Settings {
        classes: Vec::new(),
        ..settings(1_000)
    };
    let refused = cyltrace_check::compare(&scene, &tracer, &settings);
    assert!(matches!(
        refused,
        Err(cyltrace_check::CheckError::NothingToCheck)
    ));
}

#[test]
fn length_off_by_a_ten_thousandth_is_caught() {
    let scene = scene();
    let wrong = changed(&scene, |c| {
        let p1 = c.p1() + (c.p0() - c.p1()) * 1e-4;
        cylinder(c.p0(), p1, c.radius(), c.caps())
    });
    bites("length", &scene, &wrong, 3_000, &Class::ALL[1..]);
}

#[test]
fn flipped_normal_is_caught() {
    let scene = scene();
    let tracer = tracer(&Arc::new(scene.clone()));
    let flipped = |finding: ReportedHit| ReportedHit {
        normal: finding.normal.map(|normal| -normal),
        ..finding
    };
    let wrong = Tampered(|ray: &Ray| Intersector::closest(&tracer, ray).map(flipped));
    bites("normal", &scene, &wrong, 500, &Class::ALL);
    let nameless = Tampered(|ray: &Ray| {
        let finding = Intersector::closest(&tracer, ray).map(flipped)?;
        Some(ReportedHit {
            place: None,
            ..finding
        })
    });
    bites("normal of no place", &scene, &nameless, 500, &Class::ALL);
}

#[test]
fn shifted_hit_is_caught() {
    let mut random = Random::new(8, 0);
    let cylinders = (0..20).map(|_| {
        let random = random_cylinder(&mut random, 6.0, Caps::Both);
        cylinder(random.p0(), random.p1(), 0.5, Caps::Both)
    });
    let scene = Scene::new(vec![prototype(cylinders)]);
    let tracer = tracer(&Arc::new(scene.clone()));
    for sign in [1.0, -1.0] {
        let wrong = Tampered(|ray: &Ray| {
            let finding = Intersector::closest(&tracer, ray)?;
            let t = finding.t + sign * 0.5e-5 / ray.direction.length();
            Some(ReportedHit {
                t: t.clamp(ray.t_min, ray.t_max),
                ..finding
            })
        });
        bites("shifted", &scene, &wrong, 3_000, &Class::ALL);
    }
}

/// The oracle judges the sample on its own, whatever the meshes say.
#[test]
fn late_hits_are_violations_by_the_oracle() {
    let scene = scene();
    let tracer = tracer(&Arc::new(scene.clone()));
    let late = Tampered(|ray: &Ray| {
        let hit = Intersector::closest(&tracer, ray)?;
        let t = hit.t + 0.05;
        Some(ReportedHit { t, ..hit })
    });
    let outcome = checked("late", &scene, &late, &settings(20_000));
    let oracle = outcome
        .rows
        .iter()
        .filter(|row| row.witness == Witness::Oracle);
    for row in oracle.filter(|row| row.hits > 0) {
        assert!(row.violations > 0, "{row:?}");
    }
}

#[test]
fn one_missing_of_ten_thousand_is_caught() {
    let mut random = Random::new(9, 0);
    let all: Vec<Cylinder> = (0..10_000)
        .map(|_| {
            let middle = DVec3::from_array([0; 3].map(|_| random.uniform(-100.0, 100.0)));
            let half = random.direction() * random.uniform(0.2, 1.0);
            let radius = random.uniform(0.1, 0.5);
            cylinder(middle - half, middle + half, radius, Caps::Both)
        })
        .collect();
    let scene = Scene::new(vec![prototype(all.iter().copied())]);
    // The last, so that the numbers of the others stay the same.
    let wrong = Scene::new(vec![prototype(all[..9_999].iter().copied())]);
    let wrong = tracer(&Arc::new(wrong));
    let settings = Settings {
        segments: vec![16],
        rays: 60_000,
        classes: vec![Class::Sphere, Class::Inside],
        ..Settings::default()
    };
    let outcome = checked("missing", &scene, &wrong, &settings);
    assert!(!outcome.holds());
    assert!(outcome.rows[0].violations > 0 && outcome.rows[1].violations > 0);
}

#[test]
fn ignored_scale_is_caught() {
    let scene = scene();
    let mut wrong = scene.clone();
    for placement in &mut wrong.prototypes[0].placements {
        let placed = placement.parent_from_child;
        let [x, y, z] = [0, 1, 2].map(|i| placed.matrix3.col(i).normalize());
        let matrix = glam::DMat3::from_cols(x, y, z);
        placement.parent_from_child = DAffine3::from_mat3_translation(matrix, placed.translation);
    }
    let wrong = tracer(&Arc::new(wrong));
    bites("scale", &scene, &wrong, 1_000, &Class::ALL);
}
