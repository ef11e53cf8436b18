//! Numbers of a named effect in words.

use super::named::{Named, NamedParameter};
use crate::text::{list, significant, spoken, with_error};
use crate::vehicle::AXIS_NAMES;

/// One number if the axes agree within two standard errors, or there is one axis; otherwise one for each axis. Of the parameters
/// `names` for x, y and z.
#[must_use]
pub fn axes(named: &Named, names: &[&str], unit: &str) -> String {
    let known: Vec<(&str, &NamedParameter)> =
        names.iter().zip(AXIS_NAMES).filter_map(|(name, axis)| Some((axis, named.get(name)?))).collect();
    if let [(axis, p)] = known.as_slice() {
        return format!("{} {unit} along body {axis}", with_error(p.value, p.std));
    }
    let parameters: Vec<&NamedParameter> = known.iter().map(|(_, p)| *p).collect();
    if let Some((mean, std)) = common(&parameters).filter(|_| known.len() > 1) {
        let along = list(&known.iter().map(|(axis, _)| (*axis).to_owned()).collect::<Vec<_>>());
        return format!("{} {unit} along body {along}", with_error(mean, std));
    }
    let each = known.iter().map(|(axis, p)| format!("{} along {axis}", with_error(p.value, p.std)));
    format!("{} {unit} of the body", list(&each.collect::<Vec<_>>()))
}

/// A size across the vehicle, beside which stands the one along body z.
struct Across<'a> {
    /// weighted mean along body x and y
    mean: f64,
    /// its standard error
    std: f64,
    /// along body z, where it is stated
    z: Option<&'a NamedParameter>,
}

impl<'a> Across<'a> {
    /// Of the parameters `names` for x, y and z; `None` where x or y is not stated, or both differ.
    fn of(named: &'a Named, [x, y, z]: [&str; 3]) -> Option<Self> {
        let (mean, std) = common(&[named.get(x)?, named.get(y)?])?;
        Some(Self { mean, std, z: named.get(z) })
    }

    /// The value along z where it is not said with the mean: it differs by two standard errors of the difference, or its
    /// relative error is larger. It holds other effects of the rotors in climb too.
    fn apart(&self) -> Option<&'a NamedParameter> {
        let goes_with = |z: &NamedParameter| {
            (z.value - self.mean).abs() < 2.0 * z.std.hypot(self.std)
                && z.std * self.mean.abs() <= self.std * z.value.abs()
        };
        self.z.filter(|&z| !goes_with(z))
    }
}

/// A size across the vehicle: the mean of body x and y, with which z is said if it agrees and is known as well, otherwise beside
/// it; one for each axis where x and y differ or one of them is not stated. Of the parameters `names` for x, y and z.
#[must_use]
pub fn across(named: &Named, names: [&str; 3], unit: &str) -> String {
    let Some(of) = Across::of(named, names) else { return axes(named, &names, unit) };
    let mean = with_error(of.mean, of.std);
    match (of.apart(), of.z) {
        (Some(z), _) => {
            format!("{mean} across and {} along z {unit} of the body", with_error(z.value, z.std))
        }
        (None, Some(_)) => format!("{mean} {unit} along body x, y and z"),
        (None, None) => format!("{mean} {unit} along body x and y"),
    }
}

/// The same without the axes that agree, and [`range`] where x and y differ or one of them is not stated.
#[must_use]
pub fn range_across(named: &Named, names: [&str; 3]) -> String {
    let Some(of) = Across::of(named, names) else { return range(named) };
    let unit = named.get(names[0]).map_or_else(String::new, |x| spoken(x.unit));
    let mean = plain(of.mean, of.std);
    match of.apart() {
        Some(z) => format!("{mean} across and {} along z {unit}", plain(z.value, z.std)),
        None => format!("{mean} {unit}"),
    }
}

