//! Actuator outputs: which drives which motor, and the pulse widths of none and of full thrust.

/// Names of parameters that are numbered: `before`, a number, `after`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbered {
    /// the number
    pub before: &'static str,
    /// after the number
    pub after: &'static str,
}

impl Numbered {
    /// The parameter of a number.
    #[must_use]
    pub fn name(&self, number: usize) -> String {
        format!("{}{number}{}", self.before, self.after)
    }
}

/// Where the pulse widths of none and of full command stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PulseRange {
    /// lower and upper end of each output: those of the first output of the first bank that answers
    OfOutputs(&'static [(Numbered, Numbered)]),
    /// shares of one range of all motors
    Shares {
        /// lower and upper end, microseconds
        ends: (&'static str, &'static str),
        /// share of the range at none and at full command
        shares: (&'static str, &'static str),
        /// whose range it is where the ends are no range
        otherwise: ThrottleChannel,
    },
}

/// The transmitter's throttle channel, whose range is that of the motors where they have none of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ThrottleChannel {
    /// parameter with its number, and that number where it does not answer
    pub channel: (&'static str, usize),
    /// lower and upper end of each channel, microseconds
    pub ends: (Numbered, Numbered),
}

impl ThrottleChannel {
    fn ends_us(&self, parameter: &impl Fn(&str) -> Option<f64>) -> Option<(f64, f64)> {
        let (name, usual) = self.channel;
        let is_asked = |number: &usize| parameter(name).is_none_or(|asked| asked == *number as f64);
        let number = std::iter::once(usual).chain(1..=MOST_OUTPUTS).find(is_asked)?;
        let (low, high) = self.ends;
        Some((parameter(&low.name(number))?, parameter(&high.name(number))?))
    }
}

impl PulseRange {
    /// Pulse widths of none and of full command, microseconds; `None` where a parameter is missing.
    #[must_use]
    pub fn ends_us(&self, parameter: impl Fn(&str) -> Option<f64>) -> Option<(f64, f64)> {
        match self {
            Self::OfOutputs(banks) => banks
                .iter()
                .find_map(|(low, high)| Some((parameter(&low.name(1))?, parameter(&high.name(1))?))),
            Self::Shares { ends: (low, high), shares: (none, full), otherwise } => {
                let own = (parameter(low)?, parameter(high)?);
                let is_range = own.0 > 0.0 && own.1 > own.0;
                let (low_us, high_us) = if is_range { own } else { otherwise.ends_us(&parameter)? };
                let (none, full) = (parameter(none)?, parameter(full)?);
                let span_us = high_us - low_us;
                Some((low_us + none * span_us, low_us + full * span_us))
            }
        }
    }
}

/// An autopilot has no more outputs than this.
pub const MOST_OUTPUTS: usize = 32;

/// Numbered parameters that a flight asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NumberedGroup {
    /// of each number
    pub entries: &'static [Numbered],
    /// the first number
    pub first: usize,
    /// how many numbers; `None` for one a rotor
    pub count: Option<usize>,
}

impl NumberedGroup {
    /// All names for a vehicle with this many rotors.
    pub fn names(&self, rotors: usize) -> impl Iterator<Item = String> {
        let (entries, first) = (self.entries, self.first);
        let numbers = first..first + self.count.unwrap_or(rotors);
        numbers.flat_map(move |number| entries.iter().map(move |entry| entry.name(number)))
    }
}

/// The outputs of an autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// function of each output, from 1
    pub function: Numbered,
    /// its value for motor 1; the motors after it follow
    pub first_motor: u8,
    /// its value for the last motor
    pub last_motor: u8,
    /// pulse widths
    pub pulses: PulseRange,
    /// value of full command of outputs on a bus, where those are no pulses (UAVCAN); none is zero
    pub bus: Option<u16>,
    /// exponent of the thrust curve
    pub expo: &'static str,
    /// the thrust is linear in the command where [`Self::expo`] does not answer
    pub linear_without_expo: bool,
    /// share of full thrust at which the autopilot expects to hover
    pub hover: &'static str,
    /// beginnings of the names of all parameters that say how a command becomes thrust and how the vehicle is built
    pub relevant: &'static [&'static str],
    /// beginnings of the names of the controllers' gains
    pub gains: &'static [&'static str],
    /// numbered parameters, most needed first
    pub groups: &'static [NumberedGroup],
    /// in words, which parameters a log should hold
    pub recorded: &'static str,
}

impl Outputs {
    /// Value of [`Self::function`] for a motor, counted from 0.
    #[must_use]
    pub fn motor(&self, motor: usize) -> f64 {
        f64::from(self.first_motor) + motor as f64
    }

    /// Whether an output of this function drives a motor.
    #[must_use]
    pub fn is_motor(&self, function: f64) -> bool {
        (f64::from(self.first_motor)..=f64::from(self.last_motor)).contains(&function)
    }

    /// How many outputs drive motors; `None` where the parameters do not say.
    #[must_use]
    pub fn motors(&self, parameter: &dyn Fn(&str) -> Option<f64>) -> Option<usize> {
        let drives = |channel: &usize| {
            parameter(&self.function.name(*channel)).is_some_and(|value| self.is_motor(value))
        };
        Some((1..=MOST_OUTPUTS).filter(drives).count()).filter(|count| *count > 0)
    }

    /// The output whose function a parameter is, counted from 1.
    #[must_use]
    pub fn output_of(&self, name: &str) -> Option<usize> {
        let Numbered { before, after } = self.function;
        name.strip_prefix(before)?.strip_suffix(after)?.parse().ok()
    }

    /// Whether a parameter tells how a command becomes thrust or how the vehicle is built; an output's function does where it
    /// is a motor.
    #[must_use]
    pub fn is_relevant(&self, name: &str, value: f64) -> bool {
        let motor = self.is_motor(value) && self.output_of(name).is_some();
        motor || self.relevant.iter().any(|beginning| name.starts_with(beginning))
    }

    /// Whether a parameter is a gain of the controllers.
    #[must_use]
    pub fn is_gain(&self, name: &str) -> bool {
        self.gains.iter().any(|beginning| name.starts_with(beginning))
    }
}

#[cfg(test)]
mod tests {
    use crate::autopilot::ARDUPILOT;

    #[test]
    fn motors_without_a_range_of_their_own_have_that_of_the_throttle_channel() {
        let of = |stated: &[(&str, f64)]| {
            let known = [("MOT_SPIN_MIN", 0.15), ("MOT_SPIN_MAX", 0.95)];
            let find = |name: &str| known.iter().chain(stated).find(|of| of.0 == name).map(|of| of.1);
            ARDUPILOT.outputs.pulses.ends_us(find).map(|(none, full)| (none.round(), full.round()))
        };
        assert_eq!(of(&[("MOT_PWM_MIN", 1000.0), ("MOT_PWM_MAX", 2000.0)]), Some((1150.0, 1950.0)));
        let radio = [("MOT_PWM_MIN", 0.0), ("MOT_PWM_MAX", 0.0), ("RC3_MIN", 1100.0), ("RC3_MAX", 1900.0)];
        assert_eq!(of(&radio), Some((1220.0, 1860.0)));
        let other = [("RCMAP_THROTTLE", 1.0), ("RC1_MIN", 1000.0), ("RC1_MAX", 2000.0)];
        assert_eq!(of(&[&radio[..], &other].concat()), Some((1150.0, 1950.0)));
        assert_eq!(of(&radio[..2]), None);
        assert_eq!(of(&radio[2..]), None);
    }
}
