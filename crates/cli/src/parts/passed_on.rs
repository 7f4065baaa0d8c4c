//! The options of `render` that each of its workers has too.

use std::ffi::OsString;
use std::thread;

use anyhow::Context;
use clap::ValueEnum;

use crate::arguments::RenderArguments;

/// The arguments of a worker, without its part and its output.
pub fn passed_on(arguments: &RenderArguments, workers: usize) -> anyhow::Result<Vec<OsString>> {
    let common = &arguments.common;
    let mut words: Vec<OsString> = vec!["render".into(), "--quiet".into(), "--resume".into()];
    let mut option = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            words.push(format!("--{name}={value}").into());
        }
    };
    let size = arguments
        .size
        .map(|size| format!("{}x{}", size.width, size.height));
    option("size", size);
    option("spp", arguments.spp.map(|spp| spp.to_string()));
    option(
        "integrator",
        arguments.integrator.as_ref().and_then(name_of),
    );
    option(
        "sampler",
        arguments.sampler.map(|one| one.name().to_owned()),
    );
    option("seed", Some(arguments.seed.to_string()));
    let picture = &arguments.picture;
    let channels: Vec<_> = picture.channels.iter().map(|group| group.name()).collect();
    option(
        "channels",
        (!channels.is_empty()).then(|| channels.join(",")),
    );
    option("exposure", picture.exposure.map(|stops| stops.to_string()));
    option("tonemap", picture.tonemap.map(|one| one.name().to_owned()));
    option("error", picture.error.map(|error| error.to_string()));
    let share = arguments
        .memory
        .max_memory
        .map(|bytes| bytes / workers as u64);
    option("max-memory", share.map(|bytes| format!("{bytes}B")));
    option("layout", name_of(&arguments.memory.layout));
    option("max-isa", common.max_isa.map(|isa| isa.name().to_owned()));
    let all = match common.threads {
        Some(threads) => threads,
        None => thread::available_parallelism().context("cannot count the processors")?,
    };
    option("threads", Some((all.get() / workers).max(1).to_string()));
    if arguments.decisions.exact {
        words.push("--exact".into());
    }
    words.push("--".into());
    words.push(arguments.scene.clone().into());
    Ok(words)
}

fn name_of(value: &impl ValueEnum) -> Option<String> {
    Some(value.to_possible_value()?.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::*;
    use crate::arguments::{Arguments, Command};

    /// Options that a worker does not have, or that have its own values.
    const OWN: [&str; 12] = [
        "output",
        "json",
        "quiet",
        "part",
        "resume",
        "workers",
        "parts",
        "time",
        "frames",
        "orbit",
        "checkpoint",
        "denoise",
    ];

    fn render(words: &[OsString]) -> RenderArguments {
        let program = [OsString::from("cyltrace")];
        let words = program.iter().chain(words);
        match Arguments::try_parse_from(words).expect("valid").command {
            Command::Render(arguments) => arguments,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn every_option_of_render_reaches_the_workers() {
        let line = "render -o p.png --size 3x2 --spp 5 --integrator ao --sampler random --seed 7 --max-memory 1GB \
                    --layout block --exact --threads 6 --max-isa avx2 --channels ids,depth --exposure -0.5 \
                    --tonemap agx --error 0.05 --workers 2 -- -s.toml";
        let words: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
        let arguments = render(&words);
        let mut passed = passed_on(&arguments, 2).expect("processors");
        let command = Arguments::command();
        let command = command.find_subcommand("render").expect("a command");
        let options = command.get_arguments().filter_map(|arg| arg.get_long());
        for option in options.filter(|option| !OWN.contains(option)) {
            let begins = |word: &OsString| {
                let word = word.to_str().expect("UTF-8");
                word.strip_prefix("--")
                    .is_some_and(|word| word.starts_with(option))
            };
            assert!(passed.iter().any(begins), "--{option} is not passed on");
        }
        passed.splice(1..1, ["-o", "part", "--part=1/2"].map(OsString::from));
        let worker = render(&passed);
        let stated = |arguments: &RenderArguments| {
            let layout = arguments.memory.layout;
            let integrator = format!("{:?}", arguments.integrator);
            let scene = arguments.scene.clone();
            let numbers = (
                arguments.size,
                arguments.spp,
                arguments.seed,
                arguments.sampler,
            );
            let picture = format!("{:?}", arguments.picture);
            let max_isa = arguments.common.max_isa;
            (
                scene,
                numbers,
                picture,
                integrator,
                layout,
                arguments.decisions.exact,
                max_isa,
            )
        };
        assert_eq!(stated(&worker), stated(&arguments));
        // Half of the threads and of the memory.
        assert_eq!(worker.common.threads.map(usize::from), Some(3));
        assert_eq!(worker.memory.max_memory, Some(500_000_000));
    }
}
