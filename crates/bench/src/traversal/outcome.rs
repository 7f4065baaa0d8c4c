//! What the comparison finds.

use super::order::Order;
use super::rays::Kind;
use super::representation::Representation;
use super::scenes::SceneName;
use crate::rivals::Shape;
use crate::statistics::Spread;

/// The figures of a representation.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Nanoseconds a ray: of all workers together, so that two threads take half.
    pub ns: Spread,
    /// Rays with a wrong answer, of those that the oracle judged.
    pub wrong_percent: f64,
    /// The distance of the answer from the true hit, along the ray, in radii of
    /// the solid that is hit (where it tapers, in the greater one; of a cuboid in its
    /// least half width): the 99th percentile over the rays with the right solid, for
    /// others are wrong. `None` for occlusion rays.
    pub p99_error_r: Option<f64>,
    /// The memory of the scene, records and Embree's, for each stored solid (those of a
    /// prototype count once).
    pub bytes_per_cylinder: f64,
    /// Seconds from the description to what can be traced.
    pub build_s: f64,
    /// Callbacks per ray, if the library counts them.
    pub callbacks_per_ray: Option<f64>,
    /// Solids and blocks tested per ray, if the library counts them.
    pub solves_per_ray: Option<f64>,
    /// The order in which a rival gets the rays: the better one. This library gets them in
    /// the given order and sorts its batches itself.
    pub order: Order,
    /// Its time over that of a mode of this library, and the mode.
    pub ratio: Option<(Spread, Representation)>,
}

impl Figures {
    /// Millions of rays in a second.
    #[must_use]
    pub fn mrays_per_s(&self) -> f64 {
        1e3 / self.ns.median
    }
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The scene.
    pub scene: SceneName,
    /// The rays.
    pub rays: Kind,
    /// The representation.
    pub representation: Representation,
    /// The threads that trace.
    pub threads: usize,
    /// The figures, or the reason why there are none.
    pub found: Result<Figures, String>,
}

/// How many times faster this library is than a rival, each in its fastest mode, the
/// rival in its better order of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The median over the rounds, and its median absolute deviation.
    pub spread: Spread,
    /// The mode of this library.
    pub ours: Representation,
    /// That of the rival.
    pub rival: Representation,
    /// The order in which the rival had the rays.
    pub order: Order,
}

/// The rivals that ratios are to.
pub const RIVALS: [Shape; 7] = [
    Shape::Cone,
    Shape::Round,
    Shape::Sphere,
    Shape::Disk,
    Shape::Mesh(32),
    Shape::Mesh(64),
    Shape::Faces,
];

/// The key of the ratios to a rival.
#[must_use]
pub fn ratio_key(rival: Shape) -> String {
    format!("vs_{}", Representation::single(rival))
}

/// The outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Traversal {
    /// The scenes, in the order of [`Plan::scenes`](super::Plan::scenes).
    pub scenes: Vec<SceneName>,
    /// The threads, in the order of [`Plan::worker_sets`](super::Plan::worker_sets).
    pub threads: Vec<usize>,
    /// The rows: by scene, rays, representation and threads.
    pub rows: Vec<Row>,
}

impl Traversal {
    /// How many times faster this library is, on the first set of workers' threads, than
    /// the fastest of the rivals that `is_rival` accepts. The fastest is the one with the
    /// least ratio: ratios are of neighbouring measurements, times depend on what else the
    /// machine did.
    ///
    /// # Errors
    /// The reasons why no rival was measured.
    pub fn ratio(
        &self,
        scene: SceneName,
        rays: Kind,
        is_rival: impl Fn(Representation) -> bool,
    ) -> Result<Ratio, String> {
        let rows = || {
            self.rows.iter().filter(|row| {
                row.scene == scene
                    && row.rays == rays
                    && self.threads.first() == Some(&row.threads)
                    && is_rival(row.representation)
            })
        };
        let measured = rows().filter_map(|row| {
            let found = row.found.as_ref().ok()?;
            let (spread, ours) = found.ratio?;
            Some(Ratio {
                spread,
                ours,
                rival: row.representation,
                order: found.order,
            })
        });
        measured
            .min_by(|a, b| a.spread.median.total_cmp(&b.spread.median))
            .ok_or_else(|| {
                let reasons = rows().filter_map(|row| row.found.as_ref().err());
                reasons.cloned().collect::<Vec<_>>().join("; ")
            })
    }

