//! Where the residual lives, before any name: which axis, when, along which state, at which frequency; and
//! tests for what no vehicle effect is: a force field of the room, and what never repeats.

mod aperiodic;
mod field;
mod frequency;
mod gust;
mod spectrum;
mod states;
mod time;
mod view;

pub use aperiodic::{Aperiodic, Quantity, Redness, StateLack, Trend, aperiodic, mass_step_std_kg};
pub use field::{FieldTest, Uneven, field_test};
pub use frequency::{Band, Coherence};
pub use gust::GustFound;
pub use states::{Bin, Follow};
pub use time::{Change, ChangeKind, Drift, Span};
pub use view::Followed;

use super::channels::AXES;
use super::fit::Fitted;
use super::trace::Trace;
use spectrum::{noise_variance, periodogram};
use view::View;

/// One channel's part in the misfit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisShare {
    /// root mean square of the residual, N or N m
    pub rms: f64,
    /// standard deviation that the sensors' noise accounts for, N or N m; from 1.5 to 4 Hz, continued by the
    /// spectrum that white noise has behind the weak form
    pub noise: f64,
    /// energy beyond the noise, in units of the noise's variance, over all rows; zero where it is not certain
    pub excess: f64,
    /// its share among the channels (0..1); zero everywhere where nothing exceeds noise
    pub share: f64,
}

/// Where a fit's residual lives.
#[derive(Debug, Clone, PartialEq)]
pub struct Localisation {
    /// each channel's part
    pub axes: [AxisShare; AXES],
    /// sudden changes, greatest first
    pub changes: Vec<Change>,
    /// each channel's drift
    pub drifts: Vec<Drift>,
    /// when it exceeds noise
    pub spans: Vec<Span>,
    /// along which states; of all channels, what explains most energy first
    pub follows: Vec<Follow>,
    /// with what it moves, most first
    pub coherences: Vec<Coherence>,
    /// at which frequencies
    pub bands: [Option<Band>; AXES],
}

impl Localisation {
    /// The channel and state where most of it lives, if an analysis of variance is sure of any.
    #[must_use]
    pub fn lives_on(&self) -> Option<&Follow> {
        self.follows.first().filter(|follow| follow.entered.is_some())
    }
}

/// The noise's variance is continued from frequencies above; less than twice it is none.
const BEYOND_NOISE: f64 = 2.0;

/// Locates a fit's residual; `None` without rows.
#[must_use]
pub fn localise(traces: &[Trace], fitted: &Fitted) -> Option<Localisation> {
    let view = View::new(traces, fitted)?;
    let mut axes = [AxisShare::default(); AXES];
    let mut bands = [None; AXES];
    for (channel, (axis, band)) in axes.iter_mut().zip(&mut bands).enumerate() {
        let series = &view.residual[channel];
        let variance = series.iter().map(|v| v * v).sum::<f64>() / series.len() as f64;
        let ordinates = periodogram(&view, series);
        // where no stretch is long enough for a spectrum, all of it may be noise
        let noise = noise_variance(&view, &ordinates).unwrap_or(variance);
        axis.rms = variance.sqrt();
        axis.noise = noise.sqrt();
        if noise > 0.0 {
            axis.excess = series.len() as f64 * (variance / noise - 1.0).max(0.0);
            if variance > BEYOND_NOISE * noise {
                *band = frequency::band(&view, &ordinates, noise);
            } else {
                axis.excess = 0.0;
            }
        }
    }
    let total: f64 = axes.iter().map(|axis| axis.excess).sum();
    if total > 0.0 {
        axes.iter_mut().for_each(|axis| axis.share = axis.excess / total);
    }
    let (changes, drifts) = time::changes(&view);
    let noise = axes.map(|axis| axis.noise);
    let mut follows = states::follow(&view);
    // energy in units of the noise: comparable between newton and newton metre
    let energy = |follow: &Follow| {
        let axis = &axes[follow.channel];
        follow.partial_share * (axis.rms / axis.noise.max(f64::MIN_POSITIVE)).powi(2)
    };
    follows
        .sort_by(|a, b| b.entered.is_some().cmp(&a.entered.is_some()).then(energy(b).total_cmp(&energy(a))));
    Some(Localisation {
        axes,
        changes,
        drifts,
        spans: time::spans(&view, &noise),
        follows,
        coherences: frequency::coherences(&view, traces),
        bands,
    })
}

#[cfg(test)]
mod tests;
