//! The paper's two models built from a conditioned flight: the standard one (34) and the filtered one
//! (37) to (39).

use super::phi::{FilteredPhi, Phi};
use crate::signals::{Butterworth, FilterPair, PairMemory, Signals, WindowedFir, central_difference};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

/// `Gamma(hT) Theta = Upsilon(hT)` at each instant h that may be used.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampledModel {
    /// s between samples
    pub step_s: f64,
    /// s, vehicle clock
    pub time_s: Vec<f64>,
    /// regressor
    pub gamma: Vec<Phi>,
    /// output (N, N m)
    pub upsilon: Vec<Vector4<f64>>,
    /// index ranges without a break in time
    pub runs: Vec<std::ops::Range<usize>>,
}

/// The zero-phase low-pass of section II-C, item 1. The paper's own numbers contradict each other, so
/// both of its filters are offered.
#[derive(Debug, Clone)]
pub enum ZeroPhase {
    /// forward-backward fourth-order Butterworth
    Butterworth(Butterworth),
    /// 31-tap Blackman-Harris windowed FIR
    Fir(WindowedFir),
}

impl ZeroPhase {
    fn apply(&self, column: &[f64]) -> Vec<f64> {
        match self {
            Self::Butterworth(filter) => filter.filtfilt(column),
            Self::Fir(filter) => filter.apply(column),
        }
    }

    /// Samples at each end of a record that its made-up continuation reaches into.
    fn edge_count(&self) -> usize {
        match self {
            Self::Butterworth(filter) => filter.settling_count(),
            Self::Fir(_) => WindowedFir::PAPER_LENGTH,
        }
    }

    fn vectors<const N: usize>(&self, columns: &[[f64; N]]) -> Vec<[f64; N]> {
        let mut out = columns.to_vec();
        for component in 0..N {
            let column: Vec<f64> = columns.iter().map(|v| v[component]).collect();
            for (out, value) in out.iter_mut().zip(self.apply(&column)) {
                out[component] = value;
            }
        }
        out
    }
}

/// Signals low-passed without phase: what both models are built from.
struct Filtered {
    rate: Vec<Vector3<f64>>,
    up: Option<Vec<Vector3<f64>>>,
    /// R^T v
    velocity: Option<Vec<Vector3<f64>>>,
    /// accelerometer z, where attitude or velocity are missing
    specific_force_z: Option<Vec<f64>>,
    wrench: Vec<Vector4<f64>>,
}

/// Both models of one flight, or `None` where body rates, or the vertical motion, are not recorded.
#[must_use]
pub fn paper_models(
    signals: &Signals,
    gravity_m_s2: f64,
    filter: &ZeroPhase,
) -> Option<(SampledModel, SampledModel)> {
    if !signals.quality.torques {
        return None;
    }
    let filtered = Filtered::from(signals, filter)?;
    let step_s = signals.grid.step_s;
    let omega_dot = differentiated(&filtered.rate, step_s);
    let vertical = vertical(&filtered, gravity_m_s2, step_s)?;
    let pair = FilterPair::new(FilterPair::PAPER_LAMBDA_RAD_S, step_s);

    let count = signals.grid.count;
    let (mut standard, mut by_filter) = (SampledModel::empty(step_s), SampledModel::empty(step_s));
    let edge = filter.edge_count();
    let inside: Vec<bool> = (0..count).map(|i| signals.usable[i] && i >= edge && i + edge < count).collect();
    let mut runs = crate::signals::Grid::runs(&inside, 50).into_iter().peekable();
    let (mut phi, mut low_wrench) = (FilteredPhi::new(pair), [PairMemory::default(); 4]);
    // the filters run through the whole flight; what they give is kept where it may be used
    for (i, omega_dot) in omega_dot.iter().enumerate() {
        let filtered_phi = phi.next(vertical.momentum[i], vertical.rest[i], &filtered.rate[i]);
        let wrench = filtered.wrench[i];
        let filtered_wrench =
            Vector4::from_fn(|entry, _| pair.step_low_pass(&mut low_wrench[entry], wrench[entry]));
        let Some(run) = runs.peek().filter(|run| run.contains(&i)) else { continue };
        let force = vertical.rate[i] + vertical.rest[i];
        let time_s = signals.grid.time_s(i);
        standard.push(time_s, Phi::of(force, &filtered.rate[i], omega_dot), wrench);
        by_filter.push(time_s, filtered_phi, filtered_wrench);
        if i + 1 == run.end {
            let kept = standard.time_s.len() - run.len()..standard.time_s.len();
            standard.runs.push(kept.clone());
            by_filter.runs.push(kept);
            runs.next();
        }
    }
    Some((standard, by_filter))
}

