//! The check "if setpoints end": the place at which the vehicle comes to rest if the setpoint of any instant is the
//! last, compared with ground, room and fence; and the choice of setpoints that keep it inside.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use super::Situation;
use super::aftermath::{self, Abandoned, SUBJECT};
use crate::autopilot::Takeoff;
use crate::fly::course::reference_at;
use crate::fly::finding::Finding;
use crate::fly::law::{FollowLaw, Motion, STEP_S};
use crate::fly::safety::{Feeding, SetpointBounds};
use crate::plan::{Reach, Wall};
use crate::trajectory::FlightPath;

/// Steps of the model between two tried instants: 0.1 s.
const EVERY: usize = 5;
/// Error of the model of ArduPilot, m. ArduPilot shapes its own reference and follows that. It is added to every
/// distance from a wall: larger refuses more, smaller trusts the model too much.
const ARDUPILOT_OFF_M: f64 = 0.15;
/// Error of the model of PX4, m, which models the vehicle itself: the embedded one came to rest 0.46 m further on.
const PX4_OFF_M: f64 = 0.5;
/// Largest distance of the rotors beyond walls and ceiling of the room, m, if nothing better is found; a warning is
/// given. Set so that the default plan of the X500 can be flown with PX4's default parameters; a warning is given.
const WALL_AT_MOST_M: f64 = 1.25;
/// Shares of velocity and acceleration in the setpoints that are tried, the largest first.
const SHARES: &[f64] = &[1.0, 0.75, 0.5, 0.35, 0.25, 0.15, 0.1, 0.0];
/// Share of the allowed distance to the reference that the setpoints themselves may use. The rest is for wind and for
/// what the model of the controller lacks.
const TRACKING_SHARE: f64 = 0.9;
/// Steps of the model over which the reference may have been at the vehicle's place: half a second, as in flight.
const RECENT: usize = 25;

/// One piece of the flight, in the local frame.
struct Leg<'a> {
    path: &'a FlightPath,
    offset_m: Vector3<f64>,
    /// it begins on the ground, so contact with the ground is no fault there
    from_ground: bool,
    name: &'static str,
}

/// The instant at which an end would be worst.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Worst {
    /// distance beyond the border, m, with the error of the model; negative inside
    beyond_m: f64,
    border: &'static str,
    /// s from the beginning of the leg
    time_s: f64,
    leg: &'static str,
}

/// Result of one kind of setpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tried {
    feeding: Feeding,
    worst: Option<Worst>,
    /// worst instant at ground and fence, which must not be passed
    hard: Option<Worst>,
    /// largest distance along the ground from home, and largest height above it, m
    farthest_m: f64,
    highest_m: f64,
    /// the greatest distance of the model to the reference, m
    tracking_m: f64,
}

impl Tried {
    fn untried(feeding: Feeding) -> Self {
        Self { feeding, worst: None, hard: None, farthest_m: 0.0, highest_m: 0.0, tracking_m: 0.0 }
    }

    fn beyond_m(&self) -> f64 {
        self.worst.map_or(f64::NEG_INFINITY, |worst| worst.beyond_m)
    }

    fn hard_m(&self) -> f64 {
        self.hard.map_or(f64::NEG_INFINITY, |worst| worst.beyond_m)
    }

    /// The worst instant to be reported: a reason for a refusal before one for a warning.
    fn worst_reported(&self) -> Option<Worst> {
        self.hard.filter(|hard| hard.beyond_m > 0.0).or(self.worst)
    }

    fn is_safe(&self, tracking_max_m: f64, wall_m: f64) -> bool {
        self.beyond_m() <= wall_m
            && self.hard_m() <= 0.0
            && self.tracking_m <= TRACKING_SHARE * tracking_max_m
    }
}

