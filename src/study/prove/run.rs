//! Verdicts against the answers of a file.

use std::path::Path;

use super::answers::{self, Answers};
use super::case::CaseVerdict;
use super::result::Proof;
use super::score::{ScoredCase, scored, summary};
use crate::note::{About, Note};
use crate::study::StudyError;
use crate::text;

/// Scores verdicts that are sealed in a folder by a file of answers; without one they are listed.
///
/// # Errors
/// [`StudyError::File`] where the answers cannot be read, or are of none of the cases.
pub fn prove(
    verdicts: Vec<CaseVerdict>,
    answers: Option<&Path>,
    (folder, sealed_sha256): (&Path, String),
) -> Result<Proof, StudyError> {
    let found = answers.map_or_else(|| Ok(Answers::default()), answers::read)?;
    let (answered, unscored): (Vec<CaseVerdict>, Vec<CaseVerdict>) =
        verdicts.into_iter().partition(|verdict| found.cases.contains_key(&verdict.case));
    if let Some(file) = answers.filter(|_| answered.is_empty()) {
        let cases: Vec<&str> = unscored.iter().map(|verdict| verdict.case.as_str()).collect();
        let named: Vec<&str> = found.cases.keys().map(String::as_str).collect();
        let why = format!(
            "expected answers by the names of the cases ({}), got {}; the verdicts are sealed in {}",
            cases.join(", "),
            if named.is_empty() { "none".to_owned() } else { named.join(", ") },
            text::path(&folder)
        );
        return Err(StudyError::File { file: text::path(&file), why });
    }
    let cases: Vec<ScoredCase> =
        answered.iter().map(|verdict| scored(verdict, &found.cases[&verdict.case])).collect();
    let mut notes = found.notes;
    let has_folder = |name: &str| cases.iter().any(|case| case.case == name);
    let without = found.cases.keys().filter(|name| !has_folder(name));
    let about = |name: &String| About::Case(name.clone());
    notes.extend(without.map(|name| Note::loss(about(name), "has an answer, but no folder")));
    Ok(Proof {
        schema: 1,
        sealed_sha256,
        verdicts: folder.to_owned(),
        summary: (!cases.is_empty()).then(|| summary(&cases)),
        cases,
        unscored,
        notes,
    })
}
