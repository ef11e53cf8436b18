//! What follows every flight: its recording is identified and explained, and the results lie beside it.

use std::path::{Path, PathBuf};

use mavid::fly;
use mavid::text;

use super::explain::{self, Explained, REPORT};
use super::identify::Identified;
use super::{CommandError, Outcome, output};
use crate::cli::{ExplainArgs, IdentifyArgs, ReadArgs};

/// Folder of the explanation in that of the flight.
const EXPLAINED: &str = "explained";
/// Flight time that `explain` leaves out at the beginning by default, s.
const TRANSIENT_S: f64 = 1.0;

/// Names of what is written of the parameters.
const MODEL: &str = "model.toml";
const CHART: &str = "parameters.svg";
const PAGE: &str = "identification.txt";
const DOCUMENT: &str = "identification.json";

/// What a flight says; a part that it cannot say holds why.
#[derive(Debug)]
pub struct Analysis {
    /// written beside the recording
    pub identified: Result<Identified, String>,
    /// written into a folder of its own
    pub explained: Result<Explained, String>,
    folder: PathBuf,
}

impl Analysis {
    /// Of the flight in this folder; none of one that did not land. Results of an earlier flight go: beside this
    /// one's recording they would pass for its own.
    pub fn of(
        (folder, landed): (&Path, bool),
        vehicle: &Path,
        system: Option<u32>,
    ) -> Result<Option<Self>, CommandError> {
        let parameters = [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(|name| folder.join(name));
        let explanation = explain::WRITTEN.map(|name| folder.join(EXPLAINED).join(name));
        // a model that was flown by is what this flight's own are compared with
        for path in parameters.iter().chain(&explanation).filter(|path| !output::is_same(path, vehicle)) {
            output::outdated(path)?;
        }
        Ok(landed.then(|| Self::made(folder, vehicle, system)))
    }

    fn made(folder: &Path, vehicle: &Path, system: Option<u32>) -> Self {
        let identified = parameters(folder, vehicle, system).map_err(|error| error.to_string());
        let explained = explanation(folder, vehicle, system).map_err(|error| error.to_string());
        for (what, failure) in
            [("identified", identified.as_ref().err()), ("explained", explained.as_ref().err())]
        {
            if let Some(failure) = failure {
                output::message(&format!("not {what}: {failure}"));
            }
        }
        Self { identified, explained, folder: folder.to_owned() }
    }

    /// Where the report lies, if there is one.
    pub fn report(&self) -> Option<PathBuf> {
        self.explained.is_ok().then(|| self.folder.join(EXPLAINED).join(REPORT))
    }

    /// For people: parameters, then the explanation's answer and where its report lies.
    pub fn page(&self) -> String {
        let mut parts: Vec<String> = self.identified.iter().map(Identified::page).collect();
        let parameters = self.folder.join(REPORT);
        parts.extend(
            self.identified.iter().map(|_| format!("report of the parameters: {}", text::path(&parameters))),
        );
        parts.extend(self.explained.iter().map(Explained::answer));
        parts.extend(self.report().map(|path| format!("report: {}", text::path(&path))));
        parts.join("\n\n")
    }

    /// The first part that failed, and otherwise what was lost, which it says.
    pub fn outcome(&self) -> Result<Outcome, CommandError> {
        let failed = |why: &String| CommandError::Failure(why.clone());
        self.identified.as_ref().map_err(failed)?;
        self.explained.as_ref().map_err(failed).map(Explained::outcome)
    }
}

fn parameters(folder: &Path, vehicle: &Path, system: Option<u32>) -> Result<Identified, CommandError> {
    let args = IdentifyArgs {
        logs: vec![folder.join(fly::TLOG)],
        vehicle: vehicle.to_owned(),
        out: Some(folder.join(MODEL)),
        report: Some(folder.join(REPORT)),
        chart: Some(folder.join(CHART)),
        read: ReadArgs { csv_map: None, system },
        transient: None,
        cutoff: None,
        fir: false,
        sigma: mavid::estimate::PAPER_SIGMA,
        commands: false,
        with: Vec::new(),
    };
    let identified = Identified::from(&args)?;
    identified.write(&args)?;
    output::file(&folder.join(PAGE), &format!("{}\n", identified.page()))?;
    let json = output::json_text(&identified.document())?;
    output::file(&folder.join(DOCUMENT), &json)?;
    Ok(identified)
}

fn explanation(folder: &Path, vehicle: &Path, system: Option<u32>) -> Result<Explained, CommandError> {
    let out = folder.join(EXPLAINED);
    let args = ExplainArgs {
        logs: vec![folder.join(fly::TLOG)],
        vehicle: vehicle.to_owned(),
        holdout: Vec::new(),
        next: None,
        out: None,
        read: ReadArgs { csv_map: None, system },
        transient: TRANSIENT_S,
    };
    let explained = Explained::from(&args)?;
    explained.write(&out)?;
    Ok(explained)
}
