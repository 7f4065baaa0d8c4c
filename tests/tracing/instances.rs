//! Placements that are Embree's own instances lose nothing and change no answer: small,
//! large, flat, far, mirrored, turned by right angles, and nested up to five deep, against
//! trying everything and against the same scene without instances. So do prototypes that are
//! opened into their parents, since they contain nothing but a few placements.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test tracing instances` is the full run; the
//! default is a tenth of it.

use std::sync::Arc;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, Placement, Prototype, Scene, Solids};
use cyltrace::tracer::{Containing, Hit, Layout, Options, Tracer};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;
use test_support::aim::{carried, farthest_point, ray_at};
use test_support::{
    cylinders_in_a_box, instruction_sets, placed, placing, random_rotation, scene_of,
};

const SEED: u64 = 20_261_129;

/// With more placements than this a prototype has no instances of Embree's.
const MOST_INSTANCES: usize = 1 << 12;

/// The least stretch against the greatest of a placement that is nearly singular.
const FLAT: f64 = 1e-5;

/// What is unusual about a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Ordinary,
    /// At and beyond the ratio up to which placements are instances.
    Small,
    Tiny,
    Huge,
    Flat,
    Far,
    Mirrored,
    /// By quarter turns, whose cosines are 6e-17.
    Turned,
}

const KINDS: [Kind; 8] = [
    Kind::Ordinary,
    Kind::Small,
    Kind::Tiny,
    Kind::Huge,
    Kind::Flat,
    Kind::Far,
    Kind::Mirrored,
    Kind::Turned,
];

fn placement(random: &mut Random, kind: Kind) -> DAffine3 {
    let scale = match kind {
        Kind::Small => random.log_uniform(1e-3, 0.1),
        Kind::Tiny => random.log_uniform(1e-6, 1e-3),
        Kind::Huge => random.log_uniform(1e3, 1e6),
        _ => random.log_uniform(0.3, 3.0),
    };
    let stretch = match kind {
        Kind::Flat => DVec3::new(random.log_uniform(FLAT, 1e-2), 1.0, 1.0),
        Kind::Mirrored => DVec3::new(-1.0, 0.7, 1.3),
        _ => DVec3::ONE,
    };
    let turn = match kind {
        Kind::Turned => {
            let right = std::f64::consts::FRAC_PI_2;
            DMat3::from_rotation_z(right) * DMat3::from_rotation_x(right)
        }
        _ => random_rotation(random),
    };
    let matrix = turn * DMat3::from_diagonal(stretch * scale) * random_rotation(random);
    let matrix = if kind == Kind::Turned { turn } else { matrix };
    let distance = if kind == Kind::Far { 1e7 } else { 2.0 };
    let offset = random.direction() * (distance * scale.min(1.0));
    DAffine3::from_mat3_translation(matrix, offset)
}

/// Prototypes placed in each other, and where the cylinders of the innermost are.
struct Nest {
    kind: Kind,
    depth: usize,
    /// Whether prototypes with placements contain nothing else, but for the root.
    is_bare: bool,
    scene: Arc<Scene>,
    /// The same, with so many placements of nothing that none is an instance.
    without: Arc<Scene>,
    images: Vec<DAffine3>,
    cylinders: Vec<CylinderRecord>,
}

impl Nest {
    /// `depth` levels of placements, one of them with an unusual one. All prototypes
    /// contain cylinders too, or the root and the innermost alone.
    fn new(kind: Kind, depth: usize, is_bare: bool) -> Self {
        let mut random = Random::new(SEED, depth as u64 * 16 + kind as u64);
        let unusual = random.below(depth as u64) as usize;
        let cylinders = cylinders_in_a_box(SEED, 24);
        let mut prototypes = Vec::new();
        let mut images = vec![DAffine3::IDENTITY];
        for level in 0..depth {
            let of = level as u32 + 1;
            let kinds = if level == unusual {
                vec![kind, Kind::Ordinary, Kind::Turned, Kind::Small]
            } else {
                vec![Kind::Ordinary, Kind::Mirrored]
            };
            let placements: Vec<Placement> = kinds
                .into_iter()
                .map(|kind| placed(of, placement(&mut random, kind)))
                .collect();
            images = images
                .iter()
                .flat_map(|outer| placements.iter().map(|one| *outer * one.parent_from_child))
                .collect();
            let own = if is_bare && level > 0 { 0 } else { 3 };
            let own = cylinders_in_a_box(SEED + 1 + level as u64, own);
            prototypes.push(Prototype {
                solids: Solids::of_cylinders(own),
                ..placing(placements)
            });
        }
        prototypes.push(Prototype {
            solids: Solids::of_cylinders(cylinders.clone()),
            ..Prototype::default()
        });
        let nothing = prototypes.len() as u32;
        let mut padded = prototypes.clone();
        for prototype in &mut padded[..depth] {
            let more = placed(nothing, DAffine3::IDENTITY);
            let placements = &mut prototype.placements;
            placements.extend(std::iter::repeat_n(more, MOST_INSTANCES + 1));
        }
        for all in [&mut prototypes, &mut padded] {
            all.push(Prototype {
                name: "nothing".to_owned(),
                ..Prototype::default()
            });
        }
        Self {
            kind,
            depth,
            is_bare,
            scene: scene_of(prototypes),
            without: scene_of(padded),
            images,
            cylinders,
        }
    }

