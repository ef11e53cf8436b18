//! The answer to a command line that asks for help, or that cannot be parsed.

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use mavid::text::{self, to_width};

use super::columns::of_terminal;
use super::error_document;
use super::standard_error::help_has_colors;
use crate::cli::{Cli, color_of, is_json};

/// Exit status of a command line that cannot be parsed.
const MISTAKE: u8 = 2;

/// What is wrong, without the usage below it.
fn reason(rendered: &str) -> String {
    let lines = rendered.lines().map(str::trim).take_while(|line| !line.is_empty());
    let said = lines.collect::<Vec<_>>().join(" ");
    said.strip_prefix("error: ").map_or(said.clone(), str::to_owned)
}

/// Help and version on standard output with status 0, a mistake on standard error with status 2. On a terminal no word is broken.
pub fn usage(usage: clap::Error) -> ExitCode {
    // an argument may command the terminal as any other text: told is what is wrong with one that does not
    let shown: Vec<OsString> = std::env::args_os().map(|argument| text::path(&argument).into()).collect();
    let (color, json) = (color_of(&shown), is_json(&shown));
    let usage = Cli::of(shown).err().unwrap_or(usage);
    let is_mistake = usage.use_stderr();
    let is_terminal = if is_mistake { io::stderr().is_terminal() } else { io::stdout().is_terminal() };
    let printed = match of_terminal().filter(|_| is_terminal) {
        Some(columns) => {
            let rendered = usage.render();
            let has_colors = help_has_colors(color, is_terminal);
            let page = if has_colors { rendered.ansi().to_string() } else { rendered.to_string() };
            let lines = page.split('\n').flat_map(|line| to_width(line, columns)).collect::<Vec<_>>();
            let page = lines.join("\n");
            if is_mistake {
                io::stderr().write_all(page.as_bytes())
            } else {
                io::stdout().write_all(page.as_bytes())
            }
        }
        None => usage.print(),
    };
    if is_mistake && json {
        error_document::print(vec![reason(&usage.render().to_string())], MISTAKE);
    }
    match (is_mistake, printed) {
        (true, _) => ExitCode::from(MISTAKE),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(_)) => ExitCode::FAILURE,
    }
}
