//! What is asked of a candidate before it is named.

use super::base::moved_to;
use super::channels::SECOND;
use super::fit::Fitted;
use super::mounting;
use super::tested::Tested;

/// What is asked of a candidate before it is named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gates {
    /// normal deviate
    pub z: f64,
    /// family-wise chance of the cluster test, shared out to the candidates
    pub p_cluster: f64,
    /// share of the residual energy
    pub gain: f64,
    /// least force that matters, of the weight, or torque, of the torque that the motion took (rms)
    pub matters: (f64, f64),
    /// most effects that are accepted
    pub steps: usize,
}

impl Gates {
    /// Normal deviate asked of an effect.
    #[must_use]
    pub fn deviate(&self, id: &str) -> f64 {
        if LIKELIER.contains(&id) { self.z + MORE_Z } else { self.z }
    }

    /// An effect's share of the family-wise chance, among so many candidates: a twentieth of it for what every vehicle
    /// has, the rest for the others alike.
    fn share(&self, id: &str, candidates: f64) -> f64 {
        if id == EVERYWHERE {
            EVERYWHERE_SHARE * self.p_cluster
        } else {
            (1.0 - EVERYWHERE_SHARE) * self.p_cluster / candidates
        }
    }
}

impl Default for Gates {
    fn default() -> Self {
        Self { z: 4.0, p_cluster: 0.02, gain: 0.004, matters: (4e-4, 0.04), steps: 6 }
    }
}

/// Effects that are tried at many heights, lengths or times, the largest of which counts; and the thrust curve, which
/// bends the commands' own noise, too.
const LIKELIER: [&str; 4] = ["ceiling_effect", "slung_load", "mass_change", "thrust_curve"];
/// Every rotor has it; and no force of the room, which position and velocity tell of, looks like it.
const EVERYWHERE: &str = "rotor_inertia";
const EVERYWHERE_SHARE: f64 = 0.05;
/// What that adds to the normal deviate asked for.
const MORE_Z: f64 = 1.0;

/// No thrust curve is known to better than this (-).
const ORDINARY_BEND: f64 = 0.02;

/// The size (norm of the amounts) below which an effect is like any vehicle's; `None` for those that no vehicle has.
pub(super) fn ordinary_size(id: &str) -> Option<f64> {
    if id == "thrust_curve" { Some(ORDINARY_BEND) } else { mounting::ordinary_size(id) }
}

/// A ceiling whose a1 is larger lifts by little more than a twentieth a rotor's radius below it: that is none.
pub(super) const WEAKEST_CEILING: f64 = 20.0;

/// Significant, spread over the flight, possible, and large enough to matter.
pub(super) fn passes(tested: &Tested, fitted: &Fitted, gates: &Gates, candidates: f64) -> bool {
    let evidence = &tested.evidence;
    let weight_n = fitted.base.vehicle.body.mass_kg * fitted.base.vehicle.gravity_m_s2;
    let force = |channel: usize| evidence.rms[channel] > gates.matters.0 * weight_n;
    let matters = (0..3).any(|axis| {
        force(axis)
            || force(SECOND + axis)
            || evidence.rms[3 + axis] > gates.matters.1 * fitted.rows.torque_rms[axis]
    });
    evidence.z.abs() > gates.deviate(tested.candidate.id)
        && evidence.p_cluster < gates.share(tested.candidate.id, candidates)
        && evidence.gain >= gates.gain
        && matters
        && ordinary_size(tested.candidate.id).is_none_or(|ordinary| evidence.size() > ordinary)
        && possible(tested)
}

/// No multirotor flies in more wind, m/s.
const STORM_M_S: f64 = 20.0;

/// Each coefficient's sign and size is one that physics allows, within two standard errors.
fn possible(tested: &Tested) -> bool {
    if tested.candidate.through.is_some() {
        // the wind's columns carry the drag's strength
        let theta = &tested.evidence.theta;
        let drag_n_s_m = 0.5 * (theta[0] + theta[1]);
        let strongest = theta[2..].iter().fold(0.0, |most: f64, push_n| most.max(push_n.abs()));
        return theta[0] > 0.0 && theta[1] > 0.0 && strongest < STORM_M_S * drag_n_s_m;
    }
    let mut index = 0;
    let mut all = true;
    for part in &tested.candidate.parts {
        for &free in &part.free {
            let (by, slack) = (tested.evidence.theta[index], 2.0 * tested.evidence.std(index));
            // towards what is possible by two standard errors
            let reaches = |by: f64| {
                let value = moved_to(part, free, by);
                let ceiling = part.effect.id() == "ceiling_effect" && free == 0;
                part.possible(free, value) == value && !(ceiling && value > WEAKEST_CEILING)
            };
            all &= reaches(by) || reaches(by - slack) || reaches(by + slack);
            index += 1;
        }
    }
    all
}
