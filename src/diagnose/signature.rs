//! Knowledge of the diagnosis about an effect, in addition to its equation: one [`Signature`] an effect.

use super::channels::Nuisance;
use super::picture::Picture;
use super::recorded::{Need, Recorded};
use super::usual_size::UsualSize;
use super::wording::Words;
use crate::physics::{Effect, Hook};
use crate::vehicle::Vehicle;

/// Knowledge of the diagnosis about an effect: data and small functions. Nothing else depends on an effect's identifier.
#[derive(Debug)]
pub struct Signature {
    /// the equation
    pub effect: &'static dyn Effect,
    /// requirements on a flight for the effect to be tested
    pub needs: &'static [Need],
    /// slots of the values that are amounts of the effect; the others describe its form
    pub amounts: &'static [usize],
    /// how the effect grows with its amount
    pub growth: Growth,
    /// value of an amount at which the effect vanishes
    pub nothing: f64,
    /// forms that the search tries
    pub forms: fn(&Recorded) -> Vec<Form>,
    /// how the search continues once a form is taken
    pub refinement: Refinement,
    /// conditions of its name
    pub naming: Naming,
    /// an example of its size on ordinary vehicles, by the parameters' names. Empty: as [`Naming::usual`] has each parameter
    pub sizes: &'static [(&'static str, UsualSize)],
    /// how it acts, and its relations to other effects
    pub role: Role,
    /// how it is fitted by `--with`
    pub joint: Joint,
    /// the picture that shows it
    pub picture: Picture,
    /// its words in reports
    pub words: Words,
}

impl Signature {
    /// A signature with the defaults: every parameter is an amount, tested from zero in one form.
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
            sizes: &[],
            role: Role::NONE,
            joint: Joint::PLAIN,
            picture: Picture::TIME,
            words,
        }
    }

    /// Identifier as in reports and files.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.effect.id()
    }

    /// Whether it alters the thrust that a constant command gives.
    #[must_use]
    pub fn alters_thrust(&self) -> bool {
        let alters = |hook: &Hook| matches!(hook, Hook::RotorSpeed | Hook::RotorThrust);
        self.role.latency.is_none() && self.effect.hooks().iter().any(alters)
    }

    /// Whether it is a law of the drag across the rotor axis.
    #[must_use]
    pub fn is_drag(&self) -> bool {
        self.role.lateral_slope.is_some()
    }

    /// Name and value of each parameter at an ordinary size on this vehicle; `None` where no size is stated.
    #[must_use]
    pub fn usual_values(&self, vehicle: &Vehicle) -> Option<Vec<(&'static str, f64)>> {
        if self.sizes.is_empty() {
            let usual = |name| Some((name, (self.naming.usual)(name, vehicle)?));
            return self.effect.parameters().iter().map(|parameter| usual(parameter.name)).collect();
        }
        Some(self.sizes.iter().map(|(name, size)| (*name, size.on(vehicle))).collect())
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

    /// The effect with all parameters at zero, the finer ones among them, and all of them estimated.
    #[must_use]
    pub fn whole_finer(&'static self) -> EffectTerm {
        let count = self.effect.parameters().len() + self.effect.finer_parameters().len();
        self.term(&vec![0.0; count], &(0..count).collect::<Vec<_>>())
    }

    /// The effect with all parameters at zero and all of them estimated.
    #[must_use]
    pub fn whole(&'static self) -> EffectTerm {
        let count = self.effect.parameters().len();
        self.term(&vec![0.0; count], &(0..count).collect::<Vec<_>>())
    }
}

/// Dependence of an effect on its amount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Growth {
    /// proportional to it
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
    /// start values, and which of them are estimated
    pub term: EffectTerm,
    /// a nuisance models small sizes of it: the effect is tested without that nuisance, and only if nothing else passes
    pub instead_of_nuisance: bool,
}

/// A value on a grid, with its first step and the last step of its refinement.
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