/// Chooses the kind of setpoint, and reports the result of a loss at the worst instant.
pub(super) fn judge(situation: &Situation<'_>) -> (Feeding, Vec<Finding>) {
    let laws = FollowLaw::of(situation.parameters, situation.release);
    let Some(law) = laws.first() else {
        let remedy = "fly PX4 or ArduPilot, or where there is nothing to hit";
        let came = "an autopilot whose behaviour is not known here";
        return (Feeding::whole(), vec![Finding::warning(SUBJECT, EXPECTED, came, remedy)]);
    };
    let mut findings = Vec::new();
    let chosen = choose(situation, &laws);
    findings.push(match &chosen {
        Ok(tried) => said(situation, law, tried),
        Err(tried) => refused(situation, &laws, tried),
    });
    findings.extend((laws.len() > 1).then(|| {
        let expected = "to know how the autopilot follows setpoints";
        let came = "a development version that follows them in one of two ways: setpoints may end at any time with both, and with the \
                    less likely one it may leave the reference, which ends the flight";
        Finding::warning(SUBJECT, expected, came, "fly a stable release of ArduPilot")
    }));
    let tried = chosen.unwrap_or_else(|tried| *tried);
    let comes_to = Abandoned { farthest_m: tried.farthest_m, highest_m: tried.highest_m };
    findings.extend(aftermath::findings(situation, comes_to));
    (tried.feeding, findings)
}

const EXPECTED: &str = "rest inside room and fence and clear of the ground, whenever setpoints end";

/// The kind of setpoint that follows the reference best among those that are safe with each of the laws; or, as an
/// error, the least unsafe one.
fn choose(situation: &Situation<'_>, laws: &[FollowLaw]) -> Result<Tried, Box<Tried>> {
    let reach = Reach::of(situation.vehicle);
    let room = SetpointBounds::room(situation.limits, &situation.origin_m)
        .smaller(reach.side_m + ARDUPILOT_OFF_M, reach.up_m + ARDUPILOT_OFF_M);
    let ways = SHARES.iter().flat_map(|share| {
        let ahead = laws.iter().map(|law| Feeding::ahead(*law, *share, room));
        if *share < 1.0 { ahead.collect() } else { vec![Feeding::whole()] }
    });
    let mut tries = Vec::new();
    for feeding in ways {
        let tried = attempt(situation, laws, feeding);
        if tried.is_safe(situation.tracking_max_m, 0.0) {
            return Ok(tried);
        }
        tries.push(tried);
    }
    tries.sort_by(|a, b| a.beyond_m().total_cmp(&b.beyond_m()));
    let nearly = tries.iter().find(|tried| tried.is_safe(situation.tracking_max_m, WALL_AT_MOST_M)).copied();
    let least = tries.first().copied();
    let none = Tried { tracking_m: f64::NAN, ..Tried::untried(Feeding::whole()) };
    nearly.ok_or_else(|| Box::new(least.unwrap_or(none)))
}

fn attempt(situation: &Situation<'_>, laws: &[FollowLaw], feeding: Feeding) -> Tried {
    let way = situation.way_to_start();
    let course = Leg {
        path: situation.path,
        offset_m: situation.origin_m,
        from_ground: false,
        name: "of the trajectory",
    };
    let mut legs = vec![course];
    if let Some([climb, transfer]) = &way {
        let leg = |path, from_ground, name| Leg { path, offset_m: Vector3::zeros(), from_ground, name };
        legs.push(leg(transfer, false, "of the way to the start"));
        // what takes off by command stays above where it stood
        let stack = situation.parameters.autopilot.stack();
        if stack.is_some_and(|stack| stack.setpoints.takeoff == Takeoff::BySetpoints) {
            legs.push(leg(climb, true, "of the takeoff"));
        }
    }
    let mut tried = Tried::untried(feeding);
    for leg in &legs {
        for law in laws {
            let tracking_m = fly(situation, law, leg, &mut tried);
            // by another law than the most likely it may leave the reference, and then holds; what it does then is in the room
            if laws.first() == Some(law) {
                tried.tracking_m = tried.tracking_m.max(tracking_m);
            }
        }
    }
    tried
}

