//! `cyltrace completions` and `cyltrace man`: what shells and `man` know of the command
//! line, made from its definition.

use std::path::Path;

use anyhow::Context;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use cyltrace_output::write_text;

use super::arguments::{Arguments, CompletionsArguments, ManArguments};
use super::output_sink::make_directory;
use super::print::print;

/// Prints the completion script of a shell.
pub fn completions(arguments: &CompletionsArguments) -> anyhow::Result<()> {
    let mut script = Vec::new();
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    print(&String::from_utf8(script)?)
}

/// Prints the page of the program, or writes the pages of all commands to a folder.
pub fn man(arguments: &ManArguments) -> anyhow::Result<()> {
    let mut command = Arguments::command();
    // Names the pages of commands, such as cyltrace-bench-scale.
    command.build();
    match &arguments.directory {
        Some(directory) => {
            make_directory(directory)?;
            write_pages(&command, directory)
        }
        None => print(&page(&command)?),
    }
}

/// Writes the page of a command and those of its own commands.
fn write_pages(command: &Command, directory: &Path) -> anyhow::Result<()> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    write_text(&directory.join(format!("{name}.1")), &page(command)?)?;
    let commands = command.get_subcommands();
    commands
        .filter(|command| command.get_name() != "help")
        .try_for_each(|command| write_pages(command, directory))
}

/// A page of the manual in roff.
fn page(command: &Command) -> anyhow::Result<String> {
    let mut page = Vec::new();
    Man::new(command.clone())
        .render(&mut page)
        .context("cannot make the manual page")?;
    Ok(String::from_utf8(page)?)
}
