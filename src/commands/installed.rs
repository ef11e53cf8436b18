//! `mavid completions SHELL`, `mavid man DIR` and `mavid schema VERB`: what is installed beside the program.

use std::path::Path;

use clap::CommandFactory;
use clap_mangen::Man;
use mavid::report::document_schema;

use super::{CommandError, Outcome, output};
use crate::cli::{Cli, CompletionsArgs, ManArgs, SchemaArgs};

/// Prints completions.
pub fn completions(args: &CompletionsArgs) -> Result<Outcome, CommandError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "mavid", &mut script);
    output::document(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Outcome::Done)
}

/// Prints the schema of a document.
pub fn schema(args: &SchemaArgs) -> Result<Outcome, CommandError> {
    output::json(&document_schema(&args.verb))?;
    Ok(Outcome::Done)
}

/// Writes a page for the program and for each of its verbs.
pub fn man(json: bool, args: &ManArgs) -> Result<Outcome, CommandError> {
    output::folder(&args.folder)?;
    let mut command = Cli::command();
    command.build();
    let mut pages = Vec::new();
    write_pages(&command, &args.folder, &mut pages)?;
    if json {
        output::json(&serde_json::json!({ "schema": 1, "pages": pages }))?;
    } else {
        output::text(&format!("{} pages in {}", pages.len(), mavid::text::path(&args.folder)))?;
    }
    Ok(Outcome::Done)
}

fn write_pages(command: &clap::Command, folder: &Path, pages: &mut Vec<String>) -> Result<(), CommandError> {
    let page = Man::new(command.clone().override_usage(synopsis(command)));
    let name = page.get_filename();
    let mut text = Vec::new();
    page.render(&mut text).map_err(|error| CommandError::Failure(format!("cannot write {name}: {error}")))?;
    output::bytes(&folder.join(&name), &text)?;
    pages.push(name);
    let verbs = command.get_subcommands().filter(|verb| !verb.is_hide_set() && verb.get_name() != "help");
    verbs.into_iter().try_for_each(|verb| write_pages(verb, folder, pages))
}

/// What stands for all options in a usage.
const OPTIONS: &str = "[OPTIONS]";

/// How a command is called, a form a line: its usage, with every option and its value in the place of [`OPTIONS`].
fn synopsis(command: &clap::Command) -> String {
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage:").trim();
    let is_meant = |option: &&clap::Arg| {
        // what is required stands in the usage itself
        !option.is_positional() && !option.is_hide_set() && !usage.contains(&option.to_string())
    };
    let options = command.get_arguments().filter(is_meant).map(|option| format!("[{option}]"));
    usage.replace(OPTIONS, &options.collect::<Vec<_>>().join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every option of the command and of those below it stands in their synopses, with its value.
    fn is_whole(command: &clap::Command) {
        let said = synopsis(command);
        assert!(!said.contains(OPTIONS) && said.starts_with("mavid"), "{said}");
        let options =
            command.get_arguments().filter(|option| !option.is_hide_set() && !option.is_positional());
        options.for_each(|option| assert!(said.contains(&option.to_string()), "{option}: {said}"));
        command.get_subcommands().filter(|verb| verb.get_name() != "help").for_each(is_whole);
    }

    #[test]
    fn a_synopsis_names_the_value_of_each_option() {
        let mut command = Cli::command();
        command.build();
        is_whole(&command);
        let of = |name: &str| synopsis(command.find_subcommand(name).unwrap());
        let explain = of("explain");
        assert!(explain.contains("<--vehicle <FILE>|--mass <KG>> <LOG>..."), "{explain}");
        assert!(explain.contains("[--out <DIR>]") && explain.contains("[--transient <S>]"), "{explain}");
        // what is required is named once
        assert_eq!(explain.matches("--mass <KG>").count(), 1, "{explain}");
        assert_eq!(of("fleet").lines().count(), 2, "{}", of("fleet"));
    }
}