/// How the search continues once a form is taken.
#[derive(Debug, Clone, Copy)]
pub struct Refinement {
    /// a value that is tested on a grid is refined between the grid's points
    pub grid: Option<GridScale>,
    /// the refinement precedes the test, because neighbours on the grid explain too little of the effect
    pub grid_before_test: bool,
    /// slots that are estimated after the form was accepted
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

/// Conditions of an effect's name.
#[derive(Debug, Clone, Copy)]
pub struct Naming {
    /// size (norm of the amounts) that ordinary vehicles have: up to it there is no name
    pub ordinary: Option<f64>,
    /// share of the vehicle's mass up to which an amount in kg gets no name
    pub least_of_mass: f64,
    /// the amount is for each metre of height: what counts is that over the heights of the flight
    pub by_height: bool,
    /// share of the mean arm up to which an amount in m gets no name
    pub least_of_arm: f64,
    /// norm of all parameters below which it stays in the model without a name
    pub least: f64,
    /// size of a single one, in the amounts' unit, that `is_ordinary` calls so
    pub ordinary_alone: f64,
    /// whether it is ordinary in the presence of the other effects of the model, whatever its size
    pub is_ordinary: fn(&EffectTerm, &[EffectTerm]) -> bool,
    /// added to the least normal deviate, because the effect is tried at many values and the most likely one counts
    pub extra_z: f64,
    /// every vehicle has it: its share of the family-wise p-value is a twentieth
    pub ubiquitous: bool,
    /// greatest possible amount, if it is less than the parameter's bound
    pub most: Option<f64>,
    /// least standard error, in the amounts' unit
    pub least_std: f64,
    /// size on ordinary vehicles of an effect that appears only in motion
    pub usual: fn(&str, &Vehicle) -> Option<f64>,
    /// whether a fixed parameter is reported
    pub says: fn(&EffectTerm, usize) -> bool,
    /// whether a form has a smallest size that would have been named
    pub has_limit: fn(&EffectTerm) -> bool,
}

impl Naming {
    /// Nothing special.
    pub const PLAIN: Self = Self {
        ordinary: None,
        least_of_mass: 0.0,
        by_height: false,
        least_of_arm: 0.0,
        least: 0.0,
        ordinary_alone: 0.0,
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

/// Which values of an effect two flights of one vehicle have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfTheVehicle {
    /// slots of the values
    pub slots: &'static [usize],
    /// difference that flights of one vehicle have, in the unit of the values
    pub least_difference: f64,
}

impl OfTheVehicle {
    /// These slots; any difference counts.
    #[must_use]
    pub const fn of(slots: &'static [usize]) -> Self {
        Self { slots, least_difference: 0.0 }
    }
}

/// How an effect acts, and its relations to other effects.
#[derive(Debug, Clone, Copy)]
pub struct Role {
    /// acts through the latency and has no columns of its own
    pub latency: Option<LatencyKind>,
    /// an aerodynamic force, through which wind acts
    pub of_air: bool,
    /// N/(m/s) of lateral drag for one of the first two parameters, at a mean airspeed, m/s
    pub lateral_slope: Option<fn(f64) -> f64>,
    /// slot of the share that grows with the rotors' speed, and the values of the finer parameters up to it in the common form
    pub with_speed: Option<(usize, &'static [f64])>,
    /// slot of the drag along body z that is linear in the airspeed
    pub axial: Option<usize>,
    /// slot of the drag through which wind along body z acts
    pub vertical: Option<usize>,
    /// it has the law of this other effect along body z: both are reported as one drag if they agree
    pub axial_part_of: Option<&'static dyn Effect>,
    /// it is the wind (world, m/s): the forms in which it is tested together with the drag through which it acts
    pub wind: Option<fn() -> Vec<Carried>>,
    /// slot that distinguishes instances of the same effect (which rotor)
    pub which: Option<usize>,
    /// the effect that damps the rotation if a drag acts at the centre of mass
    pub damped_by: Option<fn() -> EffectTerm>,
    /// an effect whose columns resemble those of a latency
    pub like_latency: Option<fn() -> EffectTerm>,
    /// slot of a rotor's inertia (kg m^2) that takes yaw torque when its speed changes; without it the latency is found too long
    pub spin_up: Option<usize>,
    /// slot of the curvature that it gives to the thrust law
    pub bends_thrust: Option<usize>,
    /// it belongs to the vehicle, not to a flight
    pub of_the_vehicle: Option<OfTheVehicle>,
    /// it hangs below the vehicle and is not part of the vehicle's mass
    pub hangs_below: bool,
    /// slot of the time at which it happens, s
    pub moment: Option<usize>,
    /// it belongs to the day, not to the vehicle
    pub of_the_day: bool,
    /// it belongs to the loading: its first two amounts change where a battery is put back elsewhere
    pub of_the_loading: bool,
    /// depends on how the vehicle moves
    pub by_motion: bool,
    /// whether a nuisance models small sizes of it
    pub stands_for: fn(&EffectTerm, Nuisance) -> bool,
    /// it acts in descents alone
    pub in_descent: bool,
    /// it rotates the inertial unit against the body
    pub turns_inertial_unit: bool,
}

impl Role {
    /// Nothing special.
    pub const NONE: Self = Self {
        latency: None,
        of_air: false,
        lateral_slope: None,
        with_speed: None,
        axial: None,
        vertical: None,
        axial_part_of: None,
        wind: None,
        which: None,
        damped_by: None,
        like_latency: None,
        spin_up: None,
        bends_thrust: None,
        of_the_vehicle: None,
        hangs_below: false,
        moment: None,
        of_the_day: false,
        of_the_loading: false,
        by_motion: true,
        stands_for: |_, _| false,
        in_descent: false,
        turns_inertial_unit: false,
    };
}

/// An effect that acts through another one.
#[derive(Debug, Clone)]
pub struct Carried {
    /// the other effect, estimated together with it
    pub carrier: EffectTerm,
    /// the other effect at one unit, at which the columns are computed
    pub unit: EffectTerm,
    /// the effect
    pub term: EffectTerm,
}

/// Why a parameter that is neither estimated nor held has its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Whence {
    /// set
    Given(String),
    /// not determined by the flight, with the reason
    NotDetermined(&'static str),
}

/// Forms of an effect for the flights, given all effects of `--with`.
pub type JointForms = fn(&Recorded, &[&'static Signature]) -> Vec<EffectTerm>;

/// How an effect is fitted by `--with`.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// forms, of which the most likely is taken, given all effects of `--with`. `None`: one form, all parameters from zero
    pub forms: Option<JointForms>,
    /// why a parameter has its value
    pub whence: fn(&EffectTerm, usize, &Vehicle, &[&'static Signature]) -> Option<Whence>,
    /// force and torque are not a function of its parameters, and why
    pub irregular: Option<&'static str>,
}

impl Joint {
    /// One form, all parameters from zero.
    pub const PLAIN: Self = Self { forms: None, whence: |_, _, _, _| None, irregular: None };
}

/// A term of the model: an effect with its values, and which of them are estimated.
#[derive(Debug, Clone)]
pub struct EffectTerm {
    /// which effect
    pub signature: &'static Signature,
    /// in the order of [`Effect::parameters`], then of [`Effect::finer_parameters`]
    pub values: Vec<f64>,
    /// indices of those that are estimated
    pub free: Vec<usize>,
}
