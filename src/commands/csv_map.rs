//! `mavid csv-map FILE`: proposes what the columns of a table mean.

use mavid::config::{CsvProposal, propose_csv_mapping};
use mavid::text;
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::CsvMapArgs;

#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    file: String,
    /// the text of the mapping
    mapping: String,
    unsure: Vec<String>,
    unused_columns: Vec<String>,
}

/// Runs the verb.
pub fn run(json: bool, args: &CsvMapArgs) -> Result<Outcome, CommandError> {
    if let Some(out) = &args.out {
        output::refuse_overwriting(&[&args.table], &[out])?;
    }
    let CsvProposal { toml, unsure, unused, .. } = propose_csv_mapping(&args.table)?;
    if let Some(out) = &args.out {
        output::file(out, &toml)?;
    }
    if json {
        let file = text::path(&args.table);
        return output::json(&Document { schema: 1, file, mapping: toml, unsure, unused_columns: unused })
            .map(|()| Outcome::Done);
    }
    if args.out.is_none() {
        output::file_text(toml.trim_end())?;
    }
    unsure.iter().for_each(|remark| output::message(&format!("not sure of {remark}")));
    if !unused.is_empty() {
        output::message(&format!("columns without a use: {}", text::listed(unused.iter())));
    }
    let map =
        args.out.as_ref().map_or_else(|| "MAP.TOML".to_owned(), |out| text::shell_word(&text::path(out)));
    let table = text::shell_word(&text::path(&args.table));
    output::message(&format!(
        "correct what is wrong, then look at it: mavid inspect {table} --csv-map {map}"
    ));
    Ok(Outcome::Done)
}