/// Value and standard error of [`range_across`]: of the mean across, otherwise of [`largest`].
#[must_use]
pub fn largest_across(named: &Named, names: [&str; 3]) -> Option<(f64, f64)> {
    Across::of(named, names).map(|of| (of.mean, of.std)).or_else(|| largest(named))
}

/// Weighted mean and standard error of values that agree within two standard errors.
fn common(parameters: &[&NamedParameter]) -> Option<(f64, f64)> {
    let weight: f64 = parameters.iter().map(|p| p.std.powi(-2)).sum();
    let mean = parameters.iter().map(|p| p.value * p.std.powi(-2)).sum::<f64>() / weight;
    let alike = parameters.iter().all(|p| (p.value - mean).abs() < 2.0 * p.std);
    (alike && weight.is_finite()).then(|| (mean, weight.powf(-0.5)))
}

/// The parameters with the unit of the first one.
fn of_first_unit(named: &Named) -> Vec<&NamedParameter> {
    let unit = named.parameters.first().map(|first| first.unit);
    named.parameters.iter().filter(|p| Some(p.unit) == unit).collect()
}

/// One number if the axes agree within two standard errors, otherwise the least and the greatest.
#[must_use]
pub fn range(named: &Named) -> String {
    let same = of_first_unit(named);
    let Some(first) = same.first() else { return String::new() };
    let unit = spoken(first.unit);
    if let Some((mean, std)) = common(&same) {
        return format!("{} {unit}", plain(mean, std));
    }
    let by_value = |a: &&&NamedParameter, b: &&&NamedParameter| a.value.total_cmp(&b.value);
    let (least, most) = (same.iter().min_by(by_value), same.iter().max_by(by_value));
    let ends: Vec<String> = [least, most].into_iter().flatten().map(|p| plain(p.value, p.std)).collect();
    format!("{} {unit}", ends.join(" to "))
}

/// Value and standard error of [`range`]: of the common value, otherwise of the largest one.
#[must_use]
pub fn largest(named: &Named) -> Option<(f64, f64)> {
    let same = of_first_unit(named);
    common(&same).or_else(|| {
        let most = same.iter().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))?;
        Some((most.value, most.std))
    })
}

/// Norm of values, and its standard error.
#[must_use]
pub fn norm(parameters: &[&NamedParameter]) -> (f64, f64) {
    let norm = parameters.iter().map(|p| p.value * p.value).sum::<f64>().sqrt();
    let along = parameters.iter().map(|p| (p.value * p.std).powi(2)).sum::<f64>().sqrt();
    let largest = parameters.iter().map(|p| p.std).fold(0.0, f64::max);
    (norm, if norm > 0.0 { along / norm } else { largest })
}

/// Value and standard error without parentheses.
#[must_use]
pub fn plain(value: f64, std: f64) -> String {
    let text = with_error(value, std);
    if text.starts_with('(') { format!("{} +- {}", significant(value, 3), significant(std, 2)) } else { text }
}

/// A parameter multiplied by `factor`, with the displayed unit.
#[must_use]
pub fn said(named: &Named, name: &str, factor: f64, unit: &str) -> Option<String> {
    let p = named.get(name)?;
    Some(format!("{} {unit}", plain(factor * p.value, factor.abs() * p.std)).trim_end().to_owned())
}

/// Compass points, clockwise from north.
const POINTS: [&str; 8] =
    ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/// Degrees from north, clockwise, from where a wind towards north and west (m/s) comes.
#[must_use]
pub fn from_deg(north: f64, west: f64) -> f64 {
    west.atan2(-north).to_degrees().rem_euclid(360.0)
}

/// The point of the compass from where a wind towards north and west (m/s) comes.
#[must_use]
pub fn point_of(north: f64, west: f64) -> &'static str {
    let from_deg = from_deg(north, west);
    POINTS
        .iter()
        .cycle()
        .zip([0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0])
        .min_by(|a, b| (a.1 - from_deg).abs().total_cmp(&(b.1 - from_deg).abs()))
        .map_or("north", |(name, _)| name)
}
