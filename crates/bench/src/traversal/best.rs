//! The summary: this library's fastest mode beside Embree's own geometry in its
//! fastest mode and order of rays, and the ratios to all rivals.

use super::outcome::{Figures, RIVALS, Ratio, Traversal, ratio_key};
use super::rays::Kind;
use super::representation::Representation;
use super::scenes::SceneName;
use crate::rivals::Shape;
use cyltrace_output::figure as short;

/// Each side at its best, on the first set of workers' threads.
pub struct Best<'a> {
    /// The scene.
    pub scene: SceneName,
    /// The rays.
    pub rays: Kind,
    /// How many times faster this library is, and the two modes; or why it is unknown.
    pub ratio: Result<Ratio, String>,
    /// The figures of this library's mode, and of the rival's.
    pub figures: Option<[&'a Figures; 2]>,
}

/// The columns of [`Best::cells`].
pub const BEST_HEADINGS: [&str; 12] = [
    "scene",
    "rays",
    "ours",
    "Embree's own",
    "order",
    "ours, ns",
    "its ns",
    "times as fast",
    "ours wrong %",
    "its wrong %",
    "our bytes",
    "its bytes",
];

/// How many columns of [`BEST_HEADINGS`] are names.
pub const BEST_NAMES: usize = 5;

impl Traversal {
    /// By scene and kind of rays, this library beside the fastest of Embree's own geometry.
    #[must_use]
    pub fn best(&self) -> Vec<Best<'_>> {
        let scenes = self.scenes.iter();
        let all = scenes.flat_map(|&scene| Kind::ALL.map(|rays| (scene, rays)));
        all.map(|(scene, rays)| self.best_of(scene, rays)).collect()
    }

    fn best_of(&self, scene: SceneName, rays: Kind) -> Best<'_> {
        let ratio = self.ratio(scene, rays, Representation::is_own);
        let figures = |one: Representation| {
            let mut rows = self.rows.iter().filter(|row| {
                row.scene == scene
                    && row.rays == rays
                    && row.representation == one
                    && self.threads.first() == Some(&row.threads)
            });
            rows.next()?.found.as_ref().ok()
        };
        let sides = ratio.as_ref().ok().map(|ratio| [ratio.ours, ratio.rival]);
        Best {
            scene,
            rays,
            figures: sides.and_then(|[ours, rival]| Some([figures(ours)?, figures(rival)?])),
            ratio,
        }
    }
}

impl Best<'_> {
    /// The row, rounded for people; dashes for unknown figures.
    #[must_use]
    pub fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.scene.name().to_owned(), self.rays.name().to_owned()];
        let (Ok(ratio), Some([ours, rival])) = (&self.ratio, self.figures) else {
            cells.resize(BEST_HEADINGS.len(), String::from("–"));
            return cells;
        };
        cells.extend([
            ratio.ours.to_string(),
            ratio.rival.to_string(),
            ratio.order.name().to_owned(),
            format!("{:.0}", ours.ns.median),
            format!("{:.0}", rival.ns.median),
            format!("{:.2} ± {:.2}", ratio.spread.median, ratio.spread.deviation),
            short(ours.wrong_percent),
            short(rival.wrong_percent),
            format!("{:.0}", ours.bytes_per_cylinder),
            format!("{:.0}", rival.bytes_per_cylinder),
        ]);
        cells
    }
}

/// The headings and the rows of all ratios: a column for each rival that some scene has.
pub(super) fn ratio_table(found: &Traversal) -> (Vec<String>, Vec<Vec<String>>) {
    let scenes = found.scenes.iter();
    let cases: Vec<_> = scenes
        .flat_map(|&scene| Kind::ALL.map(|rays| (scene, rays)))
        .collect();
    let is_measured = |rival: &Shape| {
        let mut cases = cases.iter();
        cases.any(|&(scene, rays)| found.ratio_to(scene, rays, *rival).is_ok())
    };
    let rivals: Vec<Shape> = RIVALS.into_iter().filter(is_measured).collect();
    let mut headings = vec![String::from("scene"), String::from("rays")];
    headings.extend(rivals.iter().map(|&rival| ratio_key(rival)));
    let row = |&(scene, rays): &(SceneName, Kind)| {
        let mut cells = vec![scene.name().to_owned(), rays.name().to_owned()];
        cells.extend(rivals.iter().map(|&rival| {
            let ratio = found.ratio_to(scene, rays, rival);
            ratio.map_or_else(
                |_| String::from("–"),
                |ratio| format!("{:.2} ± {:.2}", ratio.spread.median, ratio.spread.deviation),
            )
        }));
        cells
    };
    let rows = cases.iter().map(row).collect();
    (headings, rows)
}

#[cfg(test)]
mod tests {
    use super::super::order::Order;
    use super::super::outcome::Row;
    use super::super::representation::Mode;
    use super::*;
    use crate::statistics::Spread;

    fn row(representation: Representation, rays: Kind, ns: f64, ratio: Option<f64>) -> Row {
        let spread = |median| Spread {
            median,
            deviation: 0.25,
        };
        Row {
            scene: SceneName::Forest,
            rays,
            representation,
            threads: 2,
            found: Ok(Figures {
                ns: spread(ns),
                wrong_percent: if ratio.is_some() { 0.5 } else { 0.0 },
                p99_error_r: None,
                bytes_per_cylinder: ns / 2.0,
                build_s: 1.0,
                callbacks_per_ray: None,
                solves_per_ray: None,
                order: ratio.map_or(Order::Given, |_| Order::Sorted),
                ratio: ratio.map(|ratio| (spread(ratio), Representation::Ours(Mode::Packet))),
            }),
        }
    }

    #[test]
    fn best_is_the_mode_compared_and_embree_s_own_fastest() {
        let ours = Representation::Ours;
        let found = Traversal {
            scenes: vec![SceneName::Forest],
            threads: vec![2],
            rows: vec![
                row(ours(Mode::Single), Kind::Coherent, 300.0, None),
                row(ours(Mode::Packet), Kind::Coherent, 200.0, None),
                row(
                    Representation::single(Shape::Cone),
                    Kind::Coherent,
                    500.0,
                    Some(2.5),
                ),
                row(
                    Representation::packets(Shape::Cone),
                    Kind::Coherent,
                    250.0,
                    Some(1.25),
                ),
            ],
        };
        let best = found.best();
        assert_eq!(
            best[0].cells().join("|"),
            "forest|coherent|analytic_packet|embree_cone_packet|sorted|200|250|1.25 ± 0.25|0|0.5|100|125"
        );
        assert_eq!(
            best[1].cells().join("|"),
            "forest|shadow|–|–|–|–|–|–|–|–|–|–"
        );
        assert_eq!(best.len(), 3);
    }
}