    /// The ratio to a shape, whether Embree traces it by packets or not.
    ///
    /// # Errors
    /// As for [`Traversal::ratio`].
    pub fn ratio_to(&self, scene: SceneName, rays: Kind, shape: Shape) -> Result<Ratio, String> {
        self.ratio(scene, rays, |rival| rival.shape() == Some(shape))
    }

    /// The rows of this library with a wrong answer.
    pub fn wrong(&self) -> impl Iterator<Item = &Row> {
        let is_wrong = |row: &&Row| {
            let found = row.found.as_ref();
            row.representation.is_ours() && found.is_ok_and(|one| one.wrong_percent > 0.0)
        };
        self.rows.iter().filter(is_wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::super::representation::Mode;
    use super::*;

    fn spread(median: f64) -> Spread {
        Spread {
            median,
            deviation: 0.0,
        }
    }

    fn row(representation: Representation, threads: usize, found: Option<(f64, f64)>) -> Row {
        let figures = |(ns, ratio): (f64, f64)| Figures {
            ns: spread(ns),
            wrong_percent: 0.0,
            p99_error_r: None,
            bytes_per_cylinder: 1.0,
            build_s: 1.0,
            callbacks_per_ray: None,
            solves_per_ray: None,
            order: Order::Sorted,
            ratio: Some((spread(ratio), Representation::Ours(Mode::Block))),
        };
        Row {
            scene: SceneName::Sticks1e4,
            rays: Kind::Coherent,
            representation,
            threads,
            found: found
                .map(figures)
                .ok_or_else(|| format!("no {representation}")),
        }
    }

    #[test]
    fn ratio_is_to_the_faster_mode_of_the_rival_on_the_first_workers() {
        let cone = Representation::single(Shape::Cone);
        let packets = Representation::packets(Shape::Cone);
        let mesh = Representation::single(Shape::Mesh(32));
        let mut found = Traversal {
            scenes: vec![SceneName::Sticks1e4],
            threads: vec![1, 2],
            rows: vec![
                row(cone, 1, Some((300.0, 3.0))),
                row(cone, 2, Some((10.0, 9.0))),
                // Timed while the machine was slower, so its time says less than its ratio.
                row(packets, 1, Some((400.0, 2.0))),
                row(mesh, 1, None),
            ],
        };
        let ratio =
            |found: &Traversal, shape| found.ratio_to(SceneName::Sticks1e4, Kind::Coherent, shape);
        let best = ratio(&found, Shape::Cone).unwrap();
        assert_eq!((best.spread.median, best.rival), (2.0, packets));
        let block = Representation::Ours(Mode::Block);
        assert_eq!((best.ours, best.order), (block, Order::Sorted));
        assert_eq!(ratio(&found, Shape::Mesh(32)).unwrap_err(), "no mesh_32");
        found.rows[2] = row(packets, 1, None);
        assert_eq!(ratio(&found, Shape::Cone).unwrap().rival, cone);
        assert_eq!(ratio_key(Shape::Disk), "vs_embree_disc");
    }

    #[test]
    fn wrong_is_of_this_library_alone() {
        let packet = Representation::Ours(Mode::Packet);
        let cone = Representation::single(Shape::Cone);
        let mut rows = [Representation::Ours(Mode::Single), packet, cone]
            .map(|one| row(one, 1, Some((1.0, 1.0))))
            .to_vec();
        for row in &mut rows[1..] {
            let found = row.found.as_mut().unwrap();
            found.wrong_percent = 0.1;
        }
        let found = Traversal {
            scenes: vec![SceneName::Sticks1e4],
            threads: vec![1],
            rows,
        };
        let wrong: Vec<Representation> = found.wrong().map(|row| row.representation).collect();
        assert_eq!(wrong, [packet]);
    }
}
