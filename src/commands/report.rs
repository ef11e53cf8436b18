//! `mavid report PATH`: what a command left in a folder, in the form that is asked for.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use mavid::log::{format_of, is_named_like_a_log};
use mavid::text;

use super::{CommandError, Outcome, compare, explain, output};
use crate::cli::{ReportArgs, ReportFormat};

/// The documents that tell of a report in a folder.
const DOCUMENTS: [&str; 2] = [explain::DOCUMENT, compare::DOCUMENT];
/// Where such folders come from.
const WRITERS: &str = "a folder that mavid run, mavid explain --out or mavid compare --out wrote";

/// Runs the verb.
pub fn run(json: bool, args: &ReportArgs) -> Result<Outcome, CommandError> {
    let format = if json { ReportFormat::Json } else { args.format };
    let found = found(&args.path)?;
    let file = found.file(format)?;
    if format == ReportFormat::Html && output::is_terminal() {
        output::text(&text::path(&file))?;
        return Ok(Outcome::Done);
    }
    let content = fs::read_to_string(&file)
        .map_err(|error| CommandError::Input(format!("cannot read {}: {error}", text::path(&file))))?;
    match format {
        ReportFormat::Text => output::text(content.trim_end())?,
        ReportFormat::Md => output::file_text(content.trim_end())?,
        ReportFormat::Json | ReportFormat::Html => output::document(content.trim_end())?,
    }
    Ok(Outcome::Done)
}

/// A folder with a report.
#[derive(Debug, PartialEq, Eq)]
struct Found {
    folder: PathBuf,
    document: &'static str,
}

impl Found {
    /// The report of this folder itself; the newer one where two commands wrote into it.
    fn in_folder(folder: &Path) -> Option<Self> {
        let there = DOCUMENTS.into_iter().filter(|name| folder.join(name).is_file());
        let document = there.max_by_key(|name| modified(&folder.join(name)))?;
        Some(Self { folder: folder.to_owned(), document })
    }

    /// The file of a form.
    fn file(&self, format: ReportFormat) -> Result<PathBuf, CommandError> {
        let name = match format {
            ReportFormat::Md => explain::SUMMARY,
            ReportFormat::Text => explain::TEXT,
            ReportFormat::Html => explain::REPORT,
            ReportFormat::Json => self.document,
        };
        let file = self.folder.join(name);
        if file.is_file() {
            return Ok(file);
        }
        let verb = if self.document == explain::DOCUMENT { "explain" } else { "compare" };
        Err(CommandError::Input(format!(
            "{}: expected {name}, got {}. An earlier mavid may have written the folder: repeat mavid {verb} with --out, or ask for \
             another --format",
            text::path(&self.folder),
            self.document
        )))
    }
}

/// The report of a folder; where it holds none, the newest of the folders in it, as of the flights of a run.
fn found(path: &Path) -> Result<Found, CommandError> {
    if !path.is_dir() {
        return Err(CommandError::Input(no_folder(path)));
    }
    let below = || {
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        let each = entries.filter_map(|entry| Found::in_folder(&entry.path()));
        each.max_by_key(|found| modified(&found.folder.join(found.document)))
    };
    Found::in_folder(path).or_else(below).ok_or_else(|| {
        CommandError::Input(format!(
            "{}: expected {WRITERS}, got a folder without {}. To make a report: mavid explain LOG --mass KG --out {}",
            text::path(path),
            DOCUMENTS.join(" or "),
            text::path(path)
        ))
    })
}

/// What is said of a path that is no folder.
fn no_folder(path: &Path) -> String {
    let named = text::path(path);
    if !path.exists() {
        return format!("{named}: expected {WRITERS}, got nothing: there is no such folder");
    }
    // any text may pass for a table
    let is_log = |takes_columns: bool| !takes_columns || is_named_like_a_log(path);
    if let Some(format) = format_of(path).ok().filter(|format| is_log(format.takes_columns)) {
        return format!(
            "{named}: expected {WRITERS}, got a log ({}). To explain it and print the summary: mavid explain {named} --format md (with --mass KG \
             or --vehicle FILE)",
            format.name
        );
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    format!(
        "{named}: expected {WRITERS}, got a file. Of the folder that holds it: mavid report {}",
        text::path(folder)
    )
}

/// When a file was written; the beginning of time where the system does not say.
fn modified(path: &Path) -> SystemTime {
    fs::metadata(path).and_then(|of| of.modified()).unwrap_or(SystemTime::UNIX_EPOCH)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(name: &str, files: &[&str]) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("mavid-report-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        for file in files {
            let file = folder.join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "x").unwrap();
        }
        folder
    }

    #[test]
    fn a_folder_has_the_forms_that_its_command_wrote() {
        let folder = made("forms", &["explanation.json", "report.md", "flight1/explanation.json"]);
        let own = found(&folder).unwrap();
        assert_eq!(
            (&own.folder, own.document),
            (&folder, "explanation.json"),
            "its own comes before a flight's"
        );
        assert_eq!(own.file(ReportFormat::Md).unwrap(), folder.join("report.md"));
        assert_eq!(own.file(ReportFormat::Json).unwrap(), folder.join("explanation.json"));
        let missing = own.file(ReportFormat::Text).unwrap_err();
        assert_eq!(missing.status(), 2);
        let said = missing.to_string();
        assert!(said.contains("expected report.txt") && said.contains("mavid explain with --out"), "{said}");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_newest_of_the_flights_stands_for_a_folder_without_a_report() {
        let folder = made("flights", &["flight1/explanation.json", "flight2/comparison.json"]);
        let at = |seconds| SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(seconds);
        let date = |file: &str, seconds| {
            let file = fs::File::options().write(true).open(folder.join(file)).unwrap();
            file.set_modified(at(seconds)).unwrap();
        };
        date("flight1/explanation.json", 2000);
        date("flight2/comparison.json", 1000);
        assert_eq!(found(&folder).unwrap().folder, folder.join("flight1"));
        date("flight2/comparison.json", 3000);
        assert_eq!(found(&folder).unwrap().document, "comparison.json");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_is_no_report_says_what_to_do() {
        let folder = made("none", &["notes.md"]);
        let said = |path: &Path| found(path).unwrap_err().to_string();
        assert!(said(&folder).contains("without explanation.json or comparison.json"), "{}", said(&folder));
        assert!(said(&folder.join("gone")).contains("there is no such folder"));
        let file = said(&folder.join("notes.md"));
        assert!(file.contains("got a file") && file.contains("mavid report "), "{file}");
        let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg");
        assert!(said(&log).contains("px4_flight.ulg --format md"), "{}", said(&log));
        fs::remove_dir_all(folder).unwrap();
    }
}
