//! What the diagnosis knows of an effect beside its equation: one value of [`Signature`] an effect.

use super::channels::Nuisance;
use super::recorded::{Need, Recorded};
use super::wording::Words;
use crate::physics::Effect;
use crate::vehicle::Vehicle;

/// What the diagnosis knows of an effect. Data and small functions; nothing else in the diagnosis, the report or the
/// commands asks for an effect by its identifier.
#[derive(Debug)]
pub struct Signature {
    /// the equation
    pub effect: &'static dyn Effect,
    /// what a flight has to hold for the effect to be tried
    pub needs: &'static [Need],
    /// slots of the values that say how much of the effect there is; the others say what it is like
    pub amounts: &'static [usize],
    /// how the effect grows with its amount
    pub growth: Growth,
    /// value of an amount at which the effect vanishes
    pub nothing: f64,
    /// forms that the search tries
    pub forms: fn(&Recorded) -> Vec<Form>,
    /// how the search goes on once a form is taken
    pub refinement: Refinement,
    /// what is asked of it before it is named
    pub naming: Naming,
    /// through what it acts, and what it shares with other effects
    pub role: Role,
    /// how it is fitted where the user asks for it
    pub joint: Joint,
    /// what a person reads
    pub words: Words,
}

impl Signature {
    /// A signature with nothing special: every parameter is an amount, tried from zero in one form.
    #[must_use]
    pub const fn of(effect: &'static dyn Effect, amounts: &'static [usize], words: Words) -> Self {
        Self {
            effect,
            needs: &[],
            amounts,
            growth: Growth::Proportional,
            nothing: 0.0,
            forms: |_| Vec::new(),
            refinement: Refinement::NONE,
            naming: Naming::PLAIN,
            role: Role::NONE,
            joint: Joint::PLAIN,
            words,
        }
    }

    /// Identifier as in reports and files.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.effect.id()
    }

    /// The effect at these values, of which `free` are estimated.
    #[must_use]
    pub fn term(&'static self, values: &[f64], free: &[usize]) -> EffectTerm {
        EffectTerm { signature: self, values: values.to_vec(), free: free.to_vec() }
    }

    /// The same as a form of the search.
    #[must_use]
    pub fn form(&'static self, values: &[f64], free: &[usize]) -> Form {
        Form { term: self.term(values, free), instead_of_nuisance: false }
    }

    /// All parameters from zero, all estimated.
    #[must_use]
    pub fn whole(&'static self) -> EffectTerm {
        let count = self.effect.parameters().len();
        self.term(&vec![0.0; count], &(0..count).collect::<Vec<_>>())
    }
}

/// How an effect grows with its amount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Growth {
    /// in proportion
    Proportional,
    /// with the inverse of the amount; `usual` is an amount that was measured
    Inverse {
        /// in the amount's unit
        usual: f64,
    },
}

/// A form in which the search tries an effect.
#[derive(Debug, Clone)]
pub struct Form {
    /// start values, and what of them is estimated
    pub term: EffectTerm,
    /// a nuisance stands for small sizes of it: it is tested without that nuisance, and only when nothing else passes
    pub instead_of_nuisance: bool,
}

/// A value that lies on a grid, its first step and where refining ends.
#[derive(Debug, Clone, Copy)]
pub enum GridScale {
    /// steps in the value's unit
    Even {
        /// slot of the values
        slot: usize,
        /// first step
        step: f64,
        /// last step
        least: f64,
    },
    /// steps as shares of the value
    Relative {
        /// slot of the values
        slot: usize,
        /// first step
        step: f64,
        /// last step
        least: f64,
    },
}

/// How the search goes on once a form is taken.
#[derive(Debug, Clone, Copy)]
pub struct Refinement {
    /// a value that is tried on a grid is brought between the grid's points
    pub grid: Option<GridScale>,
    /// that is done before the test: neighbours on the grid explain too little of it
    pub grid_before_test: bool,
    /// slots that are estimated from then on
    pub freed: fn(&EffectTerm) -> Vec<usize>,
    /// slots that are estimated at the end, in place of those before
    pub freed_last: &'static [usize],
    /// the same size in other forms
    pub other_forms: fn(&EffectTerm) -> Vec<EffectTerm>,
}

impl Refinement {
    /// The finer parameters, once the effect is there.
    pub const NONE: Self = Self {
        grid: None,
        grid_before_test: false,
        freed: first_finer,
        freed_last: &[],
        other_forms: |_| Vec::new(),
    };
}

/// The first finer parameter, where the values have it.
#[must_use]
pub fn first_finer(term: &EffectTerm) -> Vec<usize> {
    let finer = term.effect().parameters().len();
    if term.values.len() > finer { vec![finer] } else { Vec::new() }
}

