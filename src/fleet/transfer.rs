//! The rows of a log as text, from one process to another, and from one run to the next.

use super::rows::LogRows;
use crate::each_table;
use crate::table::{Row, TableError, from_json_lines, to_json_lines};

/// Before the name of a table.
const HEAD: char = '=';

/// All rows, table by table.
///
/// # Errors
/// [`TableError`] where a value has no form in JSON.
pub fn rows_text(rows: &LogRows) -> Result<String, TableError> {
    let mut out = String::new();
    macro_rules! each {
        ($field:ident, $row:ty) => {
            out.push_str(&format!("{HEAD}{}\n", <$row>::TABLE));
            out.push_str(&to_json_lines(&rows.$field)?);
        };
    }
    each_table!(each);
    out.push_str("=end\n");
    Ok(out)
}

/// The rows of such a text.
///
/// # Errors
/// [`TableError`] where it is cut off or damaged.
pub fn rows_of_text(text: &str) -> Result<LogRows, TableError> {
    let mut rows = LogRows::default();
    if !text.ends_with("=end\n") {
        return Err(TableError::File {
            table: "all",
            why: "expected rows to their end, got a part of them".to_owned(),
        });
    }
    macro_rules! each {
        ($field:ident, $row:ty) => {
            let head = format!("{HEAD}{}\n", <$row>::TABLE);
            let from = text.find(&head).map(|at| &text[at + head.len()..]);
            let own = from.map_or("", |rest| rest.split("\n=").next().unwrap_or(""));
            // an empty table is followed by the next head at once
            if !own.starts_with(HEAD) {
                rows.$field = from_json_lines(own)?;
            }
        };
    }
    each_table!(each);
    Ok(rows)
}
