//! Signature: a steady wind.

use crate::diagnose::named::{Named, NamedParameter};
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Carried, Joint, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words::{from_deg, norm, point_of};
use crate::physics::effects::SteadyWind;
use crate::text::with_error;

use super::linear_drag;

/// Wind below which the air is called calm, m/s: force 0 of the Beaufort scale ends at 0.3 m/s. Velocity estimates err by as
/// much.
pub const CALM_M_S: f64 = 0.3;

/// Wind that does not change.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    // together with a drag, or alone where a drag is known: see the role
    role: Role { wind: Some(carried), of_the_day: true, ..Role::NONE },
    naming: Naming {
        is_ordinary: |term, _| term.values[0].hypot(term.values[1]) < CALM_M_S,
        ..Naming::PLAIN
    },
    joint: Joint {
        // up comes when the rest is known
        forms: Some(|_, _| vec![SIGNATURE.term(&[0.0; 3], &[0, 1])]),
        ..Joint::PLAIN
    },
    picture: Picture::of(&[0, 1], Over::Heading),
    sizes: &[("north", UsualSize::Of(2.5)), ("west", UsualSize::Of(1.5)), ("up", UsualSize::Of(0.0))],
    ..Signature::of(
        &SteadyWind,
        &[0, 1, 2],
        Words {
            clause: Clause::Own(|named, _| clause(named)),
            size: Size::Own(
                |named| {
                    let (speed, std) = speed(named);
                    let point = point_of(named.value("north"), named.value("west"));
                    Some(format!("{} m/s from the {point}", with_error(speed, std)))
                },
                |named| Some(speed(named)),
            ),
            ..Words::of("a steady wind")
        },
    )
};

/// Forms together with drag at the hubs or at the centre. The columns are those of the wind with a drag of one unit.
fn carried() -> Vec<Carried> {
    let of = |at_hubs: f64| Carried {
        carrier: linear_drag::SIGNATURE.term(&[0.0, 0.0, 0.0, at_hubs], &[0, 1]),
        unit: linear_drag::SIGNATURE.term(&[1.0, 1.0, 0.0, at_hubs], &[]),
        term: SIGNATURE.term(&[0.0; 3], &[0, 1]),
    };
    [1.0, 0.0].map(of).to_vec()
}

/// Along the ground, m/s, with its standard error.
fn speed(named: &Named) -> (f64, f64) {
    let parts: Vec<&NamedParameter> = ["north", "west"].iter().filter_map(|name| named.get(name)).collect();
    norm(&parts)
}

fn clause(named: &Named) -> String {
    let (north, east) = (named.value("north"), -named.value("west"));
    let (speed, speed_std) = speed(named);
    let from_deg = from_deg(north, -east);
    let point = point_of(north, -east);
    format!(
        "A steady wind was left out: {} m/s from {point} ({from_deg:.0} deg), {} m/s towards north and {} m/s towards west",
        with_error(speed, speed_std),
        named.said("north", 1.0),
        named.said("west", 1.0)
    )
}