/// Simulates a leg with the model, and a loss at every instant; returns the greatest distance to the reference, m.
fn fly(situation: &Situation<'_>, law: &FollowLaw, leg: &Leg<'_>, tried: &mut Tried) -> f64 {
    let reference = |time_s: f64| reference_at(leg.path, time_s, &leg.offset_m, Duration::ZERO);
    let mut tracking_m = 0.0_f64;
    let Some(first) = reference(0.0) else { return tracking_m };
    let mut motion = Motion::at(first.position_m, first.velocity_m_s);
    motion.acceleration_m_s2 = first.acceleration_m_s2;
    let off_m = if matches!(law, FollowLaw::Px4 { .. }) { PX4_OFF_M } else { ARDUPILOT_OFF_M };
    let (home_m, reach) = (situation.home(), Reach::of(situation.vehicle));
    let (mut step, mut recent) = (0_usize, VecDeque::with_capacity(RECENT + 1));
    loop {
        let time_s = step as f64 * STEP_S;
        if time_s > leg.path.duration_s() {
            return tracking_m;
        }
        let (Some(now), Some(next)) = (reference(time_s), reference(time_s + STEP_S)) else {
            return tracking_m;
        };
        let target = tried.feeding.target(&now);
        law.step(&mut motion, &target, STEP_S);
        recent.push_back(next.position_m);
        if recent.len() > RECENT {
            recent.pop_front();
        }
        let distances = recent.iter().map(|place_m| (motion.position_m - place_m).norm());
        tracking_m = tracking_m.max(distances.fold(f64::INFINITY, f64::min));
        if step.is_multiple_of(EVERY) {
            law.abandoned(&motion, &target, |place_m| {
                let from_home = place_m - home_m;
                tried.farthest_m = tried.farthest_m.max(from_home.xy().norm());
                tried.highest_m = tried.highest_m.max(from_home.z);
                borders((situation, &reach), leg, place_m, |Border { beyond_m, is_hard, name: border }| {
                    let beyond_m = beyond_m + off_m;
                    let this = Worst { beyond_m, border, time_s, leg: leg.name };
                    if is_hard && tried.hard.is_none_or(|hard| beyond_m > hard.beyond_m) {
                        tried.hard = Some(this);
                    }
                    if tried.worst.is_none_or(|worst| beyond_m > worst.beyond_m) {
                        tried.worst = Some(this);
                    }
                });
            });
        }
        step += 1;
    }
}

/// Distance of a vehicle beyond a border, m, including its rotors if they could touch it; negative inside.
struct Border {
    beyond_m: f64,
    /// it must not be passed
    is_hard: bool,
    name: &'static str,
}