impl SampledModel {
    fn empty(step_s: f64) -> Self {
        Self { step_s, ..Self::default() }
    }

    fn push(&mut self, time_s: f64, gamma: Phi, upsilon: Vector4<f64>) {
        self.time_s.push(time_s);
        self.gamma.push(gamma);
        self.upsilon.push(upsilon);
    }

    /// Appends another flight's samples.
    pub fn extend(&mut self, other: Self) {
        if self.time_s.is_empty() {
            *self = other;
            return;
        }
        let shift = self.time_s.len();
        self.step_s = other.step_s;
        self.time_s.extend(other.time_s);
        self.gamma.extend(other.gamma);
        self.upsilon.extend(other.upsilon);
        self.runs.extend(other.runs.iter().map(|run| run.start + shift..run.end + shift));
    }
}

impl Filtered {
    fn from(signals: &Signals, filter: &ZeroPhase) -> Option<Self> {
        let rate = filter.vectors(&arrays(signals.rate.as_ref()?));
        let attitude: Option<Vec<UnitQuaternion<f64>>> = signals.attitude.as_ref().map(|attitude| {
            let flat: Vec<[f64; 4]> = attitude.iter().map(|q| [q.w, q.i, q.j, q.k]).collect();
            filter
                .vectors(&flat)
                .iter()
                .map(|q| UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3])))
                .collect()
        });
        // the recorded velocity where there is one; the paper had to differentiate position
        let velocity = signals.velocity.as_ref().map(|v| filter.vectors(&arrays(v))).or_else(|| {
            let position = filter.vectors(&arrays(signals.position.as_ref()?));
            let rate = differentiated(&vectors(&position), signals.grid.step_s);
            Some(arrays(&rate))
        });
        let velocity = attitude.as_ref().zip(velocity).map(|(attitude, v)| {
            attitude.iter().zip(vectors(&v)).map(|(q, v)| q.inverse_transform_vector(&v)).collect()
        });
        let up = attitude
            .map(|attitude| attitude.iter().map(|q| q.inverse_transform_vector(&Vector3::z())).collect());
        let specific_force_z = signals
            .specific_force
            .as_ref()
            .map(|f| filter.apply(&f.iter().map(|f| f.z).collect::<Vec<f64>>()));
        let wrench: Vec<[f64; 4]> = signals.wrench.iter().map(|w| [w[0], w[1], w[2], w[3]]).collect();
        let wrench = filter.vectors(&wrench).into_iter().map(Vector4::from).collect();
        Some(Self { rate: vectors(&rate), up, velocity, specific_force_z, wrench })
    }
}

/// The pieces of `w' + p v - q u + g_bz`.
struct Vertical {
    /// w, whose derivative the filtered model takes
    momentum: Vec<f64>,
    /// w'
    rate: Vec<f64>,
    /// p v - q u + g_bz
    rest: Vec<f64>,
}

fn vertical(filtered: &Filtered, gravity_m_s2: f64, step_s: f64) -> Option<Vertical> {
    if let (Some(velocity), Some(up)) = (&filtered.velocity, &filtered.up) {
        let momentum: Vec<f64> = velocity.iter().map(|v| v.z).collect();
        let rate = central_difference(&momentum, step_s);
        let rest = filtered
            .rate
            .iter()
            .zip(velocity)
            .zip(up)
            .map(|((w, v), up)| w.x * v.y - w.y * v.x + gravity_m_s2 * up.z)
            .collect();
        return Some(Vertical { momentum, rate, rest });
    }
    let rest = filtered.specific_force_z.clone()?;
    let zero = vec![0.0; rest.len()];
    Some(Vertical { momentum: zero.clone(), rate: zero, rest })
}

fn arrays(vectors: &[Vector3<f64>]) -> Vec<[f64; 3]> {
    vectors.iter().map(|v| [v.x, v.y, v.z]).collect()
}

fn vectors(arrays: &[[f64; 3]]) -> Vec<Vector3<f64>> {
    arrays.iter().map(|v| Vector3::from(*v)).collect()
}

fn differentiated(series: &[Vector3<f64>], step_s: f64) -> Vec<Vector3<f64>> {
    let components: [Vec<f64>; 3] = std::array::from_fn(|component| {
        central_difference(&series.iter().map(|v| v[component]).collect::<Vec<f64>>(), step_s)
    });
    (0..series.len()).map(|i| Vector3::new(components[0][i], components[1][i], components[2][i])).collect()
}
