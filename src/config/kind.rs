//! Kinds of configuration files, and by which keys one is known that came in another's place.

use toml::Table;

use crate::text;

/// What a file is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Vehicle,
    Trajectory,
    Limits,
    Effects,
    CsvMapping,
}

impl Kind {
    /// For errors.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::Vehicle => "a vehicle or model file in TOML",
            Self::Trajectory => "a trajectory file in TOML",
            Self::Limits => "a file in TOML with a [limits] table and nothing else",
            Self::Effects => "a file in TOML with [[effect]] tables and nothing else",
            Self::CsvMapping => "a mapping of CSV columns in TOML",
        }
    }

    /// What the text is, where it is a file of another kind by its keys.
    pub(super) fn other(self, text: &str) -> Option<String> {
        let table: Table = toml::from_str(text).ok()?;
        let (kind, what) = Self::of(&table)?;
        (kind != self).then(|| format!("{what} ({})", text::listed(table.keys())))
    }

    fn of(table: &Table) -> Option<(Self, &'static str)> {
        let has = |key: &str| table.contains_key(key);
        let only = |key: &str| has(key) && table.len() == 1;
        if has("body") && has("propulsion") {
            let what = if has("identified") { "a model file" } else { "a vehicle file" };
            Some((Self::Vehicle, what))
        } else if has("period_s") && has("harmonics") {
            Some((Self::Trajectory, "a trajectory file"))
        } else if has("time") && has("quantity") {
            Some((Self::CsvMapping, "a mapping of CSV columns"))
        } else if only("limits") {
            Some((Self::Limits, "a file of limits"))
        } else if only("effect") {
            Some((Self::Effects, "a file of effects"))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: &str = "[limits]\nroll_max_deg = 5.0\n";
    const VEHICLE: &str = include_str!("../../configs/x500.toml");
    const TRAJECTORY: &str = include_str!("../../configs/trajectories/table2.toml");
    const MAPPING: &str = include_str!("../../configs/csv/default.toml");
    const EFFECTS: &str = include_str!("../../configs/demo/concealed.toml");

    #[test]
    fn a_file_of_another_kind_is_known_and_its_own_is_not_taken_for_another() {
        let all = [
            (Kind::Vehicle, VEHICLE),
            (Kind::Trajectory, TRAJECTORY),
            (Kind::Limits, LIMITS),
            (Kind::Effects, EFFECTS),
            (Kind::CsvMapping, MAPPING),
        ];
        for (kind, _) in all {
            for (other, text) in all {
                assert_eq!(kind.other(text).is_some(), kind != other, "{kind:?} {other:?}");
            }
            assert_eq!(kind.other("what = 1\n"), None);
            assert_eq!(kind.other("no TOML"), None);
        }
        let said = Kind::Limits.other(VEHICLE).unwrap();
        assert!(said.starts_with("a vehicle file (") && said.contains("propulsion"), "{said}");
    }
}
