//! A value of a vehicle that nobody measured.

/// What a guess is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Guessed {
    /// distance of the rotors from the centre
    Arms,
    /// moments of inertia
    Inertia,
    /// torque for each thrust of a rotor
    TorqueRatio,
    /// largest thrust of a rotor
    ThrustMax,
    /// shape of the thrust curve
    Expo,
    /// radius of a rotor
    RotorRadius,
    /// where the centre of mass is across the rotors' axes, and how alike the rotors are
    CenterOfMass,
}

impl Guessed {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Arms,
        Self::Inertia,
        Self::TorqueRatio,
        Self::ThrustMax,
        Self::Expo,
        Self::RotorRadius,
        Self::CenterOfMass,
    ];

    /// As files name it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Arms => "arms",
            Self::Inertia => "inertia",
            Self::TorqueRatio => "torque_ratio",
            Self::ThrustMax => "thrust_max",
            Self::Expo => "thrust_curve",
            Self::RotorRadius => "rotor_radius",
            Self::CenterOfMass => "center_of_mass",
        }
    }

    /// In a sentence.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Arms => "the length of the arms",
            Self::Inertia => "the nominal moments of inertia",
            Self::TorqueRatio => "the rotors' torque per thrust",
            Self::ThrustMax => "the rotors' largest thrust",
            Self::Expo => "the shape of the thrust curve",
            Self::RotorRadius => "the rotors' radius",
            Self::CenterOfMass => "the centre of mass, over the arms",
        }
    }
}

/// A value of a vehicle that nobody measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// which value
    pub of: Guessed,
    /// standard error over the value; of the thrust curve, of its exponent itself; of the centre of mass, over the mean arm
    pub relative: f64,
    /// what it rests on
    pub why: String,
}
