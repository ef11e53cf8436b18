//! The table of RMS errors of several models.

use serde::Serialize;

use crate::compare::improvement_percent;
use crate::note::Note;

/// RMS errors, one column a model; the first column is what the others are compared with.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorTable {
    /// what was compared
    pub title: String,
    /// s, length of the windows of a playback
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_s: Option<f64>,
    /// names of the models
    pub models: Vec<String>,
    /// one a signal or component
    pub rows: Vec<ErrorRow>,
    /// models that are missing, and why
    pub missing: Vec<String>,
    /// what to know when reading it
    pub notes: Vec<Note>,
}

/// One signal's errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorRow {
    /// signal or component
    pub name: String,
    /// of the errors
    pub unit: String,
    /// RMS, one a model; null where there is none
    pub rms: Vec<Option<f64>>,
    /// `P_imp` against the first model, one a model; null where there is none
    pub improvement_percent: Vec<Option<f64>>,
}

/// A model's name and its errors, row by row, or why it has none.
pub type Column = (String, Result<Vec<Option<f64>>, String>);

impl ErrorTable {
    /// `rows` are names and units; each column holds as many errors.
    #[must_use]
    pub fn new(title: impl Into<String>, rows: &[(&str, &str)], columns: &[Column]) -> Self {
        let rms = |row: usize, column: usize| {
            columns[column].1.as_ref().ok().and_then(|errors| errors.get(row).copied().flatten())
        };
        let row = |(index, (name, unit)): (usize, &(&str, &str))| ErrorRow {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            rms: (0..columns.len()).map(|column| rms(index, column)).collect(),
            improvement_percent: (0..columns.len())
                .map(|column| Some(improvement_percent(rms(index, 0)?, rms(index, column)?)))
                .collect(),
        };
        // models that lack the same are told together
        let mut missing: Vec<(Vec<&str>, &str)> = Vec::new();
        for (name, errors) in columns {
            let Err(why) = errors else { continue };
            match missing.iter_mut().find(|(_, other)| *other == why) {
                Some((names, _)) => names.push(name),
                None => missing.push((vec![name.as_str()], why.as_str())),
            }
        }
        Self {
            title: title.into(),
            window_s: None,
            models: columns.iter().map(|(name, _)| name.clone()).collect(),
            rows: rows.iter().enumerate().map(row).collect(),
            missing: missing.iter().map(|(names, why)| format!("{}: {why}", names.join(", "))).collect(),
            notes: Vec::new(),
        }
    }

    /// Rows that hold an error of any model.
    #[must_use]
    pub fn shown(&self) -> Vec<&ErrorRow> {
        self.rows.iter().filter(|row| row.rms.iter().any(Option::is_some)).collect()
    }

    /// What is said below the rows: which models are missing and why, and, where there are rows, the notes.
    #[must_use]
    pub fn remarks(&self) -> Vec<&str> {
        let notes: &[Note] = if self.shown().is_empty() { &[] } else { &self.notes };
        let notes = notes.iter().map(|note| note.text.as_str());
        self.missing.iter().map(String::as_str).chain(notes).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn improvement_is_against_the_first_model_and_gaps_stay_gaps() {
        let columns = [
            ("nominal".to_owned(), Ok(vec![Some(0.06187), None])),
            ("LS".to_owned(), Ok(vec![Some(0.05888), Some(1.0)])),
            ("GD".to_owned(), Err("diverged".to_owned())),
        ];
        let table = ErrorTable::new("Table 4", &[("x", "m"), ("y", "m")], &columns);
        assert!((table.rows[0].improvement_percent[1].unwrap() - 4.83).abs() < 0.01);
        assert_eq!(table.rows[0].improvement_percent[2], None);
        assert_eq!(table.rows[1].improvement_percent[1], None);
        assert_eq!(table.missing, ["GD: diverged"]);
    }
}
