//! Which values of a model were identified, and how well.

use toml::{Table, Value};

/// Key of the battery's mean voltage in the air, V.
const BATTERY_VOLTAGE: &str = "battery_voltage";

/// Key of the motors' command at hover, -.
const HOVER_COMMAND: &str = "hover_command";

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

    /// How the errors of two parameters of an effect go together (-1 to 1); `None` where the model does not state it.
    pub(super) fn correlation(&self, effect: &str, [one, other]: [&str; 2]) -> Option<f64> {
        let table = self.0?;
        let names = table.get("correlation_of")?.as_array()?;
        let place = |parameter: &str| {
            let name = format!("{effect}.{parameter}");
            names.iter().position(|known| known.as_str() == Some(name.as_str()))
        };
        let row = table.get("correlation")?.as_array()?.get(place(one)?)?.as_array()?;
        row.get(place(other)?)?.as_float().filter(|together| (-1.0..=1.0).contains(together))
    }

    /// V, mean of the battery in the air, of the flights that the model was identified from; `None` where none was recorded.
    pub(super) fn battery_voltage_v(&self) -> Option<f64> {
        self.0?.get(BATTERY_VOLTAGE)?.as_float().filter(|volts| volts.is_finite() && *volts > 0.0)
    }

    /// Command of the motors at hover (0 to 1) and its standard error, as flown; `None` where the flights did not tell it.
    pub(super) fn hover_command(&self) -> Option<(f64, f64)> {
        self.own(HOVER_COMMAND).filter(|(command, _)| (0.0..=1.0).contains(command))
    }

    /// What the file states of the flights that cannot be used, as sentences.
    pub(super) fn unusable(&self) -> Vec<String> {
        let stated = |key: &str| self.0.and_then(|table| table.get(key));
        let hover = stated(HOVER_COMMAND).filter(|_| self.hover_command().is_none());
        let hover = hover.map(|got| {
            format!(
                "{HOVER_COMMAND} in [identified] is not used: expected {{ value, std }} with a command from 0 to 1 and a standard error \
                 above 0, got {got}"
            )
        });
        let voltage = stated(BATTERY_VOLTAGE).filter(|_| self.battery_voltage_v().is_none());
        let voltage = voltage.map(|got| {
            format!("{BATTERY_VOLTAGE} in [identified] is not used: expected a number above 0, V, got {got}")
        });
        hover.into_iter().chain(voltage).collect()
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

    #[test]
    fn the_voltage_and_the_correlation_are_as_the_file_states_them() {
        let table: Table = toml::from_str(
            "battery_voltage = 16.2\ncorrelation_of = [\"ixx\", \"linear_drag.dx\", \"linear_drag.dy\"]\n\
             correlation = [[1.0, 0.0, 0.1], [0.0, 1.0, 0.25], [0.1, 0.25, 1.0]]\n",
        )
        .unwrap();
        let determined = Determined::of(Some(&table));
        assert_eq!(determined.battery_voltage_v(), Some(16.2));
        assert_eq!(determined.correlation("linear_drag", ["dx", "dy"]), Some(0.25));
        assert_eq!(determined.correlation("linear_drag", ["dx", "dz"]), None);
        assert!(determined.unusable().is_empty());
        let wrong: Table =
            toml::from_str("battery_voltage = -3.0\nhover_command = { value = 1.7, std = 0.01 }\n").unwrap();
        let wrong = Determined::of(Some(&wrong));
        assert_eq!((wrong.hover_command(), wrong.battery_voltage_v()), (None, None));
        let [hover, voltage] = wrong.unusable().try_into().unwrap();
        assert!(hover.contains("expected { value, std }") && hover.contains("value = 1.7"), "{hover}");
        assert!(voltage.ends_with("expected a number above 0, V, got -3.0"), "{voltage}");
        let without = Determined::of(None);
        assert_eq!((without.battery_voltage_v(), without.correlation("inflow", ["kz", "kz"])), (None, None));
    }
}
