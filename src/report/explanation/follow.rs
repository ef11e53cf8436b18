//! Along which state a residual runs: bins of the state with the mean residual in each.

use crate::diagnose::{Fitted, Trace};

/// A state that a residual may follow, one value a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// as in JSON
    pub name: &'static str,
    /// in words, with its unit
    pub label: &'static str,
    values: Vec<f64>,
}

/// Means of a residual over bins of a state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Binned {
    /// mean of the state
    pub at: Vec<f64>,
    /// mean of the residual
    pub mean: Vec<f64>,
    /// two standard errors of it, rows within a kernel's width counting once
    pub two_sigma: Vec<f64>,
    /// share of the residual's energy that the bins explain beyond chance (0..1)
    pub share: f64,
}

/// Bins with as many rows each.
const BINS: usize = 16;
/// Rows that share one kernel's noise.
const OVERLAP: f64 = 8.0;

/// All that is known of the state at every row of the flights.
#[must_use]
pub fn variables(traces: &[Trace], fitted: &Fitted) -> Vec<Variable> {
    let known = |what: fn(&Trace) -> bool| traces.iter().all(what);
    let mut out = Vec::new();
    let mut add = |name, label, pick: &dyn Fn(&Trace, usize) -> f64| {
        let values: Vec<f64> = traces
            .iter()
            .flat_map(|trace| trace.centers.iter().map(|&center| pick(trace, center)).collect::<Vec<_>>())
            .collect();
        out.push(Variable { name, label, values });
    };
    if known(|trace| trace.known.position) {
        add("world_x", "world x (north), m", &|t, i| t.states[i].position_m.x);
        add("world_y", "world y (west), m", &|t, i| t.states[i].position_m.y);
        add("world_z", "altitude, m", &|t, i| t.states[i].position_m.z);
    }
    if known(|trace| trace.known.velocity && trace.known.attitude) {
        add("airspeed_x", "velocity along body x, m/s", &|t, i| t.states[i].body_velocity_m_s().x);
        add("airspeed_y", "velocity along body y, m/s", &|t, i| t.states[i].body_velocity_m_s().y);
        add("airspeed_z", "velocity along body z, m/s", &|t, i| t.states[i].body_velocity_m_s().z);
        add("airspeed", "speed, m/s", &|t, i| t.states[i].velocity_m_s.norm());
    }
    add("rate_x", "body rate about x, rad/s", &|t, i| t.states[i].rates_rad_s.x);
    add("rate_y", "body rate about y, rad/s", &|t, i| t.states[i].rates_rad_s.y);
    add("rate_z", "body rate about z, rad/s", &|t, i| t.states[i].rates_rad_s.z);
    if known(|trace| trace.known.attitude) {
        add("yaw", "yaw, rad", &|t, i| t.states[i].attitude.euler_angles().2);
    }
    if known(|trace| trace.voltage_v.is_some()) {
        add("voltage", "battery voltage, V", &|t, i| t.voltage_v.as_ref().map_or(0.0, |v| v[i]));
    }
    let time_s = fitted.rows.time_s.clone();
    out.push(Variable { name: "time", label: "time, s", values: time_s });
    out
}

impl Binned {
    /// The state at which the mean is farthest from the median of the means.
    #[must_use]
    pub fn peak_at(&self) -> Option<f64> {
        let mut sorted = self.mean.clone();
        sorted.sort_by(f64::total_cmp);
        let median = *sorted.get(sorted.len() / 2)?;
        let away = |mean: &f64| (mean - median).abs();
        let far = self.at.iter().zip(&self.mean).max_by(|a, b| away(a.1).total_cmp(&away(b.1)));
        far.map(|(at, _)| *at)
    }
}

impl Variable {
    /// One value a row.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The residual in bins of this state.
    #[must_use]
    pub fn bin(&self, residual: &[f64]) -> Binned {
        let mut order: Vec<usize> = (0..self.values.len().min(residual.len())).collect();
        order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        let rows = order.len();
        if rows < 4 * BINS {
            return Binned::default();
        }
        let overall = order.iter().map(|&row| residual[row]).sum::<f64>() / rows as f64;
        let (mut out, mut between, mut total) = (Binned::default(), 0.0, 0.0);
        for bin in 0..BINS {
            let rows = &order[bin * rows / BINS..(bin + 1) * rows / BINS];
            let count = rows.len() as f64;
            let mean = rows.iter().map(|&row| residual[row]).sum::<f64>() / count;
            let spread = rows.iter().map(|&row| (residual[row] - mean).powi(2)).sum::<f64>();
            out.at.push(rows.iter().map(|&row| self.values[row]).sum::<f64>() / count);
            out.mean.push(mean);
            out.two_sigma.push(2.0 * (spread / count / (count / OVERLAP).max(1.0)).sqrt());
            between += count * (mean - overall).powi(2);
            total += spread + count * (mean - overall).powi(2);
        }
        let independent = rows as f64 / OVERLAP;
        let chance = (BINS as f64 - 1.0) / independent.max(BINS as f64);
        if total > 0.0 {
            out.share = ((between / total - chance) / (1.0 - chance).max(1e-9)).clamp(0.0, 1.0);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_a_state_is_found_and_noise_is_not() {
        let values: Vec<f64> = (0..800_u32).map(|i| (f64::from(i) * 0.37).sin()).collect();
        let variable = Variable { name: "airspeed_x", label: "", values: values.clone() };
        let follows: Vec<f64> = values.iter().map(|v| -0.4 * v).collect();
        let binned = variable.bin(&follows);
        assert!(binned.share > 0.9, "{}", binned.share);
        assert!(binned.peak_at().is_some_and(|at| at.abs() > 0.9));
        assert!(binned.mean[0] > 0.3 && binned.mean[BINS - 1] < -0.3);
        let noise: Vec<f64> =
            (0..800_u32).map(|i| f64::from(i.wrapping_mul(0x9E37_79B9) >> 16) / 65536.0 - 0.5).collect();
        assert!(variable.bin(&noise).share < 0.1);
    }
}