    fn all() -> impl Iterator<Item = Self> {
        KINDS
            .into_iter()
            .flat_map(|kind| (1..=5).map(move |depth| (kind, depth)))
            .flat_map(|(kind, depth)| {
                // With one level there is nothing to open; what is deeper has the same in it.
                let bare = (2..=3)
                    .contains(&depth)
                    .then(|| Self::new(kind, depth, true));
                std::iter::once(Self::new(kind, depth, false)).chain(bare)
            })
    }

    fn image(&self, random: &mut Random) -> DAffine3 {
        self.images[random.below(self.images.len() as u64) as usize]
    }

    fn ray(&self, random: &mut Random) -> Ray {
        let image = self.image(random);
        // From so far, too, that opened prototypes would have moved them nearer.
        let is_far = self.is_bare && random.below(2) == 0;
        let reach = if is_far { 1e8 } else { 1e4 };
        carried(&image, &ray_at(random, &self.cylinders, reach))
    }

    /// Rays that go about the same way, so that they are a packet, some of them along
    /// faces of the boxes of an image's cylinders.
    fn bundle(&self, random: &mut Random) -> Vec<Ray> {
        let image = self.image(random);
        let outward = DVec3::AXES[random.below(3) as usize];
        let heading = match random.below(2) {
            0 => outward.any_orthonormal_vector(),
            _ => random.direction(),
        };
        let spread = [0.0, 1e-12, 1e-3][random.below(3) as usize];
        let distance = random.log_uniform(1.0, 1e3);
        (0..16)
            .map(|_| {
                let any = random.below(self.cylinders.len() as u64) as usize;
                let cylinder = self.cylinders[any].cylinder();
                let middle = cylinder.p0().lerp(cylinder.p1(), random.unit());
                let depth = random.log_uniform(1e-12, 1.0);
                let target = farthest_point(&cylinder, outward).lerp(middle, depth);
                let direction = heading + random.direction() * spread;
                carried(&image, &Ray::new(target - direction * distance, direction))
            })
            .collect()
    }

    /// Points just inside cylinders.
    fn point(&self, random: &mut Random) -> DVec3 {
        let any = random.below(self.cylinders.len() as u64) as usize;
        let cylinder = self.cylinders[any].cylinder();
        let middle = cylinder.p0().lerp(cylinder.p1(), 0.5);
        let outward = random.direction();
        let depth = random.log_uniform(1e-12, 1.0);
        let point = farthest_point(&cylinder, outward).lerp(middle, depth);
        self.image(random).transform_point3(point)
    }
}

fn tracer(scene: &Arc<Scene>, options: &Options) -> Tracer {
    Tracer::new(Arc::clone(scene), options).unwrap()
}

/// The first of all hits at each `t`, against the first hits beyond one another, of everything tried.
/// A prototype of placements alone has other groups where it is padded, and then
/// other last bits for rays from afar.
fn assert_one_by_one(tracer: &Tracer, ray: &Ray, all: &[Hit], case: &str) {
    let mut rest = *ray;
    for hits in all.chunk_by(|one, other| one.t == other.t).take(6) {
        let next = tracer.closest_exhaustive(&rest).expect("one more hit");
        let key = |hit: &Hit| (hit.t, hit.instance.clone(), hit.primitive);
        assert_eq!(key(&hits[0]), key(&next), "{case}");
        rest.t_min = next.t.next_up();
    }
}

/// Rays and a point, with the answers of trying everything. These do not depend on the
/// instruction set and the layout, and take most of the test's time.
struct Case {
    number: u64,
    ray: Ray,
    truth: Option<Hit>,
    point: Option<(DVec3, Vec<Containing>)>,
    bundle: Vec<Ray>,
    bundle_truth: Vec<Option<Hit>>,
}

impl Case {
    fn new(nest: &Nest, witness: &Tracer, number: u64) -> Self {
        let mut random = Random::new(SEED, 10_000 + number);
        let ray = nest.ray(&mut random);
        let point = number.is_multiple_of(4).then(|| nest.point(&mut random));
        let bundle = match number % 8 {
            0 => nest.bundle(&mut random),
            _ => Vec::new(),
        };
        let bundle_truth = bundle.iter().map(|ray| witness.closest_exhaustive(ray));
        Self {
            number,
            truth: witness.closest_exhaustive(&ray),
            ray,
            point: point.map(|point| (point, witness.contains_exhaustive(point))),
            bundle_truth: bundle_truth.collect(),
            bundle,
        }
    }
}

