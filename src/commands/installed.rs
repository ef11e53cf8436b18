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
    let page = Man::new(command.clone());
    let name = page.get_filename();
    let mut text = Vec::new();
    page.render(&mut text).map_err(|error| CommandError::Failure(format!("cannot write {name}: {error}")))?;
    output::bytes(&folder.join(&name), &text)?;
    pages.push(name);
    let verbs = command.get_subcommands().filter(|verb| !verb.is_hide_set() && verb.get_name() != "help");
    verbs.into_iter().try_for_each(|verb| write_pages(verb, folder, pages))
}
