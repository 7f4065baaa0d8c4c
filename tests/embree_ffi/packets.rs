//! Packets of rays: the answers of single rays, for every width and instruction
//! set, with any rays missing, and nested either way.

use std::array;

use cyltrace::embree::{
    Box32, Coherence, Device, DeviceOptions, GREATEST_PACKET, MaxIsa, PacketWidth, Ray32, RaySet,
    Rays32, Reached, Scene, SceneBuilder, UserGeometry,
};
use cyltrace::math::Random;
use glam::DVec3;

use crate::balls::{
    Ball, BallPacket, BallQuery, intersect_each, random_balls, random_query, rays_of,
};
use crate::queries::scene_of;

const SEED: u64 = 0xBAC;

/// Ways to trace a packet, none of which may show.
fn ways() -> impl Iterator<Item = (PacketWidth, Coherence)> {
    PacketWidth::ALL.into_iter().flat_map(|width| {
        [Coherence::Incoherent, Coherence::Coherent].map(|coherence| (width, coherence))
    })
}

/// Every instruction set of this processor, and Embree's choice.
fn devices() -> impl Iterator<Item = (Option<MaxIsa>, Device)> {
    let sets = MaxIsa::available().into_iter().map(Some).chain([None]);
    sets.map(|max_isa| {
        let options = DeviceOptions {
            max_isa,
            ..DeviceOptions::default()
        };
        (max_isa, Device::new(&options).unwrap())
    })
}

/// What a ray of a packet is there for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// To meet what it meets.
    Whole,
    /// To end before the scene begins.
    Short,
    /// To have no range, so that it meets nothing.
    Empty,
    /// Not to be traced: its numbers are none.
    Missing,
}

/// A random packet: queries in a random order, some of them short, empty or
/// missing, their rays, and which are active.
struct Case {
    queries: BallPacket,
    kinds: [Kind; GREATEST_PACKET],
    rays: Rays32,
    active: RaySet,
}

impl Case {
    fn new(number: u64) -> Self {
        let mut random = Random::new(SEED, number);
        let mut order: [u64; GREATEST_PACKET] = array::from_fn(|place| place as u64);
        for end in (1..GREATEST_PACKET).rev() {
            order.swap(end, random.below(end as u64 + 1) as usize);
        }
        // All in some packets, hardly any in others.
        let share = random.unit();
        let kinds = array::from_fn(|_| match random.unit() {
            missing if missing > share => Kind::Missing,
            _ => match random.below(8) {
                0 => Kind::Short,
                1 => Kind::Empty,
                _ => Kind::Whole,
            },
        });
        let first = number * GREATEST_PACKET as u64;
        let mut queries = order.map(|place| random_query(SEED, first + place));
        let mut rays = rays_of(&queries);
        for (ray, kind) in kinds.iter().enumerate() {
            match kind {
                Kind::Whole => {}
                // Rays start at a distance of 4, the balls end before 2.
                Kind::Short => {
                    queries[ray].t_max = 1.0 / queries[ray].direction.length();
                    rays.t_far[ray] = queries[ray].t_max as f32;
                }
                Kind::Empty => rays.t_far[ray] = [-1.0, f32::NEG_INFINITY][ray % 2],
                Kind::Missing => {
                    rays.t_far[ray] = f32::NAN;
                    for axis in 0..3 {
                        rays.origin[axis][ray] = f32::NAN;
                        rays.direction[axis][ray] = f32::INFINITY;
                    }
                }
            }
        }
        let active = (0..GREATEST_PACKET).filter(|&ray| kinds[ray] != Kind::Missing);
        Self {
            queries,
            kinds,
            rays,
            active: active.collect(),
        }
    }

