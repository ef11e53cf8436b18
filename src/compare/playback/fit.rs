//! How well a model played back follows the recording.

use super::lengths::playback_windows;
use super::settings::PlaybackSettings;
use crate::compare::CompareError;
use crate::compare::mean_square::MeanSquare;
use crate::physics::Model;
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// Root mean square over all instants of all windows of the size of the vector error. `None` where the
/// recording does not hold the quantity, and of the rotation also where it is too slow to compare torques: then the body turns as it
/// was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fit {
    /// m
    pub position_m: Option<f64>,
    /// m/s
    pub velocity_m_s: Option<f64>,
    /// angle between the attitudes, rad
    pub attitude_rad: Option<f64>,
    /// rad/s
    pub rates_rad_s: Option<f64>,
    /// windows
    pub windows: usize,
}

impl Fit {
    /// Position, velocity, attitude, rates.
    #[must_use]
    pub fn quantities(&self) -> [Option<f64>; 4] {
        [self.position_m, self.velocity_m_s, self.attitude_rad, self.rates_rad_s]
    }
}

/// Plays the recorded actuators back through a model.
///
/// `signals` must be conditioned with `vehicle`, which `model` is made of, because its thrust law turns
/// commands into thrusts. Where the rotor speeds were measured, effects between command and speed (lag, delay,
/// sag with the battery) are left out, and the rotors spin up as measured; where the log holds force and
/// torque, they are shared out to the rotors. The battery's voltage is the recorded one.
///
/// # Errors
/// If attitude or rates are missing, no window fits, or the model cannot be simulated.
pub fn playback(
    (model, vehicle): (&Model, &Vehicle),
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Fit, CompareError> {
    let windows = playback_windows((model, vehicle), None, signals, settings)?;
    let mut errors = [MeanSquare::default(); 4];
    for window in &windows {
        for (error, (sum, count)) in errors.iter_mut().zip(window.squares.iter().zip(&window.counts)) {
            error.sum += sum;
            error.count += count;
        }
    }
    let [position_m, velocity_m_s, attitude_rad, rates_rad_s] = errors.map(|error| error.root());
    Ok(Fit { position_m, velocity_m_s, attitude_rad, rates_rad_s, windows: windows.len() })
}
