//! The answer to a command line that asks for help, or that cannot be parsed.

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use mavid::text::{self, to_width};

use super::columns::of_terminal;
use super::standard_error::help_has_colors;
use crate::cli::{Cli, color_of};

/// Help and version on standard output with status 0, a mistake on standard error with status 2. On a terminal no word is broken.
pub fn usage(usage: clap::Error) -> ExitCode {
    // an argument may command the terminal as any other text: told is what is wrong with one that does not
    let shown: Vec<OsString> = std::env::args_os().map(|argument| text::path(&argument).into()).collect();
    let color = color_of(&shown);
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
    match (is_mistake, printed) {
        (true, _) => ExitCode::from(2),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(_)) => ExitCode::FAILURE,
    }
}
