//! `cyltrace stress --map`: a picture of the formulations that are right.

use std::path::Path;

use cyltrace_bench::stress::{Contender, to_bits, ulp_map};
use cyltrace_oracle::cases::{Family, Inputs};
use cyltrace_output::Table;
use cyltrace_output::{Contents, Output};

use crate::arguments::StressArguments;
use crate::print::print;

/// Draws the map of a family into the report's folder, or the current one.
pub fn run(
    arguments: &StressArguments,
    family: Family,
    contenders: &[Contender],
) -> anyhow::Result<()> {
    let inputs = arguments.inputs.unwrap_or(Inputs::F32);
    let directory = arguments.report.as_deref().unwrap_or(Path::new("."));
    let name = format!("ulp_map_{}_{}.png", family.name(), inputs.name());
    let path = directory.join(name);
    Output::check(&path, &Contents::default())?;
    let map = ulp_map(contenders, family, inputs, arguments.seed);
    Output::create(&path, Contents::default())?.write(&map.film)?;
    if arguments.common.prints() {
        let mut table = Table::new(&["tile", "wrong %"], 1);
        for (name, wrong) in &map.tiles {
            table.push(vec![name.clone(), format!("{:.2}", 100.0 * wrong)]);
        }
        print(&format!(
            "{}, tiles from the left of the top row:\n{table}{}\nthe middle of each tile: {}\n",
            path.display(),
            map.legend,
            to_bits(&map.center)
        ))?;
    }
    Ok(())
}
