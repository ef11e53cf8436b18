//! The answers of a folder of cases, read only after every verdict is sealed.

use crate::note::{About, Note};
use crate::physics::effects::{ALL, by_id};
use crate::study::StudyError;
use crate::text;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// The answer where no effect accounts for what was concealed.
pub(super) const UNEXPLAINED: &str = "unexplained";

/// What was concealed in one case.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Answer {
    /// identifiers of the effects; empty: nothing is missing; `unexplained`: no effect accounts for it
    pub(super) expect: Vec<String>,
    /// sizes by effect: one number, several, or by the parameter's name
    pub(super) sizes: BTreeMap<String, Size>,
}

/// The size of an effect, SI.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Size {
    /// all parameters alike, or the only one
    One(f64),
    /// in the order of the parameters
    List(Vec<f64>),
    /// by name
    Named(BTreeMap<String, f64>),
}

/// All answers, and keys that meant nothing here.
#[derive(Debug, Default)]
pub(super) struct Answers {
    /// by the case's folder
    pub(super) cases: BTreeMap<String, Answer>,
    /// what was ignored
    pub(super) notes: Vec<Note>,
}

/// Reads the answers.
pub(super) fn read(path: &Path) -> Result<Answers, StudyError> {
    let refuse = |why: String| StudyError::File { file: text::path(&path), why };
    let text = std::fs::read_to_string(path).map_err(|error| refuse(error.to_string()))?;
    let value: Value = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
    let Value::Object(cases) = value else {
        return Err(refuse("expected an object with one entry a case".to_owned()));
    };
    let mut answers = Answers::default();
    for (name, value) in cases {
        let case = parsed(&name, &value, &mut answers.notes).map_err(&refuse)?;
        answers.cases.insert(name, case);
    }
    Ok(answers)
}

fn parsed(name: &str, value: &Value, notes: &mut Vec<Note>) -> Result<Answer, String> {
    let about = || About::Case(name.to_owned());
    let Value::Object(fields) = value else {
        return Err(format!("{name}: expected an object with `expect` and `effects`, got {value}"));
    };
    let expect = match fields.get("expect") {
        Some(Value::Array(items)) => items
            .iter()
            .map(|item| item.as_str().map(str::to_owned))
            .collect::<Option<Vec<_>>>()
            .ok_or_else(|| format!("{name}: `expect` must hold identifiers, got {value}"))?,
        Some(Value::String(one)) if one == "nothing_missing" => Vec::new(),
        Some(Value::String(one)) => vec![one.clone()],
        _ => return Err(format!("{name}: `expect` is missing: a list of identifiers, [] for nothing")),
    };
    let known = |id: &&String| *id == UNEXPLAINED || by_id(id).is_some();
    if let Some(stranger) = expect.iter().find(|id| !known(id)) {
        let all: Vec<&str> = ALL.iter().map(|effect| effect.id()).collect();
        return Err(format!(
            "{name}: `expect` names `{stranger}`; expected `{UNEXPLAINED}` or effects among {}",
            all.join(", ")
        ));
    }
    for key in fields.keys().filter(|key| !["expect", "effects", "vehicle"].contains(&key.as_str())) {
        notes.push(Note::loss(about(), format!("`{key}` of the answers is not used")));
    }
    let mut sizes = BTreeMap::new();
    if let Some(Value::Object(effects)) = fields.get("effects") {
        for (id, value) in effects {
            match size(value) {
                Some(size) => {
                    sizes.insert(id.clone(), size);
                }
                None => {
                    let text = format!("the size of `{id}` is not a number, a list or a table of them");
                    notes.push(Note::loss(about(), text));
                }
            }
        }
    }
    Ok(Answer { expect, sizes })
}

fn size(value: &Value) -> Option<Size> {
    match value {
        Value::Number(number) => number.as_f64().map(Size::One),
        Value::Array(items) => items.iter().map(Value::as_f64).collect::<Option<Vec<_>>>().map(Size::List),
        Value::Object(fields) => numbers(fields),
        _ => None,
    }
}

/// The numbers of a table; entries of other kinds are left out.
fn numbers(fields: &Map<String, Value>) -> Option<Size> {
    let named: BTreeMap<String, f64> = fields
        .iter()
        .filter_map(|(name, value)| value.as_f64().map(|number| (name.clone(), number)))
        .collect();
    (!named.is_empty()).then_some(Size::Named(named))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_come_in_three_forms() {
        let text = r#"{"expect": ["tether"], "effects": {"a": 1.5, "b": [1, 2], "c": {"time": 3, "axis": [0]}, "d": "x"}, "more": 1}"#;
        let mut notes = Vec::new();
        let answer = parsed("p", &serde_json::from_str(text).unwrap(), &mut notes).unwrap();
        assert_eq!(answer.sizes["a"], Size::One(1.5));
        assert_eq!(answer.sizes["b"], Size::List(vec![1.0, 2.0]));
        assert_eq!(answer.sizes["c"], Size::Named(BTreeMap::from([("time".to_owned(), 3.0)])));
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert!(parsed("p", &serde_json::json!({"effects": {}}), &mut notes).is_err());
        let stranger = parsed("p", &serde_json::json!({"expect": ["drag"]}), &mut notes).unwrap_err();
        assert!(stranger.contains("`drag`") && stranger.contains("linear_drag"), "{stranger}");
    }
}
