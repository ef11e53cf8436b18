//! Conditions that a candidate must satisfy before it is named.

use super::channels::SECOND;
use super::fit::Fitted;
use super::signature::Signature;
use super::tested::Tested;
use crate::vehicle::VehicleSize;

/// Conditions of a name.
///
/// The defaults are set by judgement, as are other conditions of the diagnosis that say so. No bench varies one of them alone: what is
/// measured is all of them together, in flights that no threshold was set on. No flight of 300 without a concealed effect got a name,
/// and the effects of 12 flights each were named as `docs/measured.json` says (`cargo bench --bench explain -- --clean 300 --each 12
/// --pairs 12 --seed 2026112501`). Of 600 such flights with an estimator in the loop one got a name (`cargo bench --bench blind --
/// --realistic --clean 600 --cases 3 --several 16 --seed 20350000`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gates {
    /// normal deviate
    pub z: f64,
    /// family-wise p-value of the cluster test, divided among the candidates
    pub p_cluster: f64,
    /// share of the residual energy
    pub gain: f64,
    /// least relevant force, as a share of the weight, and least relevant torque, as a share of the rms of the torque
    /// that the motion needs
    pub matters: (f64, f64),
    /// largest number of effects in the model; those that left it do not count
    pub steps: usize,
}

impl Gates {
    /// Least normal deviate of an effect.
    #[must_use]
    pub fn deviate(&self, signature: &Signature) -> f64 {
        self.z + signature.naming.extra_z
    }

    /// An effect's share of the family-wise p-value for this number of candidates: a twentieth for an effect that every
    /// vehicle has, the rest divided equally among the others.
    fn share(&self, signature: &Signature, candidates: f64) -> f64 {
        if signature.naming.ubiquitous {
            UBIQUITOUS_SHARE * self.p_cluster
        } else {
            (1.0 - UBIQUITOUS_SHARE) * self.p_cluster / candidates
        }
    }
}

/// Standard errors by which an effect must differ from zero to get a name; see [`Gates`].
pub const NAME_Z: f64 = 4.0;

impl Default for Gates {
    fn default() -> Self {
        Self { z: NAME_Z, p_cluster: 0.02, gain: 0.004, matters: (4e-4, 0.04), steps: 6 }
    }
}

/// Share of the family-wise p-value for an effect that every vehicle has. Set on flights with rotor inertia (`cargo
/// bench --bench explain`, seed 1201), where an equal share for 58 candidates missed two flights of 12.
const UBIQUITOUS_SHARE: f64 = 0.05;

/// A condition that a candidate does not satisfy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gate {
    /// the normal deviate is too small
    Deviate,
    /// not distributed over the flight
    Blocks,
    /// too small a share of the residual energy
    Gain,
    /// force and torque too small to matter
    Matters,
    /// no larger than on ordinary vehicles
    Ordinary,
    /// sign or size not physically possible
    Possible,
}

impl Gate {
    /// Words for reports.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Deviate => "z too small",
            Self::Blocks => "not spread over the flight",
            Self::Gain => "explains too little",
            Self::Matters => "too small to matter",
            Self::Ordinary => "ordinary size",
            Self::Possible => "size not possible",
        }
    }
}

/// The first condition that a candidate does not satisfy: whether it is significant, distributed over the flight, physically
/// possible, and large enough to matter.
#[must_use]
pub fn refused_by(tested: &Tested, fitted: &Fitted, gates: &Gates, candidates: f64) -> Option<Gate> {
    let evidence = &tested.evidence;
    let weight_n = fitted.weight_n();
    let force = |channel: usize| evidence.rms[channel] > gates.matters.0 * weight_n;
    let matters = (0..3).any(|axis| {
        force(axis)
            || force(SECOND + axis)
            || evidence.rms[3 + axis] > gates.matters.1 * fitted.rows.torque_rms[axis]
    });
    let Some(signature) = tested.candidate.signature() else { return Some(Gate::Possible) };
    let ordinary = signature.naming.ordinary;
    let conditions = [
        (Gate::Deviate, evidence.z.abs() > gates.deviate(signature)),
        (Gate::Blocks, evidence.p_cluster < gates.share(signature, candidates)),
        (Gate::Gain, evidence.gain >= gates.gain),
        (Gate::Matters, matters),
        (Gate::Ordinary, ordinary.is_none_or(|ordinary| evidence.size() > ordinary)),
        (Gate::Possible, possible(tested, &fitted.base.size)),
    ];
    conditions.into_iter().find(|(_, holds)| !holds).map(|(gate, _)| gate)
}

/// Whether a candidate satisfies all conditions.
pub(super) fn passes(tested: &Tested, fitted: &Fitted, gates: &Gates, candidates: f64) -> bool {
    refused_by(tested, fitted, gates, candidates).is_none()
}

/// Greatest wind that a fit may contain, m/s: multirotors do not fly in more. It only keeps a fit from running away.
const STORM_M_S: f64 = 20.0;

/// Whether sign and size of each coefficient are physically possible, within two standard errors.
pub(super) fn possible(tested: &Tested, size: &VehicleSize) -> bool {
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
                let value = part.moved_to(free, by);
                let most = part.signature.naming.most.filter(|_| part.is_amount(free));
                part.possible(free, value, size) == value && most.is_none_or(|most| value <= most)
            };
            all &= reaches(by) || reaches(by - slack) || reaches(by + slack);
            index += 1;
        }
    }
    all
}
