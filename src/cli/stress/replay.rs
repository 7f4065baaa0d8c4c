//! `cyltrace stress --replay`: one case, and what everyone says of it.

use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::oracle;
use cyltrace::report::Table;
use cyltrace::solid::formulations::{Formulation, Problem};
use cyltrace::stress::from_bits;

use crate::cli::print::print;

/// Prints the case of a word and the answers to it.
pub fn run(word: &str, formulations: &[Box<dyn Formulation>]) -> anyhow::Result<()> {
    let problem = from_bits(word)?;
    let Problem { cylinder, ray } = &problem;
    let (p0, p1, o, d) = (cylinder.p0(), cylinder.p1(), ray.origin, ray.direction);
    let mut text = format!(
        "p0        {:?} {:?} {:?}\np1        {:?} {:?} {:?}\nradius    {:?}\ncaps      {:?}\n",
        p0.x,
        p0.y,
        p0.z,
        p1.x,
        p1.y,
        p1.z,
        cylinder.radius(),
        cylinder.caps()
    );
    text += &format!(
        "origin    {:?} {:?} {:?}\ndirection {:?} {:?} {:?}\nrange     {:?} {:?}\n",
        o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max
    );

    let truth = oracle::first_hit(cylinder, ray);
    let gap = oracle::gap(cylinder, ray, truth.hit.as_ref());
    text += &format!(
        "gap       {gap:e}, {:e} units of 2^-53\n",
        gap / UNIT_ROUNDOFF
    );

    let mut table = Table::new(&["who", "in", "part", "t", "normal"], 5);
    let row = |who: &str, precision: &str, found: Option<(&str, f64, glam::DVec3)>| {
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
    let exact = truth.hit.as_ref().map(|hit| {
        let normal = oracle::outward_normal(cylinder, ray, hit);
        (hit.part.name(), hit.t_f64(), normal)
    });
    table.push(row("oracle", "", exact));
    for formulation in formulations {
        let answer = formulation.answers(&[problem])[0];
        let found = answer.map(|answer| (answer.part.name(), answer.t, answer.normal));
        table.push(row(
            formulation.name(),
            formulation.precision().name(),
            found,
        ));
    }
    print(&format!("{text}{table}"))
}
