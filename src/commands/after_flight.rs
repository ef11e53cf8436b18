//! What follows every flight: its recording is identified and explained, and the results lie beside it.

use std::path::{Path, PathBuf};

use mavid::fly;
use mavid::text;

use super::explain::{self, Explained, REPORT};
use super::identify::Identified;
use super::words::Word;
use super::{CommandError, Outcome, output};
use crate::cli::{ExplainArgs, IdentifyArgs, ReadArgs};

/// Folder of the explanation in that of the flight.
const EXPLAINED: &str = "explained";
/// s of flight that `explain` leaves out at the beginning, as by itself.
const TRANSIENT_S: f64 = 1.0;

/// Names of what is written of the parameters.
const MODEL: &str = "model.toml";
const CHART: &str = "parameters.svg";
const PAGE: &str = "identification.txt";
const DOCUMENT: &str = "identification.json";
/// Exit status of a program that could not write a file of its results.
const NOT_WRITTEN: u8 = 1;

/// What a flight says; a part that it cannot say holds why.
#[derive(Debug)]
pub struct Analysis {
    /// written beside the recording
    pub identified: Result<Identified, String>,
    /// written into a folder of its own
    pub explained: Result<Explained, String>,
    /// what of it is in no file, why, and how it is made again: of the parameters, and of the explanation
    pub unwritten: [Option<String>; 2],
    folder: PathBuf,
}

impl Analysis {
    /// Of the flight in this folder; none of one that did not land. Results of an earlier flight go: beside this
    /// one's recording they would pass for its own. Lines for the user are given to `tell`.
    pub fn of(
        (folder, landed): (&Path, bool),
        vehicle: &Path,
        system: Option<u32>,
        tell: &mut impl FnMut(Word),
    ) -> Result<Option<Self>, CommandError> {
        let parameters = [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(|name| folder.join(name));
        let explanation = explain::WRITTEN.map(|name| folder.join(EXPLAINED).join(name));
        // a model that was flown by is what this flight's own are compared with
        for path in parameters.iter().chain(&explanation).filter(|path| !output::is_same(path, vehicle)) {
            output::outdated(path)?.map(Word::Message).into_iter().for_each(&mut *tell);
        }
        Ok(landed.then(|| Self::made(folder, vehicle, system, tell)))
    }

    fn made(folder: &Path, vehicle: &Path, system: Option<u32>, tell: &mut impl FnMut(Word)) -> Self {
        let done = Done { folder, vehicle, system };
        let (identified, parameters) = done.identified();
        let (explained, explanation) = done.explained();
        let failures = [("identified", identified.as_ref().err()), ("explained", explained.as_ref().err())];
        for (what, failure) in failures {
            failure.into_iter().for_each(|failure| tell(Word::Error(format!("not {what}: {failure}"))));
        }
        let unwritten = [parameters, explanation];
        unwritten.iter().flatten().for_each(|why| tell(Word::Error(why.clone())));
        Self { identified, explained, unwritten, folder: folder.to_owned() }
    }

    /// Where the report lies, if there is one.
    pub fn report(&self) -> Option<PathBuf> {
        let written = self.explained.is_ok() && self.unwritten[1].is_none();
        written.then(|| self.folder.join(EXPLAINED).join(REPORT))
    }

    /// For people: parameters, then the explanation's answer and where its report lies.
    pub fn page(&self) -> String {
        let mut parts: Vec<String> = self.identified.iter().map(Identified::page).collect();
        if self.identified.is_ok() && self.unwritten[0].is_none() {
            let parameters = self.folder.join(REPORT);
            parts.push(format!("report of the parameters: {}", text::path(&parameters)));
        }
        parts.extend(self.explained.iter().map(Explained::answer));
        parts.extend(self.report().map(|path| format!("report: {}", text::path(&path))));
        parts.join("\n\n")
    }

    /// What is to be known about the data, line by line.
    pub fn remarks(&self) -> Vec<Word> {
        self.explained.as_ref().map(Explained::remarks).unwrap_or_default()
    }

    /// The first part that failed or is in no file, and otherwise whether something was lost.
    pub fn outcome(&self) -> Result<Outcome, CommandError> {
        let failed = |why: &String| CommandError::Failure(why.clone());
        self.identified.as_ref().map_err(failed)?;
        let explained = self.explained.as_ref().map_err(failed)?;
        // it was told with the rest
        if self.unwritten.iter().any(Option::is_some) {
            return Err(CommandError::Told(NOT_WRITTEN));
        }
        Ok(explained.outcome())
    }
}

/// A flight that is over.
struct Done<'a> {
    folder: &'a Path,
    vehicle: &'a Path,
    system: Option<u32>,
}

