//! `cyltrace stress --replay`: one case, and the answer of every solver.

use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::solid::AnySolid;
use cyltrace_bench::stress::{Contender, StressCase, from_word};
use cyltrace_oracle::cases::Case;
use cyltrace_output::Table;
use glam::DVec3;

use super::composed::{self, row_of};
use crate::print::print;

/// Prints the case of a word and the answers to it.
pub fn run(word: &str, contenders: &[Contender]) -> anyhow::Result<()> {
    let case = match from_word(word)? {
        StressCase::Solid(case) => case,
        StressCase::Composed(case) => return composed::run(&case),
    };
    let Case { solid, ray } = &case;
    let mut text = match solid {
        AnySolid::Cylinder(cylinder) => format!(
            "{}{}radius    {:?}\ncaps      {:?}\n",
            row_of("p0", cylinder.p0()),
            row_of("p1", cylinder.p1()),
            cylinder.radius(),
            cylinder.caps()
        ),
        other => format!("solid     {other:?}\n"),
    };
    text += &row_of("origin", ray.origin);
    text += &row_of("direction", ray.direction);
    text += &format!("range     {:?} {:?}\n", ray.t_min, ray.t_max);

    let truth = cyltrace_oracle::first_hit_of_any(solid, ray);
    let gap = cyltrace_oracle::gap_of_any(solid, ray);
    text += &format!(
        "gap       {gap:e}, {:e} units of 2^-53\n",
        gap / UNIT_ROUNDOFF
    );

    let mut table = Table::new(&["who", "in", "part", "t", "normal"], 5);
    let row = |who: &str, precision: &str, found: Option<(&str, f64, DVec3)>| {
        let (part, t, normal) = match found {
            Some((part, t, n)) => (
                part,
                format!("{t:?}"),
                format!("{:?} {:?} {:?}", n.x, n.y, n.z),
            ),
            None => ("miss", String::new(), String::new()),
        };
        vec![
            who.to_owned(),
            precision.to_owned(),
            part.to_owned(),
            t,
            normal,
        ]
    };
    let exact = truth.as_ref().map(|hit| {
        let normal = cyltrace_oracle::outward_normal_of_any(solid, ray, hit);
        (hit.part.name(), hit.t_f64(), normal.unwrap_or(DVec3::NAN))
    });
    table.push(row("oracle", "", exact));
    for contender in contenders
        .iter()
        .filter(|one| one.kind() == Some(solid.kind()))
    {
        let answer = contender.answers(&[case])[0];
        let found = answer.map(|answer| (answer.part.name(), answer.t, answer.normal));
        table.push(row(contender.name(), contender.precision().name(), found));
    }
    print(&format!("{text}{table}"))
}
