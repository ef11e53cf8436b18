//! What follows every flight: its recording is identified and explained, and the results lie beside it.

use std::path::{Path, PathBuf};

use mavid::fly;
use mavid::report::{IdentificationDocument, explanation_answer, identification_text};
use mavid::study::{AfterFlight, ExplainStudy, FlightLogs, IdentifyStudy, Progress, after_flight};
use mavid::text;
use mavid::wire::SystemId;

use super::explain::{self, REPORT};
use super::identify::Targets;
use super::progress::Notes;
use super::words::Word;
use super::{CommandError, Outcome, output};

/// Folder of the appendix in that of the flight: the rigid body alone, without the effects that were found.
const RIGID_BODY: &str = "rigid_body";
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
    /// the appendix, written into a folder of its own
    pub identified: Result<IdentifyStudy, String>,
    /// written beside it: the one model and the one report
    pub explained: Result<ExplainStudy, String>,
    /// what of it is in no file, why, and how it is made again: of the parameters, and of the explanation
    pub unwritten: [Option<String>; 2],
    folder: PathBuf,
    /// the vehicle's own log, where it was analysed
    pub onboard: Option<PathBuf>,
}

impl Analysis {
    /// Of the flight in this folder; none of one that did not land. Results of an earlier flight go: beside this
    /// one's recording they would pass for its own. Lines for the user are given to `tell`, and how far the work is to `watches`.
    pub fn of(
        (folder, landed, onboard): (&Path, bool, Option<&Path>),
        vehicle: &Path,
        system: Option<SystemId>,
        (watches, tell): (&dyn Progress, &mut impl FnMut(Word)),
    ) -> Result<Option<Self>, CommandError> {
        let parameters =
            [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(|name| folder.join(RIGID_BODY).join(name));
        let explanation = explain::WRITTEN.map(|name| folder.join(name));
        // a model that was flown by is what this flight's own are compared with
        for path in parameters.iter().chain(&explanation).filter(|path| !output::is_same(path, vehicle)) {
            output::outdated(path)?.map(Word::Message).into_iter().for_each(&mut *tell);
        }
        Ok(landed.then(|| Self::made((folder, onboard), vehicle, system, (watches, tell))))
    }

    fn made(
        (folder, onboard): (&Path, Option<&Path>),
        vehicle: &Path,
        system: Option<SystemId>,
        (watches, tell): (&dyn Progress, &mut impl FnMut(Word)),
    ) -> Self {
        let notes = Notes::new(watches);
        let radio = folder.join(fly::TLOG);
        let FlightLogs { logs, why } = FlightLogs::of(&radio, system, onboard);
        why.into_iter().for_each(|why| tell(Word::Message(why)));
        // the vehicle's own log holds no other system
        let system = system.filter(|_| logs.contains(&radio));
        let AfterFlight { identified, explained } = after_flight(&logs, vehicle, system, &notes);
        notes.words().into_iter().for_each(&mut *tell);
        let identified = identified.map_err(|error| CommandError::from(error).to_string());
        let explained = explained.map_err(|error| CommandError::from(error).to_string());
        let failures = [("identified", identified.as_ref().err()), ("explained", explained.as_ref().err())];
        for (what, failure) in failures {
            failure.into_iter().for_each(|failure| tell(Word::Error(format!("not {what}: {failure}"))));
        }
        let written = Written { folder, logs: &logs, vehicle, system };
        let unwritten = [
            identified.as_ref().ok().and_then(|study| written.parameters(study)),
            explained.as_ref().ok().and_then(|study| written.explanation(study)),
        ];
        unwritten.iter().flatten().for_each(|why| tell(Word::Error(why.clone())));
        let onboard = onboard.filter(|onboard| logs.iter().any(|log| log == onboard)).map(Path::to_owned);
        Self { identified, explained, unwritten, folder: folder.to_owned(), onboard }
    }

    /// Where the report lies, if there is one.
    pub fn report(&self) -> Option<PathBuf> {
        let written = self.explained.is_ok() && self.unwritten[1].is_none();
        written.then(|| self.folder.join(REPORT))
    }

    /// For people: the answer, and where all else lies. The parameters of the rigid body alone are told where there is no answer, or
    /// where they are in no file.
    pub fn page(&self) -> String {
        let mut parts: Vec<String> = self.explained.iter().map(explanation_answer).collect();
        let mut places: Vec<String> =
            self.report().map(|_| explain::places(&self.folder)).into_iter().collect();
        if self.identified.is_ok() && self.unwritten[0].is_none() {
            let place = |name| text::path(&self.folder.join(RIGID_BODY).join(name));
            places.push(format!("the rigid body alone, without effects: {}, {}", place(REPORT), place(PAGE)));
        }
        if !places.is_empty() {
            parts.push(places.join("\n"));
        }
        if self.explained.is_err() || self.unwritten[0].is_some() {
            parts.extend(self.identified.iter().map(identification_text));
        }
        parts.join("\n\n")
    }

    /// The answer alone, or why there is none.
    pub fn answer(&self) -> String {
        match &self.explained {
            Ok(study) => explanation_answer(study),
            Err(why) => format!("not explained: {why}"),
        }
    }

    /// What is to be known about the data, line by line.
    pub fn remarks(&self) -> Vec<Word> {
        self.explained.as_ref().map(explain::remarks).unwrap_or_default()
    }

    /// The first part that failed or is in no file, and otherwise whether something was lost.
    pub fn outcome(&self) -> Result<Outcome, CommandError> {
        let failed = |why: &String| CommandError::Failure(why.clone());
        self.identified.as_ref().map_err(failed)?;
        let explained = self.explained.as_ref().map_err(failed)?;
        // it was told with the rest
        if self.unwritten.iter().any(Option::is_some) {
            return Err(CommandError::Reported(NOT_WRITTEN));
        }
        Ok(explain::outcome(explained))
    }
}

/// Where the results of a flight are written.
struct Written<'a> {
    folder: &'a Path,
    logs: &'a [PathBuf],
    vehicle: &'a Path,
    system: Option<SystemId>,
}