impl Done<'_> {
    /// The parameters, and what of them is in no file.
    fn identified(&self) -> (Result<Identified, String>, Option<String>) {
        let Self { folder, vehicle, system } = *self;
        let args = identify_args(folder, vehicle, system);
        // what is odd about the vehicle's file was told before the flight
        let identified = match Identified::from(&args, |_| {}) {
            Ok(identified) => identified,
            Err(error) => return (Err(error.to_string()), None),
        };
        let written = write(&identified, &args, folder).err();
        let out = folder.join(MODEL);
        let unwritten = written.map(|error| {
            let names = [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(|name| folder.join(name));
            self.again(&error, &names, ("identify", &out))
        });
        (Ok(identified), unwritten)
    }

    /// The explanation, and what of it is in no file.
    fn explained(&self) -> (Result<Explained, String>, Option<String>) {
        let Self { folder, vehicle, system } = *self;
        let explained = match Explained::from(&explain_args(folder, vehicle, system)) {
            Ok(explained) => explained,
            Err(error) => return (Err(error.to_string()), None),
        };
        let out = folder.join(EXPLAINED);
        let unwritten = explained.write(&out).err().map(|error| {
            let names = explain::WRITTEN.map(|name| out.join(name));
            self.again(&error, &names, ("explain", &out))
        });
        (Ok(explained), unwritten)
    }

    /// What of these files is missing, why, and the command that makes it again.
    fn again(&self, error: &CommandError, files: &[PathBuf], (verb, out): (&str, &Path)) -> String {
        let missing = files.iter().filter(|file| !file.exists()).map(text::path).collect::<Vec<_>>();
        format!(
            "{error}; missing: {}; to make them when there is room: mavid {verb} {} \
             --vehicle {} --out {}{}",
            missing.join(", "),
            text::path(&self.folder.join(fly::TLOG)),
            text::path(&self.vehicle),
            text::path(&out),
            self.system.map_or_else(String::new, |system| format!(" --system-id {system}"))
        )
    }
}

/// Model, report and chart, and the page and the document beside them.
fn write(identified: &Identified, args: &IdentifyArgs, folder: &Path) -> Result<(), CommandError> {
    identified.write(args)?;
    output::file(&folder.join(PAGE), &format!("{}\n", identified.page()))?;
    output::file(&folder.join(DOCUMENT), &output::json_text(&identified.document())?)
}

fn identify_args(folder: &Path, vehicle: &Path, system: Option<u32>) -> IdentifyArgs {
    IdentifyArgs {
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
    }
}

fn explain_args(folder: &Path, vehicle: &Path, system: Option<u32>) -> ExplainArgs {
    ExplainArgs {
        logs: vec![folder.join(fly::TLOG)],
        vehicle: vehicle.to_owned(),
        holdout: Vec::new(),
        next: None,
        out: None,
        read: ReadArgs { csv_map: None, system },
        transient: TRANSIENT_S,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Nothing can be written where a folder stands: as little as on a full disk.
    #[test]
    fn what_cannot_be_written_is_named_with_the_command_that_makes_it_again() {
        let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
        let folder = std::env::temp_dir().join(format!("mavid-after-flight-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("model.toml.part")).unwrap();
        fs::create_dir_all(folder.join("explained/report.html.part")).unwrap();
        fs::copy(fixtures.join("p04_identify_10_22s.tlog"), folder.join(fly::TLOG)).unwrap();
        let vehicle = fixtures.join("p04_vehicle.toml");
        let mut told = Vec::new();
        let analysis = Analysis::of((&folder, true), &vehicle, None, &mut |line| told.push(line));
        let analysis = analysis.unwrap().unwrap();
        let [parameters, explanation] = analysis.unwritten.clone().map(Option::unwrap);
        assert_eq!(told, [&parameters, &explanation].map(|why| Word::Error(why.clone())));
        for (said, verb, names) in [
            (parameters, "mavid identify ", &["model.toml", "identification.txt"][..]),
            (explanation, "mavid explain ", &["report.html", "explanation.json"]),
        ] {
            assert!(said.contains("cannot write") && said.contains(verb), "{said}");
            assert!(said.contains("flight.tlog --vehicle"), "{said}");
            assert!(names.iter().all(|name| said.contains(name)), "{said}");
        }
        assert!(!folder.join(MODEL).exists() && !folder.join(EXPLAINED).join(REPORT).exists());
        // it is told all the same
        assert!(
            analysis.page().contains("ixx") && !analysis.page().contains("report"),
            "{}",
            analysis.page()
        );
        assert!(matches!(analysis.outcome(), Err(CommandError::Told(NOT_WRITTEN))));
        fs::remove_dir_all(folder).unwrap();
    }
}
