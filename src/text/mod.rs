//! Text that others wrote: what a vehicle says, names in files, columns, paths, and what errors quote of them.
//!
//! All of it passes through here where it enters, before it is stored, shown or written to a file. Characters that
//! command a terminal, break a line or turn the direction of reading become visible escapes such as `\u{1b}`; whoever
//! writes a format then escapes for that format (XML, Python, TOML, JSON, HTML), for which what is ordinary here may
//! still mean something.

mod escape;
mod excerpt;
mod format;
mod json;
mod list;
mod number;
mod quantity;
mod sentence;
mod utc;
mod wrap;

pub use escape::{clean, clean_lines, is_command};
pub use excerpt::{excerpt, listed, path};
pub use format::{line_comment, markup, markup_comment, shell_word, toml_string};
pub use json::{json_line, json_pretty};
pub use list::{list, list_or};
pub(crate) use number::rounded;
pub use number::{chance, compact, interval, parameter_value, significant, spoken, to_step, with_error};
pub use quantity::unbroken;
pub use sentence::capital;
pub use utc::utc;
pub use wrap::{to_width, wrapped};
