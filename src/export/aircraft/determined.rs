//! Which values of a model were identified, and how well.

use toml::{Table, Value};

/// The table `[identified]` of a model.
#[derive(Debug, Clone, Copy)]
pub(super) struct Determined<'a>(Option<&'a Table>);

impl<'a> Determined<'a> {
    pub(super) fn of(identified: Option<&'a Table>) -> Self {
        Self(identified)
    }

    /// Value and standard error of what `[identified]` has by this name; `None` where it was given or is not determined.
    pub(super) fn own(&self, name: &str) -> Option<(f64, f64)> {
        with_error(self.0?.get(name)?)
    }

    /// Standard error of an effect's parameter; `None` where it was not estimated.
    pub(super) fn std(&self, effect: &str, parameter: &str) -> Option<f64> {
        let effects = self.0?.get("effects")?.as_table()?;
        with_error(effects.get(effect)?.as_table()?.get(parameter)?).map(|(_, std)| std)
    }

    /// Relative standard error of weight over full thrust: of the mass, or of the thrust's scale where the mass was given.
    /// Estimators know only the ratio of both.
    pub(super) fn load_relative_std(&self) -> Option<f64> {
        let relative = |name: &str| self.own(name).map(|(value, std)| (std / value).abs());
        ["mass", "thrust_coefficient", "thrust_max"].into_iter().find_map(relative)
    }
}

/// `{ value, std }` with a positive, finite error.
fn with_error(value: &Value) -> Option<(f64, f64)> {
    let number = |key: &str| {
        let entry = value.get(key)?;
        entry.as_float().or_else(|| entry.as_integer().map(|whole| whole as f64))
    };
    let (value, std) = (number("value")?, number("std")?);
    (value.is_finite() && std.is_finite() && std > 0.0).then_some((value, std))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn what_was_given_or_is_not_determined_has_no_error() {
        let table: Table = toml::from_str(
            "mass = { value = 2.0, std = 0.0, status = \"given\" }\nthrust_coefficient = { value = 4.0, std = 0.2 }\n\
             ixx = { status = \"not determined\" }\n[effects.linear_drag]\ndx = { value = 0.3, std = 0.01 }\n",
        )
        .unwrap();
        let determined = Determined::of(Some(&table));
        assert_eq!(
            (determined.own("mass"), determined.own("ixx"), determined.own("iyy")),
            (None, None, None)
        );
        assert_eq!(determined.std("linear_drag", "dx"), Some(0.01));
        assert_eq!((determined.std("linear_drag", "dy"), determined.std("inflow", "kz")), (None, None));
        assert!((determined.load_relative_std().unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(Determined::of(None).load_relative_std(), None);
    }
}