impl Written<'_> {
    /// Writes the parameters: model, report and chart, and the page and the document beside them. What of it is in no file.
    fn parameters(&self, study: &IdentifyStudy) -> Option<String> {
        let place = |name| self.folder.join(RIGID_BODY).join(name);
        let targets =
            Targets { model: Some(place(MODEL)), report: Some(place(REPORT)), chart: Some(place(CHART)) };
        let written = || {
            output::silent_folder(&self.folder.join(RIGID_BODY))?;
            output::file(&place(PAGE), &format!("{}\n", identification_text(study)))?;
            output::file(&place(DOCUMENT), &output::json_text(&IdentificationDocument::new(study))?)?;
            targets.write(study)
        };
        let error = written().err()?;
        let names = [MODEL, REPORT, CHART, PAGE, DOCUMENT].map(place);
        Some(self.again(&error, &names, ("identify", &place(MODEL))))
    }

    /// Writes the explanation. What of it is in no file.
    fn explanation(&self, study: &ExplainStudy) -> Option<String> {
        let error = explain::write(study, self.folder).err()?;
        let names = explain::WRITTEN.map(|name| self.folder.join(name));
        Some(self.again(&error, &names, ("explain", self.folder)))
    }

    /// What of these files is missing, why, and the command that makes it again.
    fn again(&self, error: &CommandError, files: &[PathBuf], (verb, out): (&str, &Path)) -> String {
        let missing = files.iter().filter(|file| !file.exists()).map(text::path).collect::<Vec<_>>();
        format!(
            "{error}; missing: {}; once this is corrected, make them by: mavid {verb} {} \
             --vehicle {} --out {}{}",
            missing.join(", "),
            self.logs.iter().map(|log| text::path(&log)).collect::<Vec<_>>().join(" "),
            text::path(&self.vehicle),
            text::path(&out),
            self.system.map_or_else(String::new, |system| format!(" --system-id {system}"))
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::study::Silent;
    use std::fs;

    /// Nothing can be written where a folder stands: as little as on a full disk.
    #[test]
    fn what_cannot_be_written_is_named_with_the_command_that_makes_it_again() {
        let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
        let folder = std::env::temp_dir().join(format!("mavid-after-flight-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("rigid_body/identification.txt.part")).unwrap();
        fs::create_dir_all(folder.join("report.html.part")).unwrap();
        fs::copy(fixtures.join("p04_identify_10_22s.tlog"), folder.join(fly::TLOG)).unwrap();
        let vehicle = fixtures.join("p04_vehicle.toml");
        let mut told = Vec::new();
        let analysis =
            Analysis::of((&folder, true, None), &vehicle, None, (&Silent, &mut |line| told.push(line)));
        let analysis = analysis.unwrap().unwrap();
        let [parameters, explanation] = analysis.unwritten.clone().map(Option::unwrap);
        assert_eq!(told, [&parameters, &explanation].map(|why| Word::Error(why.clone())));
        for (said, verb, names) in [
            (parameters, "mavid identify ", &["model.toml", "identification.txt"][..]),
            (explanation, "mavid explain ", &["report.html", "report.md", "explanation.json"]),
        ] {
            assert!(said.contains("cannot write") && said.contains(verb), "{said}");
            assert!(said.contains("flight.tlog --vehicle"), "{said}");
            assert!(names.iter().all(|name| said.contains(name)), "{said}");
        }
        assert!(!folder.join(RIGID_BODY).join(MODEL).exists() && !folder.join(REPORT).exists());
        // it is told all the same
        assert!(
            analysis.page().contains("ixx") && !analysis.page().contains("report"),
            "{}",
            analysis.page()
        );
        assert!(matches!(analysis.outcome(), Err(CommandError::Reported(NOT_WRITTEN))));
        // where all is written, the answer comes first, and the parameters are in their files
        let whole = Analysis { unwritten: [None, None], ..analysis };
        let (answer, page) = (whole.answer(), whole.page());
        assert!(page.starts_with(&answer) && page.contains("\nreport: "), "{page}");
        assert!(page.ends_with("identification.txt") && !page.contains("std"), "{page}");
        fs::remove_dir_all(folder).unwrap();
    }
}