/// Calls `at` with each border, for a vehicle at a position of the local frame.
fn borders(
    (situation, reach): (&Situation<'_>, &Reach),
    leg: &Leg<'_>,
    place_m: &Vector3<f64>,
    mut at: impl FnMut(Border),
) {
    let limits = situation.limits;
    let inside = place_m - situation.origin_m;
    let mut wall = |beyond_m: Option<f64>, wall: Wall| {
        if let Some(beyond_m) = beyond_m {
            at(Border { beyond_m, is_hard: false, name: wall.words() });
        }
    };
    wall(limits.x_max_m.map(|max| inside.x.abs() + reach.side_m - max), Wall::NorthOrSouth);
    wall(limits.y_max_m.map(|max| inside.y.abs() + reach.side_m - max), Wall::WestOrEast);
    wall(limits.z_max_m.map(|max| inside.z + reach.up_m - max), Wall::Ceiling);
    if !leg.from_ground {
        wall(limits.z_min_m.map(|min| min - inside.z), Wall::Floor);
        at(Border { beyond_m: reach.down_m - inside.z, is_hard: true, name: "the ground" });
    }
    if let Some(home_m) = situation.home_m {
        for (spare_m, name) in situation.fence.spares_m(place_m, &home_m) {
            at(Border { beyond_m: -spare_m, is_hard: true, name });
        }
    }
}

/// `0.12 m short of the wall to the north or south at worst, if they end at 3.1 s of the trajectory`.
fn in_words(tried: &Tried) -> String {
    tried.worst_reported().map_or_else(
        || "nothing to hit".to_owned(),
        |worst| {
            let Worst { beyond_m, border, time_s, leg, .. } = worst;
            let side = if beyond_m > 0.0 { "beyond" } else { "short of" };
            let allowed = if beyond_m > 0.0 {
                format!(
                    " (rotors included; 0 is expected, more than {WALL_AT_MOST_M} m beyond a wall is refused)"
                )
            } else {
                String::new()
            };
            format!(
                "{:.2} m {side} {border} at worst{allowed}, if they end at {time_s:.1} s {leg}",
                beyond_m.abs()
            )
        },
    )
}

/// The kind of setpoint in words.
fn manner(feeding: &Feeding) -> String {
    let share = feeding.share();
    if share >= 1.0 {
        "setpoints carry position, velocity and acceleration".to_owned()
    } else if share > 0.0 {
        format!(
            "setpoints carry {:.0} % of velocity and acceleration, and positions ahead for the rest",
            100.0 * share
        )
    } else {
        "setpoints are positions ahead, without velocity and acceleration".to_owned()
    }
}

fn timeout(situation: &Situation<'_>, law: &FollowLaw) -> String {
    let name = timeout_name(situation);
    let seconds = law.timeout_s();
    let assumed = if situation.parameters.get(name).is_some() { "" } else { ", assumed: it did not answer" };
    format!("{name} = {seconds:.1} s{assumed}")
}

/// Name of the parameter with the time-out.
fn timeout_name(situation: &Situation<'_>) -> &'static str {
    situation.parameters.autopilot.stack().map_or("its time-out", |stack| stack.setpoints.timeout)
}

fn said(situation: &Situation<'_>, law: &FollowLaw, tried: &Tried) -> Finding {
    let expected = format!("{EXPECTED} ({})", timeout(situation, law));
    let came = format!(
        "{}; {}, with which the autopilot commands up to {:.2} m off the reference (the vehicle's lag is added)",
        in_words(tried),
        manner(&tried.feeding),
        tried.tracking_m
    );
    if tried.beyond_m() > 0.0 {
        let remedy = remedy(situation, std::slice::from_ref(law), tried);
        return Finding::warning(SUBJECT, expected, came, remedy);
    }
    Finding::ok(SUBJECT, expected, came)
}

fn refused(situation: &Situation<'_>, laws: &[FollowLaw], tried: &Tried) -> Finding {
    let stated = laws.first().map_or_else(String::new, |law| timeout(situation, law));
    let expected = format!("{EXPECTED} ({stated})");
    let costs = format!(
        "the closest safe setpoints deviate by {:.2} m; the limit is {:.2} m",
        tried.tracking_m, situation.tracking_max_m
    );
    let came = if tried.tracking_m > TRACKING_SHARE * situation.tracking_max_m {
        format!("{costs}; with them {}", in_words(tried))
    } else {
        format!("{}, with every kind of setpoint; {costs}", in_words(tried))
    };
    Finding::refusal(SUBJECT, expected, came, remedy(situation, laws, tried))
}

/// What to do: a slower or smaller plan first, then a parameter.
fn remedy(situation: &Situation<'_>, laws: &[FollowLaw], tried: &Tried) -> String {
    let misses = tried.tracking_m > TRACKING_SHARE * situation.tracking_max_m;
    let plan = match tried.worst_reported().filter(|worst| worst.beyond_m > 0.0 && !misses) {
        Some(worst) => format!(
            "plan slower near {}, or {:.1} m further from it",
            worst.border,
            (10.0 * worst.beyond_m).ceil() / 10.0
        ),
        None => {
            "plan a slower trajectory, raise the limits of the autopilot that the checks name, or allow more (--tracking-max)"
                .to_owned()
        }
    };
    match safe_timeout_s(situation, laws) {
        Some(seconds) => format!("{plan}; or set {} to {seconds:.1} or less", timeout_name(situation)),
        None => plan,
    }
}

/// The longest time-out (s, in tenths) with which a kind of setpoint is safe; `None` if no time-out helps.
fn safe_timeout_s(situation: &Situation<'_>, laws: &[FollowLaw]) -> Option<f64> {
    let tried = [2.0, 1.0, 0.5, 0.3, 0.1];
    let longest_s = laws.iter().map(FollowLaw::timeout_s).fold(0.0, f64::max);
    tried.into_iter().filter(|seconds| *seconds < longest_s).find(|seconds| {
        let laws: Vec<FollowLaw> = laws.iter().map(|law| law.with_timeout_s(*seconds)).collect();
        choose(situation, &laws).is_ok_and(|tried| tried.beyond_m() <= 0.0)
    })
}
