//! What follows every flight: its recording is identified and explained, and the results lie beside it.

use std::path::{Path, PathBuf};

use mavid::fly;
use mavid::report::{IdentificationDocument, explanation_answer, identification_text};
use mavid::study::{AfterFlight, ExplainStudy, IdentifyStudy, after_flight};
use mavid::text;
use mavid::wire::SystemId;

use super::explain::{self, REPORT};
use super::identify::Targets;
use super::progress::Quiet;
use super::{CommandError, Outcome, output};

/// Folder of the explanation in that of the flight.
const EXPLAINED: &str = "explained";
/// Names of what is written of the parameters.
const MODEL: &str = "model.toml";
const CHART: &str = "parameters.svg";
const PAGE: &str = "identification.txt";
const DOCUMENT: &str = "identification.json";

/// What a flight says; a part that it cannot say, or that could not be written, holds why.
#[derive(Debug)]
pub struct Analysis {
    /// written beside the recording
    pub identified: Result<IdentifyStudy, String>,
    /// written into a folder of its own
    pub explained: Result<ExplainStudy, String>,
    folder: PathBuf,
}

impl Analysis {
    /// Of the flight in this folder; none of one that did not land. Results of an earlier flight go: beside this
    /// one's recording they would pass for its own.
    pub fn of(
        (folder, landed): (&Path, bool),
        vehicle: &Path,
        system: Option<SystemId>,
    ) -> Result<Option<Self>, CommandError> {
        let parameters = [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(|name| folder.join(name));
        let explanation = explain::WRITTEN.map(|name| folder.join(EXPLAINED).join(name));
        // a model that was flown by is what this flight's own are compared with
        for path in parameters.iter().chain(&explanation).filter(|path| !output::is_same(path, vehicle)) {
            output::outdated(path)?;
        }
        Ok(landed.then(|| Self::made(folder, vehicle, system)))
    }

    fn made(folder: &Path, vehicle: &Path, system: Option<SystemId>) -> Self {
        let AfterFlight { identified, explained } =
            after_flight(&folder.join(fly::TLOG), vehicle, system, &Quiet);
        let identified = kept("identified", identified, |study| write_parameters(study, folder));
        let explained = kept("explained", explained, |study| explain::write(study, &folder.join(EXPLAINED)));
        Self { identified, explained, folder: folder.to_owned() }
    }

    /// Where the report lies, if there is one.
    pub fn report(&self) -> Option<PathBuf> {
        self.explained.is_ok().then(|| self.folder.join(EXPLAINED).join(REPORT))
    }

    /// For people: parameters, then the explanation's answer and where its report lies.
    pub fn page(&self) -> String {
        let mut parts: Vec<String> = self.identified.iter().map(identification_text).collect();
        let parameters = self.folder.join(REPORT);
        parts.extend(
            self.identified.iter().map(|_| format!("report of the parameters: {}", text::path(&parameters))),
        );
        parts.extend(self.explained.iter().map(explanation_answer));
        parts.extend(self.report().map(|path| format!("report: {}", text::path(&path))));
        parts.join("\n\n")
    }

    /// The first part that failed, and otherwise what was lost, which it says.
    pub fn outcome(&self) -> Result<Outcome, CommandError> {
        let failed = |why: &String| CommandError::Failure(why.clone());
        self.identified.as_ref().map_err(failed)?;
        self.explained.as_ref().map_err(failed).map(explain::tell)
    }
}

/// The study, if there is one and it was written; says what is missing and why.
fn kept<S>(
    what: &str,
    study: Result<S, mavid::study::StudyError>,
    write: impl Fn(&S) -> Result<(), CommandError>,
) -> Result<S, String> {
    let written = study.map_err(CommandError::from).and_then(|study| write(&study).map(|()| study));
    written.map_err(|error| {
        output::message(&format!("not {what}: {error}"));
        error.to_string()
    })
}

fn write_parameters(study: &IdentifyStudy, folder: &Path) -> Result<(), CommandError> {
    let place = |name| Some(folder.join(name));
    Targets { model: place(MODEL), report: place(REPORT), chart: place(CHART) }.write(study)?;
    output::file(&folder.join(PAGE), &format!("{}\n", identification_text(study)))?;
    output::file(&folder.join(DOCUMENT), &output::json_text(&IdentificationDocument::new(study))?)
}
