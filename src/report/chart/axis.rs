//! Conversion of values to positions: linear or logarithmic, with round ticks.

/// One axis of a chart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    log: bool,
}

impl Axis {
    /// An axis over the values, with the share `spare` of their span free on both sides. A logarithmic axis covers only
    /// positive values.
    pub(super) fn covering(values: impl Iterator<Item = f64>, spare: f64, log: bool) -> Self {
        let placed = values
            .filter(|value| value.is_finite() && (!log || *value > 0.0))
            .map(|value| if log { value.log10() } else { value });
        let (low, high) = placed
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return Self { low: 0.0, high: 1.0, log };
        }
        let pad = if high > low { (high - low) * spare } else { low.abs().max(1e-9) * 0.1 };
        Self { low: low - pad, high: high + pad, log }
    }

    /// Relative position of a value between the low and the high end; `None` for a value outside of the axis' domain.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        let placed = if self.log { (value > 0.0).then(|| value.log10())? } else { value };
        placed.is_finite().then(|| (placed - self.low) / (self.high - self.low))
    }

    /// Round values with their texts: 1, 2 or 5 times a power of ten, or powers of ten.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        if self.log { self.decades() } else { linear_ticks((self.low, self.high)) }
    }

    fn decades(&self) -> Vec<(f64, String)> {
        let mut out = Vec::new();
        let mut power = self.low.ceil();
        let every = ((self.high - self.low) / 6.0).ceil().max(1.0);
        while power <= self.high && out.len() < 12 {
            let text = if (-3.0..4.0).contains(&power) {
                short(10.0_f64.powf(power))
            } else {
                format!("1e{power:.0}")
            };
            out.push((10.0_f64.powf(power), text));
            power += every;
        }
        if out.len() < 2 {
            let ends = linear_ticks((10.0_f64.powf(self.low), 10.0_f64.powf(self.high)));
            return ends.into_iter().filter(|(value, _)| *value > 0.0).collect();
        }
        out
    }
}

fn linear_ticks((low, high): (f64, f64)) -> Vec<(f64, String)> {
    let rough = (high - low) / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(rough);
    let mut out = Vec::new();
    let mut value = (low / step).ceil() * step;
    while value <= high && out.len() < 12 {
        let clean = if value.abs() < step * 1e-6 { 0.0 } else { value };
        out.push((clean, short(clean)));
        value += step;
    }
    out
}

fn short(value: f64) -> String {
    if value != 0.0 && (value.abs() < 1e-3 || value.abs() >= 1e5) {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.5}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let texts: Vec<String> = linear_ticks((0.0, 1.0)).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
    }

    #[test]
    fn a_logarithmic_axis_has_decades_and_no_place_for_zero() {
        let axis = Axis::covering([0.5, 200.0, 0.0, -3.0].into_iter(), 0.0, true);
        let texts: Vec<String> = axis.ticks().into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["1", "10", "100"]);
        assert_eq!(axis.share(0.0), None);
        assert!((axis.share(10.0).unwrap() - 0.5).abs() < 0.01);
    }
}