    /// Compares `closest_packet` and `any_packet` with brute force, and answers
    /// with the number of hits.
    fn check(
        &self,
        scene: &Scene<BallQuery>,
        balls: &[Ball],
        (width, coherence): (PacketWidth, Coherence),
    ) -> usize {
        let expected: [_; GREATEST_PACKET] = array::from_fn(|ray| match self.kinds[ray] {
            Kind::Whole | Kind::Short => self.queries[ray].brute_force(balls),
            Kind::Empty | Kind::Missing => None,
        });
        let mut packet = self.queries.clone();
        scene.closest_packet(&self.rays, self.active, width, coherence, &mut packet);
        let found = packet.each_ref().map(|query| query.best);
        assert_eq!(found, expected, "{:?}", self.kinds);
        let hits = (0..GREATEST_PACKET).filter(|&ray| expected[ray].is_some());
        let hits: RaySet = hits.collect();
        let any = scene.any_packet(&self.rays, self.active, width, coherence, &mut packet);
        assert_eq!(any, hits, "{:?}", self.kinds);
        for (ray, kind) in self.kinds.iter().enumerate() {
            if matches!(kind, Kind::Empty | Kind::Missing) {
                assert_eq!(packet[ray].visits, 0, "ray {ray} of {:?}", self.kinds);
            }
        }
        hits.len()
    }
}

#[test]
fn packets_agree_with_brute_force_for_every_isa_and_width() {
    let balls = random_balls(SEED, 500);
    for (isa, device) in devices() {
        let scene = scene_of(&device, &balls);
        for way in ways() {
            let hits: usize = (0..200)
                .map(|number| Case::new(number).check(&scene, &balls, way))
                .sum();
            assert!(
                (200..1600).contains(&hits),
                "{hits} of 3200 rays hit with {isa:?}, {way:?}"
            );
        }
    }
}

/// One ball beside another along an axis, thousands of them, seen by rays that
/// all go the same way: the case that coherent traversal is for.
#[test]
fn packets_of_parallel_rays_find_the_first_of_a_row() {
    let balls: Vec<Ball> = (0..1000)
        .map(|number| Ball {
            center: DVec3::new(0.0, 0.0, f64::from(number)),
            radius: 0.25,
        })
        .collect();
    for (isa, device) in devices() {
        let scene = scene_of(&device, &balls);
        for (width, coherence) in ways() {
            // Those from 13 on pass beside the balls.
            let mut packet: BallPacket = array::from_fn(|ray| {
                BallQuery::new(DVec3::new(ray as f64 / 50.0, 0.0, -1.0), DVec3::Z)
            });
            let rays = rays_of(&packet);
            scene.closest_packet(&rays, RaySet::ALL, width, coherence, &mut packet);
            for (ray, query) in packet.iter().enumerate() {
                let first = (ray < 13).then_some(0);
                assert_eq!(
                    query.best.map(|(_, ball)| ball),
                    first,
                    "ray {ray}, {isa:?}"
                );
                assert!(
                    query.visits < 100 || ray >= 13,
                    "{} of 1000 balls were visited by ray {ray} with {isa:?}, {width:?}",
                    query.visits
                );
            }
            let any = scene.any_packet(&rays, RaySet::ALL, width, coherence, &mut packet);
            assert_eq!(any, RaySet::first(13), "{isa:?}, {width:?}, {coherence:?}");
        }
    }
}

/// A box around a scene, which it hands rays on to: a single ray as one of a
/// packet, a packet as single rays or as a packet in another order.
struct Nest {
    inner: Scene<BallQuery>,
    way: (PacketWidth, Coherence),
    as_single_rays: bool,
}

impl Nest {
    /// The place of a ray in the inner packet; its own inverse.
    fn place(ray: usize) -> usize {
        ray ^ 0b0110
    }

    /// The queries and the set of rays in the inner packet's order.
    fn reordered(rays: RaySet, packet: &BallPacket) -> (BallPacket, RaySet) {
        let inner = array::from_fn(|place| packet[Self::place(place)].clone());
        (inner, rays.into_iter().map(Self::place).collect())
    }

    /// A packet of copies of a query, the place of the one that is traced.
    fn alone(query: &BallQuery) -> (BallPacket, usize) {
        (array::from_fn(|_| query.clone()), 11)
    }
}

/// Embree's end of a ray that has found what it has.
fn end(query: &BallQuery) -> Option<f32> {
    query.best.map(|(t, _)| (t as f32).next_up())
}

impl UserGeometry for Nest {
    type Query = BallQuery;

