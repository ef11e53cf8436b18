//! Result of a check: what was expected, what was found, and what to do.

use serde::Serialize;
use std::fmt;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// as it should be
    Ok,
    /// not yet as it should be; the flight itself waits for it
    Awaited,
    /// the flight may begin, and the operator should know
    Warning,
    /// the flight must not begin
    Refusal,
}

impl Level {
    /// As in messages and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Awaited => "awaited",
            Self::Warning => "warning",
            Self::Refusal => "refusal",
        }
    }
}

/// Result of one check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// severity
    pub level: Level,
    /// what was checked, such as `fence`
    pub subject: &'static str,
    /// what was expected
    pub expected: String,
    /// what was found
    pub came: String,
    /// what to do; empty if nothing is to be done
    pub remedy: String,
}

impl Finding {
    /// All is well.
    #[must_use]
    pub fn ok(subject: &'static str, expected: impl Into<String>, came: impl Into<String>) -> Self {
        Self {
            level: Level::Ok,
            subject,
            expected: expected.into(),
            came: came.into(),
            remedy: String::new(),
        }
    }

    /// The operator should know.
    #[must_use]
    pub fn warning(
        subject: &'static str,
        expected: impl Into<String>,
        came: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            level: Level::Warning,
            subject,
            expected: expected.into(),
            came: came.into(),
            remedy: remedy.into(),
        }
    }

    /// The flight must not begin.
    #[must_use]
    pub fn refusal(
        subject: &'static str,
        expected: impl Into<String>,
        came: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { level: Level::Refusal, ..Self::warning(subject, expected, came, remedy) }
    }
}

impl Finding {
    /// What it says, without its level. What was found is a sentence where it ends as one.
    #[must_use]
    pub fn words(&self) -> String {
        let Self { subject, expected, came, remedy, .. } = self;
        let said = if came.ends_with('.') {
            format!("{subject}: {came} Expected: {expected}")
        } else {
            format!("{subject}: expected {expected}, got {came}")
        };
        if remedy.is_empty() { said } else { format!("{said}; {remedy}") }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.level.name(), self.words())
    }
}

/// The worst of all; [`Level::Ok`] for none.
#[must_use]
pub fn worst(findings: &[Finding]) -> Level {
    findings.iter().map(|finding| finding.level).max().unwrap_or(Level::Ok)
}