/// What is asked of an effect before it is named.
#[derive(Debug, Clone, Copy)]
pub struct Naming {
    /// size (norm of the amounts) up to which every vehicle has it
    pub ordinary: Option<f64>,
    /// size of all parameters below which it stays in the model and gets no name
    pub least: f64,
    /// whether it is like any vehicle's beside the others of the model, whatever its size
    pub is_ordinary: fn(&EffectTerm, &[EffectTerm]) -> bool,
    /// added to the normal deviate that is asked for: it is tried at many values, the likeliest of which counts
    pub extra_z: f64,
    /// every rotor has it: a twentieth of the family-wise chance is its share
    pub ubiquitous: bool,
    /// greatest amount that is possible, where it is less than the parameter's bound
    pub most: Option<f64>,
    /// standard error that no flight gets below, in the amounts' unit
    pub least_std: f64,
    /// size on ordinary vehicles of what shows only where the vehicle moves
    pub usual: fn(&str, &Vehicle) -> Option<f64>,
    /// whether a parameter that is held belongs to what is said
    pub says: fn(&EffectTerm, usize) -> bool,
    /// whether a form has a smallest size that would have been named
    pub has_limit: fn(&EffectTerm) -> bool,
}

impl Naming {
    /// Nothing special.
    pub const PLAIN: Self = Self {
        ordinary: None,
        least: 0.0,
        is_ordinary: |_, _| false,
        extra_z: 0.0,
        ubiquitous: false,
        most: None,
        least_std: 0.0,
        usual: |_, _| None,
        says: |term, slot| term.values[slot] != 0.0,
        has_limit: |_| true,
    };
}

/// Lag or delay between command and rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LatencyKind {
    /// first order
    Lag,
    /// pure
    Delay,
}

/// Through what an effect acts, and what it shares with other effects.
#[derive(Debug, Clone, Copy)]
pub struct Role {
    /// acts through the latency and has no columns of its own
    pub latency: Option<LatencyKind>,
    /// a force of the air, through which wind shows
    pub of_air: bool,
    /// N/(m/s) of lateral drag for one of the first two parameters, at a mean airspeed, m/s
    pub lateral_slope: Option<fn(f64) -> f64>,
    /// slot of the drag along body z that is linear in the airspeed
    pub axial: Option<usize>,
    /// slot through which wind along body z shows
    pub vertical: Option<usize>,
    /// the law along body z of this other effect: for readers one drag where both agree
    pub axial_part_of: Option<&'static dyn Effect>,
    /// it is the wind, world, m/s: the forms in which it is tried together with the drag that carries it
    pub wind: Option<fn() -> Vec<Carried>>,
    /// slot that tells apart several of the same effect (which rotor)
    pub which: Option<usize>,
    /// what damps the rotation where a drag acts at the centre of mass
    pub damped_by: Option<fn() -> EffectTerm>,
    /// columns that resemble a latency's
    pub like_latency: Option<fn() -> EffectTerm>,
    /// shortens the latency that is found without it
    pub shortens_latency: bool,
    /// hangs below: it is no part of the vehicle's mass
    pub hangs_below: bool,
    /// slot of the moment at which it happens, s
    pub moment: Option<usize>,
    /// the day's, not the vehicle's
    pub of_the_day: bool,
    /// depends on how the vehicle moves
    pub by_motion: bool,
    /// the nuisance that stands for small sizes of it
    pub stands_for: fn(&EffectTerm, Nuisance) -> bool,
    /// the inertial unit is turned against the body
    pub turns_inertial_unit: bool,
}

impl Role {
    /// Nothing special.
    pub const NONE: Self = Self {
        latency: None,
        of_air: false,
        lateral_slope: None,
        axial: None,
        vertical: None,
        axial_part_of: None,
        wind: None,
        which: None,
        damped_by: None,
        like_latency: None,
        shortens_latency: false,
        hangs_below: false,
        moment: None,
        of_the_day: false,
        by_motion: true,
        stands_for: |_, _| false,
        turns_inertial_unit: false,
    };
}

/// An effect that acts through another one.
#[derive(Debug, Clone)]
pub struct Carried {
    /// the other one, to be estimated with it
    pub carrier: EffectTerm,
    /// the other one at a strength of one unit, about which the columns are
    pub unit: EffectTerm,
    /// the effect
    pub term: EffectTerm,
}

/// Why a parameter that was neither estimated nor held is what it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Whence {
    /// set
    Given(String),
    /// the flight does not say
    NotDetermined(&'static str),
}

/// Forms of an effect for the flights, given all effects that are asked for.
pub type JointForms = fn(&Recorded, &[&'static Signature]) -> Vec<EffectTerm>;

/// How an effect is fitted where the user asks for it.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// forms, the likeliest of which is taken; the effects are all that are asked for. `None`: one form, all
    /// parameters from zero
    pub forms: Option<JointForms>,
    /// why a parameter is what it is
    pub whence: fn(&EffectTerm, usize, &Vehicle, &[&'static Signature]) -> Option<Whence>,
    /// force and torque are no function of its parameters
    pub is_irregular: bool,
}

impl Joint {
    /// One form, all parameters from zero.
    pub const PLAIN: Self = Self { forms: None, whence: |_, _, _, _| None, is_irregular: false };
}

/// An effect with its values, and which of them are estimated: a term of the model.
#[derive(Debug, Clone)]
pub struct EffectTerm {
    /// which effect
    pub signature: &'static Signature,
    /// in the order of [`Effect::parameters`], then of [`Effect::finer_parameters`]
    pub values: Vec<f64>,
    /// indices of those that are estimated
    pub free: Vec<usize>,
}
