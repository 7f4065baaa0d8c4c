//! The tables of docs/command-line.md that are made from the command line's definition.
//!
//! A table is between `<!-- made from clap: NAME -->` and `<!-- end -->`. NAME is a
//! command, `every command`, or `exit codes`. The test compares; it rewrites the tables in
//! `CYLTRACE_UPDATE=1 cargo test --release -p cyltrace-cli reference`.

use std::fmt::Write;
use std::{env, fs};

use clap::{Arg, Args, Command, CommandFactory};

use super::arguments::{Arguments, Common};
use super::exit_codes;

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/command-line.md");
const BEGIN: &str = "<!-- made from clap: ";
const BEGIN_END: &str = " -->\n";
const END: &str = "<!-- end -->";

/// The document with its tables made anew, and the names of the tables.
fn remade(document: &str) -> (String, Vec<&str>) {
    let mut sections = document.split(BEGIN);
    let mut text = sections.next().expect("split gives one part").to_owned();
    let mut names = Vec::new();
    for section in sections {
        let (name, rest) = section.split_once(BEGIN_END).expect("a closed comment");
        let (_, rest) = rest.split_once(END).expect("an end of the table");
        let _ = write!(text, "{BEGIN}{name}{BEGIN_END}{}{END}{rest}", table(name));
        names.push(name);
    }
    (text, names)
}

/// The table of a name.
fn table(name: &str) -> String {
    match name {
        "exit codes" => {
            let rows = exit_codes::TABLE.map(|(code, meaning)| [code.to_string(), meaning.into()]);
            rows_of(["code", "meaning"], rows)
        }
        "every command" => {
            let command = Common::augment_args(Command::new("every"));
            rows_of(["option", "meaning"], command.get_arguments().map(row))
        }
        _ => {
            let mut command = &Arguments::command();
            for word in name.split(' ') {
                let known = command.find_subcommand(word);
                command = known.unwrap_or_else(|| panic!("there is no command {name}"));
            }
            // An option of every command has a row here only if its help is another one.
            let common = Common::augment_args(Command::new("every"));
            let is_own = |arg: &&Arg| common.get_arguments().all(|one| row(one) != row(arg));
            rows_of(
                ["option", "meaning"],
                command.get_arguments().filter(is_own).map(row),
            )
        }
    }
}

fn rows_of(headings: [&str; 2], rows: impl IntoIterator<Item = [String; 2]>) -> String {
    let mut text = format!("| {} |\n|---|---|\n", headings.join(" | "));
    for row in rows {
        let _ = writeln!(
            text,
            "| {} |",
            row.map(|cell| cell.replace('|', "\\|")).join(" | ")
        );
    }
    text
}

/// An argument as a row: its names and value, its help, its values and its default.
fn row(arg: &Arg) -> [String; 2] {
    let short = arg.get_short().map(|short| format!("`-{short}`, "));
    let long = arg.get_long().map(|long| format!("--{long}"));
    let value = arg.get_num_args().is_none_or(|count| count.takes_values());
    let value = value && arg.get_action().takes_values();
    let value = value.then(|| format!("<{}>", arg.get_value_names().expect("a name")[0]));
    let name: Vec<String> = long.into_iter().chain(value).collect();

    let help = arg.get_long_help().or(arg.get_help());
    let help = help.unwrap_or_else(|| panic!("{} has no help", arg.get_id()));
    let help = help.to_string();
    let mut meaning = match help.split_once(" [default: ") {
        Some((text, default)) => format!("{text}. Default: {}", default.trim_end_matches(']')),
        None => help,
    };
    meaning += ".";
    let values = arg.get_possible_values();
    if arg.get_action().takes_values() && !values.is_empty() {
        let values = values.iter().map(|value| match value.get_help() {
            Some(help) => format!("`{}` ({help})", value.get_name()),
            None => format!("`{}`", value.get_name()),
        });
        meaning += &format!(" One of {}.", values.collect::<Vec<_>>().join(", "));
    }
    if let [default] = arg.get_default_values()
        && arg.get_action().takes_values()
    {
        meaning += &format!(" Default: `{}`.", default.to_string_lossy());
    }
    let name = format!("{}`{}`", short.unwrap_or_default(), name.join(" "));
    [name, meaning]
}

/// The names of the commands that run something.
fn commands(command: &Command, above: &str) -> Vec<String> {
    let mut names = Vec::new();
    for command in command.get_subcommands() {
        let name = format!("{above}{}", command.get_name());
        if command.has_subcommands() {
            names.extend(commands(command, &format!("{name} ")));
        } else {
            names.push(name);
        }
    }
    names
}

#[test]
fn document_has_the_options_of_every_command() {
    let document = fs::read_to_string(DOCUMENT).expect("the document");
    let (remade, names) = remade(&document);
    for name in commands(&Arguments::command(), "") {
        assert!(names.contains(&name.as_str()), "{name} has no table");
    }
    if env::var_os("CYLTRACE_UPDATE").is_some() {
        fs::write(DOCUMENT, remade).expect("the document is written");
        return;
    }
    for (number, (found, expected)) in document.lines().zip(remade.lines()).enumerate() {
        assert_eq!(
            found,
            expected,
            "docs/command-line.md:{}: update with CYLTRACE_UPDATE=1 cargo test --release -p cyltrace-cli reference",
            number + 1
        );
    }
    assert_eq!(document.len(), remade.len());
}
