//! Content of the view.

use crate::estimate::Finding;
use crate::fly::finding::Level;
use crate::fly::live::LiveEstimate;
use crate::fly::preflight::Page;
use std::collections::VecDeque;
use std::sync::Arc;

/// What is said of the simulated twin, lest it is taken for the vehicle.
pub const TWIN: &str = "the simulated twin, not your vehicle";
/// Values that a trace keeps; older ones are forgotten.
pub const HISTORY: usize = 120;
/// Places of the path that are kept; older ones are forgotten.
const PATH: usize = 600;
/// Between two places of the path, m.
const PATH_STEP_M: f64 = 0.05;
/// Events kept.
const EVENTS: usize = 200;

/// The last values of something.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace(VecDeque<f64>);

impl Trace {
    /// Adds a value.
    pub fn push(&mut self, value: f64) {
        if self.0.len() == HISTORY {
            self.0.pop_front();
        }
        self.0.push_back(value);
    }

    /// From the oldest to the newest.
    pub fn values(&self) -> impl DoubleEndedIterator<Item = f64> + ExactSizeIterator + Clone + '_ {
        self.0.iter().copied()
    }
}

/// State of the flight, for the colour of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Phase {
    /// before takeoff
    #[default]
    Preparing,
    /// in the air, as planned
    Flying,
    /// ended before its time
    Aborted,
    /// on the ground, done
    Done,
}

/// The link.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkView {
    /// s since the last frame of the vehicle; `None` before the first
    pub age_s: Option<f64>,
    /// frames a second
    pub frames_hz: f64,
    /// bytes a second
    pub bytes_s: f64,
    /// share of the frames that got lost, by their sequence numbers (-)
    pub loss: Option<f64>,
}

/// The battery.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Battery {
    /// percent of a full charge
    pub percent: Option<f64>,
    /// V
    pub voltage_v: Option<f64>,
    /// low or worse by the autopilot's own judgement
    pub is_low: bool,
}

/// Tracking of the vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tracking {
    /// m between reference and position; `None` while nothing is followed
    pub error_m: Option<f64>,
    /// m at which the flight is aborted
    pub limit_m: Option<f64>,
    /// m, lately
    pub history_m: Trace,
}

/// Attitude and motion, world NWU.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(missing_docs, reason = "each name says quantity and unit")]
pub struct Attitude {
    pub roll_deg: f64,
    pub pitch_deg: f64,
    pub yaw_deg: f64,
    pub position_m: [f64; 3],
    pub velocity_m_s: [f64; 3],
}

/// One line of the list of events.
#[derive(Debug, Clone, PartialEq)]
pub struct EventLine {
    /// s since the connection
    pub time_s: f64,
    /// severity
    pub level: Level,
    /// what happened
    pub text: String,
}

/// One parameter as it converges.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterRow {
    /// as in files
    pub name: &'static str,
    /// as in files
    pub unit: &'static str,
    /// `None` before there is an estimate
    pub value: Option<f64>,
    /// standard error, same unit; zero for what is given
    pub std: Option<f64>,
    /// why there is none
    pub why: Option<String>,
    /// lately
    pub history: Trace,
}

/// Content of the view.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ViewModel {
    /// vehicle and autopilot
    pub title: String,
    /// it is the simulated twin of the operator's vehicle
    pub is_twin: bool,
    /// what the flight is doing, in a few words
    pub state: String,
    /// its colour
    pub phase: Phase,
    /// the autopilot's mode
    pub mode: String,
    /// motors may turn
    pub armed: bool,
    /// page to be read before the vehicle is armed
    pub page: Option<Arc<Page>>,
    /// the line of it from which on it is shown
    pub page_from: usize,
    /// the word for arming is waited for
    pub awaits_word: bool,
    /// the page before the flight is yet to come: of all keys only Ctrl-C counts
    pub keys_wait: bool,
    /// how long this program or its computer stood still, s; `None` if it did not lately
    pub stall_s: Option<f64>,
    /// s since the connection
    pub elapsed_s: f64,
    /// s of the trajectory flown, and of all of it
    pub progress_s: Option<(f64, f64)>,
    /// link
    pub link: LinkView,
    /// battery
    pub battery: Battery,
    /// tracking
    pub tracking: Tracking,
    /// attitude and motion
    pub attitude: Option<Attitude>,
    /// north and west of where it was lately, m
    pub path_m: VecDeque<[f64; 2]>,
    /// parameters, in the order of files
    pub parameters: Vec<ParameterRow>,
    /// what the first estimate of them waits for
    pub parameters_await: Option<String>,
    /// s of flight that they rest on
    pub parameters_used_s: f64,
    /// what happened
    pub events: VecDeque<EventLine>,
    /// events that happened in all, those forgotten among them
    pub event_count: u64,
    /// typed text, if a word is requested
    pub typed: Option<String>,
    /// what was entered in place of the word for arming
    pub refused: Option<String>,
}

impl ViewModel {
    /// Adds an event.
    pub fn event(&mut self, level: Level, text: impl Into<String>) {
        if self.events.len() == EVENTS {
            self.events.pop_front();
        }
        self.events.push_back(EventLine { time_s: self.elapsed_s, level, text: text.into() });
        self.event_count += 1;
    }

    /// Takes attitude and motion of this moment.
    pub fn moves(&mut self, attitude: Option<Attitude>) {
        self.attitude = attitude;
        let Some([north_m, west_m, _]) = attitude.map(|attitude| attitude.position_m) else { return };
        let is_near = |[n, w]: &[f64; 2]| (north_m - n).hypot(west_m - w) < PATH_STEP_M;
        if self.path_m.back().is_some_and(is_near) {
            return;
        }
        if self.path_m.len() == PATH {
            self.path_m.pop_front();
        }
        self.path_m.push_back([north_m, west_m]);
    }

    /// Takes the tracking error (m) of this moment.
    pub fn track(&mut self, error_m: f64) {
        self.tracking.error_m = Some(error_m);
        self.tracking.history_m.push(error_m);
    }

    /// Takes an estimate of the parameters.
    pub fn estimate(&mut self, estimate: &LiveEstimate) {
        if self.parameters.is_empty() {
            let blank = |parameter: &crate::fly::live::LiveParameter| ParameterRow {
                name: parameter.name,
                unit: parameter.unit,
                value: None,
                std: None,
                why: None,
                history: Trace::default(),
            };
            self.parameters = estimate.parameters.iter().map(blank).collect();
        }
        self.parameters_used_s = estimate.used_s;
        for (row, parameter) in self.parameters.iter_mut().zip(&estimate.parameters) {
            row.why = None;
            (row.value, row.std) = match &parameter.finding {
                Finding::Determined { value, std } => (Some(*value), Some(*std)),
                Finding::Given { value } => (Some(*value), Some(0.0)),
                Finding::NotDetermined { reason } => {
                    row.why = Some(reason.clone());
                    (None, None)
                }
            };
            if let Some(value) = row.value {
                row.history.push(value);
            }
        }
    }
}
