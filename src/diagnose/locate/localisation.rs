//! Localisation of a residual: axis, time, state, frequency.

use super::super::channels::AXES;
use super::super::fit::Fitted;
use super::super::trace::Trace;
use super::frequency::{self, Band, Coherence};
use super::spectrum::{noise_variance, periodogram};
use super::states::{self, Follow};
use super::time::{self, Change, Drift, Span};
use super::view::View;

/// Localisation of a fit's residual.
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
    /// states on which it depends, of all channels, the largest explained energy first
    pub follows: Vec<Follow>,
    /// coherence with states, the largest first
    pub coherences: Vec<Coherence>,
    /// at which frequencies
    pub bands: [Option<Band>; AXES],
}

impl Localisation {
    /// The channel and state with the largest explained energy, if an analysis of variance is significant.
    #[must_use]
    pub fn lives_on(&self) -> Option<&Follow> {
        self.follows.first().filter(|follow| follow.entered.is_some())
    }
}

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
    /// its share among the channels (0..1); zero everywhere if nothing exceeds noise
    pub share: f64,
}

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

/// Residual power over noise from which an axis has a misfit. The noise is extrapolated from higher frequencies, so a
/// smaller ratio is not certain. Only what is shown depends on it.
const BEYOND_NOISE: f64 = 2.0;