    fn primitive_count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Box32 {
        Box32 {
            lower: [-1.5; 3],
            upper: [1.5; 3],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> Option<f32> {
        let (mut packet, place) = Self::alone(query);
        let (width, coherence) = self.way;
        let active = RaySet::from_bits(1 << place);
        let rays = rays_of(&packet);
        self.inner
            .closest_packet(&rays, active, width, coherence, &mut packet);
        *query = packet[place].clone();
        end(query)
    }

    fn occluded(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> bool {
        let (mut packet, place) = Self::alone(query);
        let (width, coherence) = self.way;
        let active = RaySet::from_bits(1 << place);
        let rays = rays_of(&packet);
        self.inner
            .any_packet(&rays, active, width, coherence, &mut packet)
            == active
    }

    fn intersect_packet(
        &self,
        _: Reached,
        rays: RaySet,
        _: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut BallPacket,
    ) -> RaySet {
        if self.as_single_rays {
            return intersect_each(rays, t_far, |ray| {
                let query = &mut packet[ray];
                self.inner.closest(&query.ray(), query);
                end(query)
            });
        }
        let (mut inner, active) = Self::reordered(rays, packet);
        let (width, coherence) = self.way;
        let inner_rays = rays_of(&inner);
        self.inner
            .closest_packet(&inner_rays, active, width, coherence, &mut inner);
        intersect_each(rays, t_far, |ray| {
            packet[ray] = inner[Self::place(ray)].clone();
            end(&packet[ray])
        })
    }

    fn occluded_packet(
        &self,
        _: Reached,
        rays: RaySet,
        _: &Rays32,
        packet: &mut BallPacket,
    ) -> RaySet {
        if self.as_single_rays {
            let blocked = rays.into_iter().filter(|&ray| {
                let query = &mut packet[ray];
                self.inner.any(&query.ray(), query)
            });
            return blocked.collect();
        }
        let (mut inner, active) = Self::reordered(rays, packet);
        let (width, coherence) = self.way;
        let inner_rays = rays_of(&inner);
        let blocked = self
            .inner
            .any_packet(&inner_rays, active, width, coherence, &mut inner);
        blocked.into_iter().map(Self::place).collect()
    }
}

#[test]
fn packets_nested_in_packets_and_single_rays_agree_with_brute_force() {
    let balls = random_balls(SEED, 200);
    for (_, device) in devices() {
        for (way, as_single_rays) in ways().zip([false, true].into_iter().cycle()) {
            // Two levels, so that packets are nested in packets that are nested.
            let mut scene = scene_of(&device, &balls);
            for as_single_rays in [false, as_single_rays] {
                let mut builder = SceneBuilder::new(&device).unwrap();
                builder
                    .attach_user(Nest {
                        inner: scene,
                        way,
                        as_single_rays,
                    })
                    .unwrap();
                scene = builder.commit().unwrap();
            }
            for number in 0..20 {
                let case = Case::new(number);
                case.check(&scene, &balls, way);
                let mut single = case.queries[0].clone();
                let expected = single.brute_force(&balls);
                scene.closest(&single.ray(), &mut single);
                assert_eq!(single.best, expected, "{way:?}");
                let any = scene.any(&single.ray(), &mut single);
                assert_eq!(any, expected.is_some(), "{way:?}");
            }
        }
    }
}

#[test]
fn packet_width_grows_with_the_instruction_set() {
    let widths: Vec<_> = devices()
        .map(|(_, device)| device.packet_width().expect("this Embree has packets"))
        .collect();
    assert!(widths.is_sorted(), "{widths:?}");
    if let Some(best) = MaxIsa::best() {
        let expected = match best {
            MaxIsa::Sse2 | MaxIsa::Sse42 => 4,
            MaxIsa::Avx | MaxIsa::Avx2 => 8,
            MaxIsa::Avx512 => 16,
        };
        assert!(widths.last().is_some_and(|width| width.rays() <= expected));
    }
}

#[test]
fn packets_of_no_rays_and_of_empty_scenes_meet_nothing() {
    let (_, device) = devices().last().expect("Embree has a choice");
    let ball = Ball {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    for (balls, active) in [(vec![], RaySet::ALL), (vec![ball], RaySet::EMPTY)] {
        let scene = scene_of(&device, &balls);
        let mut packet: BallPacket = array::from_fn(|ray| random_query(SEED, ray as u64));
        let rays = rays_of(&packet);
        for (width, coherence) in ways() {
            scene.closest_packet(&rays, active, width, coherence, &mut packet);
            let any = scene.any_packet(&rays, active, width, coherence, &mut packet);
            assert_eq!(any, RaySet::EMPTY);
        }
        assert!(packet.iter().all(|query| query.visits == 0));
    }
}
