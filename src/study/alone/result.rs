//! What one log shows by itself.

use std::collections::BTreeMap;

use crate::diagnose::{Explanation, FlightParameter};
use crate::inspect::Inspection;
use crate::note::Note;
use crate::study::InputFile;
use crate::trim::Leg;
use crate::vehicle::Vehicle;

/// One log by itself.
#[derive(Debug)]
pub struct AloneStudy {
    /// what is in it
    pub inspection: Inspection,
    /// the vehicle's parameters
    pub parameters: BTreeMap<String, f64>,
    /// as given or drafted; `None` where the log does not say where the rotors are
    pub vehicle: Option<Vehicle>,
    /// lengths and mass of it are known; otherwise the balance is in shares and arms
    pub is_known: bool,
    /// flights that could be studied, in order
    pub flights: Vec<AloneFlight>,
    /// why no flight, or not each, could be studied; `None`: all were, or none was asked for
    pub refused: Option<String>,
    /// what is to be known of the vehicle's description
    pub notes: Vec<Note>,
}

/// One flight of a log.
#[derive(Debug)]
pub struct AloneFlight {
    /// its file, and which flight of it
    pub input: InputFile,
    /// s of the vehicle's clock: spans in the air
    pub airborne_s: Vec<(f64, f64)>,
    /// its balance, leg by leg; `Err`: why it shows none
    pub legs: Result<Vec<Leg>, String>,
    /// mean electrical power in the air, W
    pub power_w: Option<f64>,
    /// white part of the accelerometer's samples in the air, m/s^2, with its standard error
    pub vibration_m_s2: Option<(f64, f64)>,
    /// what the motion shows; `Err`: why it was not compared
    pub explained: Result<Explained, String>,
    /// what is doubtful about its data
    pub doubts: Vec<Note>,
}

/// What the motion of one flight shows.
#[derive(Debug)]
pub struct Explained {
    /// the search
    pub explanation: Explanation,
    /// the vehicle's parameters with a drag beside them
    pub parameters: Vec<FlightParameter>,
}
