//! `mavid fleet rows LOG`: the rows of one log.

use std::fs;

use super::child::studied;
use super::identity::identity;
use super::limits::Bounds;
use super::settings::settings;
use crate::cli::FleetRowsArgs;
use crate::commands::{CommandError, Outcome, output};
use mavid::each_table;
use mavid::fleet::{LogRows, LogTask, error_rows, unread_name};
use mavid::table::{Row, to_values};
use mavid::text;
use serde_json::{Map, Value};

/// Runs the verb.
pub fn run(json: bool, args: &FleetRowsArgs) -> Result<Outcome, CommandError> {
    let settings = settings(&args.study)?;
    let bounds = Bounds::of(&args.study);
    let uri = args.uri.clone().unwrap_or_else(|| text::path(&args.log));
    let bytes = fs::metadata(&args.log)
        .map_err(|error| {
            CommandError::Input(format!("{}: expected the file of a log: {error}", text::path(&args.log)))
        })?
        .len();
    let identity = identity(&args.log, &bounds);
    let sha256 = identity.clone().unwrap_or_else(|_| unread_name(&uri, bytes));
    let task = LogTask { uri, path: args.log.clone(), sha256, bytes, settings };
    let rows = match identity {
        Ok(_) => studied(&task, &bounds.limits),
        Err(why) => error_rows(&task, &why),
    };
    let tables = by_table(&rows);
    if json {
        output::json(&tables)?;
    } else {
        for (table, rows) in &tables {
            for row in rows.as_array().into_iter().flatten() {
                output::text(&format!("{table} {row}"))?;
            }
        }
    }
    let failed = rows.logs.iter().any(|log| log.status == "error");
    Ok(if failed { Outcome::DoneWithLoss } else { Outcome::Done })
}

/// The rows by the names of their tables.
fn by_table(rows: &LogRows) -> Map<String, Value> {
    let mut tables = Map::new();
    macro_rules! each {
        ($field:ident, $row:ty) => {
            tables.insert(<$row>::TABLE.to_owned(), Value::from(to_values(&rows.$field)));
        };
    }
    each_table!(each);
    tables
}