/// Every kind of query, for a nest and one instruction set; returns the number of hits.
fn assert_same(nest: &Nest, options: &Options, cases: &[Case]) -> u64 {
    let (tracer, without) = (tracer(&nest.scene, options), tracer(&nest.without, options));
    let hits = cases.par_iter().map(|one| {
        let Case { ray, truth, .. } = one;
        let case = || {
            let (kind, depth, bare) = (nest.kind, nest.depth, nest.is_bare);
            let (bits, number) = (test_support::bits(ray), one.number);
            format!("{kind:?}, depth {depth}, bare {bare}, {options:?}, seed {SEED}, ray {number}: {bits}")
        };
        assert_eq!(tracer.closest(ray), *truth, "{}", case());
        assert_eq!(tracer.occluded(ray), truth.is_some(), "{}", case());
        if let Some((point, containing)) = &one.point {
            let all: Vec<_> = tracer.all_hits(ray, 4).collect();
            assert_eq!(all.first(), truth.as_ref(), "{}", case());
            if nest.is_bare {
                assert_one_by_one(&tracer, ray, &all, &case());
            } else {
                let expected: Vec<_> = without.all_hits(ray, 4).collect();
                assert_eq!(all, expected, "{}", case());
            }
            assert_eq!(tracer.contains(*point), *containing, "{}", case());
        }
        let (mut together, mut blocked) = (Vec::new(), Vec::new());
        tracer.closest_batch(&one.bundle, &mut together);
        tracer.occluded_batch(&one.bundle, &mut blocked);
        for (at, alone) in one.bundle_truth.iter().enumerate() {
            assert_eq!(together[at], *alone, "{}, of a bundle {at}", case());
            assert_eq!(blocked[at], alone.is_some(), "{}, of a bundle {at}", case());
        }
        u64::from(truth.is_some())
    });
    hits.sum()
}

#[test]
fn instances_answer_as_everything_tried_does() {
    let rays = test_support::ray_count() / 200;
    let (mut hits, mut traced, mut instances) = (0, 0, 0);
    for nest in Nest::all() {
        let witness = tracer(&nest.scene, &Options::default());
        let cases = (0..rays).into_par_iter();
        let cases: Vec<Case> = cases
            .map(|number| Case::new(&nest, &witness, number))
            .collect();
        for max_isa in instruction_sets() {
            // In blocks the filter has to bear what mapping a ray in f32 displaces.
            for layout in [Layout::Single, Layout::Block] {
                let options = Options {
                    max_isa,
                    layout,
                    ..Options::default()
                };
                hits += assert_same(&nest, &options, &cases);
                traced += rays;
            }
        }
        let built = Options {
            build: cyltrace::tracer::BuildTime::AtOnce,
            ..Options::default()
        };
        let of = |scene| tracer(scene, &built).statistics().embree_instances;
        assert_eq!(of(&nest.without), 0, "{:?}", nest.kind);
        instances += of(&nest.scene);
    }
    println!("{traced} rays, {hits} hits, {instances} instances in all scenes");
    assert!(hits * 3 > traced, "only {hits} hits: the test sees nothing");
    // Of 5 scenes of 8 kinds most have one at least.
    assert!(instances > 40, "{instances}");
}

/// A root with three assemblies in a row, each with this number of parts along y.
fn assemblies(parts: u32) -> Arc<Scene> {
    let along = |axis: DVec3, count: u32, of: u32| {
        let each = (0..count)
            .map(|number| placed(of, DAffine3::from_translation(axis * f64::from(3 * number))));
        placing(each.collect())
    };
    let part = Prototype {
        solids: Solids::of_cylinders(cylinders_in_a_box(SEED, 20)),
        ..Prototype::default()
    };
    scene_of(vec![along(DVec3::X, 3, 1), along(DVec3::Y, parts, 2), part])
}

/// A prototype of eight placements is opened: the root has instances of all parts, and the first ray
/// has nothing else to build. One of nine is not.
#[test]
fn few_placements_are_opened_into_their_parent() {
    for (parts, instances) in [(1, 3), (8, 24), (9, 9)] {
        let scene = assemblies(parts);
        let tracer = tracer(&scene, &Options::default());
        let cylinder = scene.prototypes[2].solids.cylinders.get(0).cylinder();
        let middle = cylinder.p0().lerp(cylinder.p1(), 0.5) + DVec3::X * 6.0;
        let ray = Ray::new(middle + DVec3::Z * 10.0, DVec3::NEG_Z);
        let hit = tracer.closest(&ray).expect("a hit");
        assert_eq!(hit.instance, [2, 0], "{parts} parts");
        assert_eq!(Some(hit), tracer.closest_exhaustive(&ray), "{parts} parts");
        let statistics = tracer.statistics();
        assert_eq!(statistics.embree_instances, instances, "{parts} parts");
        assert!(statistics.skipped.is_empty(), "{:?}", statistics.skipped);
    }
}
