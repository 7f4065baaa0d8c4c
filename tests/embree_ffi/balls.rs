//! A user geometry simple enough to check by brute force: balls, in f64.

use std::array;

use cyltrace::embree::{
    Box32, GREATEST_PACKET, Query, Ray32, RaySet, Rays32, Reached, UserGeometry,
};
use cyltrace::math::Random;
use glam::DVec3;

/// The methods for packets of a geometry that answers for each ray by itself.
macro_rules! one_by_one {
    () => {
        fn intersect_packet(
            &self,
            at: cyltrace::embree::Reached,
            rays: cyltrace::embree::RaySet,
            rays32: &cyltrace::embree::Rays32,
            t_far: &mut [f32; cyltrace::embree::GREATEST_PACKET],
            packet: &mut crate::balls::BallPacket,
        ) -> cyltrace::embree::RaySet {
            crate::balls::intersect_each(rays, t_far, |ray| {
                self.intersect(at, &rays32.ray(ray), &mut packet[ray])
            })
        }

        fn occluded_packet(
            &self,
            at: cyltrace::embree::Reached,
            rays: cyltrace::embree::RaySet,
            rays32: &cyltrace::embree::Rays32,
            packet: &mut crate::balls::BallPacket,
        ) -> cyltrace::embree::RaySet {
            rays.into_iter()
                .filter(|&ray| self.occluded(at, &rays32.ray(ray), &mut packet[ray]))
                .collect()
        }
    };
}

/// The methods for packets of a geometry that never sees one.
macro_rules! no_packets {
    () => {
        fn intersect_packet(
            &self,
            _: cyltrace::embree::Reached,
            _rays: cyltrace::embree::RaySet,
            _: &cyltrace::embree::Rays32,
            _t_far: &mut [f32; cyltrace::embree::GREATEST_PACKET],
            packet: &mut cyltrace::embree::NoPackets,
        ) -> cyltrace::embree::RaySet {
            match *packet {}
        }

        fn occluded_packet(
            &self,
            _: cyltrace::embree::Reached,
            _rays: cyltrace::embree::RaySet,
            _: &cyltrace::embree::Rays32,
            packet: &mut cyltrace::embree::NoPackets,
        ) -> cyltrace::embree::RaySet {
            match *packet {}
        }
    };
}

pub(crate) use {no_packets, one_by_one};

#[derive(Clone, Copy, Debug)]
pub struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

/// A ray and its closest hit so far.
#[derive(Clone, Debug)]
pub struct BallQuery {
    pub origin: DVec3,
    pub direction: DVec3,
    /// Where the ray ends.
    pub t_max: f64,
    /// The least `t`, then the least number of a ball.
    pub best: Option<(f64, u32)>,
    pub visits: u32,
}

/// Sixteen of them, by the numbers of the rays.
pub type BallPacket = [BallQuery; GREATEST_PACKET];

impl Query for BallQuery {
    type Packet = BallPacket;
}

pub struct Balls(pub Vec<Ball>);

impl Ball {
    /// Where a ray from outside enters.
    pub fn enter(&self, query: &BallQuery) -> Option<f64> {
        let to_center = self.center - query.origin;
        let a = query.direction.length_squared();
        let b = to_center.dot(query.direction);
        let discriminant = b * b - a * (to_center.length_squared() - self.radius * self.radius);
        let t = (b - discriminant.sqrt()) / a;
        (0.0..=query.t_max).contains(&t).then_some(t)
    }

    /// A box with room for the rounding of f32 rays of this test.
    pub fn bounds(&self) -> Box32 {
        let reach = DVec3::splat(self.radius * 1.001);
        Box32 {
            lower: (self.center - reach).as_vec3().to_array(),
            upper: (self.center + reach).as_vec3().to_array(),
        }
    }
}

impl UserGeometry for Balls {
    type Query = BallQuery;

    fn primitive_count(&self) -> u32 {
        self.0.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.0[primitive as usize].bounds()
    }

