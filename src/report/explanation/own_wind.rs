//! The wind of several flights in words: it is each flight's own, and no effect of the vehicle.

use crate::diagnose::Named;
use crate::diagnose::signatures::signature_of;
use crate::study::ExplainStudy;
use crate::text::list;

/// Most winds that are told one by one; of more the range is.
const TOLD: usize = 3;

/// The steady wind of the flights, with which they are seen; `None` where none shows one, and where a wind is among the names.
pub(super) fn own_wind(study: &ExplainStudy) -> Option<String> {
    let is_wind = |named: &Named| signature_of(named.id).is_some_and(|of| of.role.wind.is_some());
    let is_named = study.effects.iter().any(is_wind);
    words(&study.along.as_ref()?.winds_m_s).filter(|_| !is_named)
}

/// North and west of each flight, m/s, as `a steady wind of 2.1 to 3.4 m/s, each flight its own`.
fn words(winds_m_s: &[Option<[f64; 2]>]) -> Option<String> {
    let blows = winds_m_s.iter().flatten();
    let speeds: Vec<f64> = blows.map(|[north, west]| north.hypot(*west)).collect();
    let (least, most) =
        speeds.iter().fold((f64::MAX, 0.0_f64), |(least, most), of| (least.min(*of), most.max(*of)));
    let told: Vec<String> = speeds.iter().map(|of| format!("{of:.1}")).collect();
    let size = if told.len() <= TOLD { list(&told) } else { format!("{least:.1} to {most:.1}") };
    let (with, all) = (speeds.len(), winds_m_s.len());
    let whose = match with {
        0 => return None,
        _ if with == all => ", each flight its own".to_owned(),
        1 => format!(" in one of {all} flights"),
        _ => format!(" in {with} of {all} flights, each its own"),
    };
    Some(format!("a steady wind of {size} m/s{whose}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wind_is_told_with_its_sizes_and_whose_it_is() {
        let of = |winds: &[Option<[f64; 2]>]| words(winds).unwrap_or_default();
        let (slow, fast) = (Some([-1.2, 1.6]), Some([3.0, 4.0]));
        assert_eq!(of(&[None, None]), "");
        assert_eq!(of(&[fast, slow]), "a steady wind of 5.0 and 2.0 m/s, each flight its own");
        assert_eq!(of(&[slow, fast, fast, slow]), "a steady wind of 2.0 to 5.0 m/s, each flight its own");
        assert_eq!(of(&[None, slow]), "a steady wind of 2.0 m/s in one of 2 flights");
        assert_eq!(
            of(&[slow, None, fast]),
            "a steady wind of 2.0 and 5.0 m/s in 2 of 3 flights, each its own"
        );
    }
}