    fn intersect(&self, at: Reached, ray: &Ray32, query: &mut BallQuery) -> Option<f32> {
        query.assert_is_of(ray);
        query.visits += 1;
        let t = self.0[at.primitive as usize].enter(query)?;
        let is_better = query.best.is_none_or(|best| (t, at.primitive) < best);
        is_better.then(|| {
            query.best = Some((t, at.primitive));
            (t as f32).next_up()
        })
    }

    fn occluded(&self, at: Reached, ray: &Ray32, query: &mut BallQuery) -> bool {
        query.assert_is_of(ray);
        query.visits += 1;
        self.0[at.primitive as usize].enter(query).is_some()
    }

    one_by_one!();
}

/// Answers for a packet with the answers for its rays.
pub fn intersect_each(
    rays: RaySet,
    t_far: &mut [f32; GREATEST_PACKET],
    mut intersect: impl FnMut(usize) -> Option<f32>,
) -> RaySet {
    let mut hits = RaySet::EMPTY;
    for ray in rays {
        if let Some(end) = intersect(ray) {
            t_far[ray] = end;
            hits.insert(ray);
        }
    }
    hits
}

/// The rays of a packet as Embree gets them.
pub fn rays_of(packet: &BallPacket) -> Rays32 {
    let rays: [Ray32; GREATEST_PACKET] = array::from_fn(|number| packet[number].ray());
    Rays32 {
        origin: array::from_fn(|axis| rays.map(|ray| ray.origin[axis])),
        direction: array::from_fn(|axis| rays.map(|ray| ray.direction[axis])),
        t_far: rays.map(|ray| ray.t_far),
    }
}

impl BallQuery {
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            t_max: f64::INFINITY,
            best: None,
            visits: 0,
        }
    }

    pub fn ray(&self) -> Ray32 {
        Ray32 {
            origin: self.origin.as_vec3().to_array(),
            direction: self.direction.as_vec3().to_array(),
            t_near: 0.0,
            t_far: self.t_max as f32,
        }
    }

    /// Fails if Embree's own ray, as callbacks get it, is another one.
    fn assert_is_of(&self, ray: &Ray32) {
        let own = self.ray();
        assert_eq!((ray.origin, ray.direction), (own.origin, own.direction));
        let found = self.best.map_or(own.t_far, |(t, _)| (t as f32).next_up());
        assert!(ray.t_far == own.t_far || ray.t_far == found, "{ray:?}");
    }

    pub fn brute_force(&self, balls: &[Ball]) -> Option<(f64, u32)> {
        let hits = balls.iter().zip(0..);
        hits.filter_map(|(ball, primitive)| Some((ball.enter(self)?, primitive)))
            .min_by(|a, b| a.partial_cmp(b).expect("t is a number"))
    }
}

/// Balls in the cube [-1, 1]^3.
pub fn random_balls(seed: u64, count: usize) -> Vec<Ball> {
    let mut random = Random::new(seed, 0);
    let mut coordinate = || random.uniform(-1.0, 1.0);
    let centers: Vec<DVec3> = (0..count)
        .map(|_| DVec3::new(coordinate(), coordinate(), coordinate()))
        .collect();
    centers
        .into_iter()
        .map(|center| Ball {
            center,
            radius: random.log_uniform(1e-3, 0.2),
        })
        .collect()
}

/// The ray of a number: from a sphere of radius 4 through the cube, with f32
/// coordinates, so that Embree and brute force see the same one.
pub fn random_query(seed: u64, number: u64) -> BallQuery {
    let mut random = Random::new(seed, number + 1);
    let origin = (random.direction() * 4.0).as_vec3().as_dvec3();
    let target = random.direction() * random.unit();
    let length = random.log_uniform(1e-3, 1e3);
    let direction = ((target - origin) * length).as_vec3().as_dvec3();
    BallQuery::new(origin, direction)
}
