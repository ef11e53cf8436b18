//! Names that are taken back: what is told of them, and what a flight is explained without afterwards.

use super::result::ExplainStudy;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{ExplainSettings, Named};

/// Tells what was taken back: not surely enough shown, or not confirmed. One that came back as a part of what stays has its name.
pub(super) fn tell_gone(
    study: &mut ExplainStudy,
    unsure: Vec<(&str, String)>,
    withdrawn: Vec<(&str, String)>,
) {
    let left = |gone: Vec<(&str, String)>, effects: &[Named]| -> Vec<String> {
        let is_gone = |(id, _): &(&str, String)| effects.iter().all(|named| named.id != *id);
        gone.into_iter().filter(is_gone).map(|(_, name)| name).collect()
    };
    study.withdrawn = left(withdrawn, &study.effects);
    if let Some(short) = &mut study.short {
        short.unsure = left(unsure, &study.effects);
    }
}

/// The effects that a flight is explained without after one (`id`) was taken back: what would take its place has no more to stand on. Of one
/// that the flight does not show (`is_unshown`), a part of it goes too, as drag along z of a drag.
pub(super) fn gone_with(
    (id, is_unshown): (&str, bool),
    study: &ExplainStudy,
    settings: &ExplainSettings,
) -> Vec<&'static str> {
    let terms = &study.explanation.search.after.base.effects;
    let is_part = |of: &str| {
        let whole = signature_of(of).and_then(|of| of.role.axial_part_of);
        is_unshown && whole.is_some_and(|whole| whole.id() == id)
    };
    let stays = |of: &str| of != id && !is_part(of) && terms.iter().any(|term| term.id() == of);
    let ids = settings.signatures.iter().map(|signature| signature.id());
    ids.filter(|id| !stays(id)).collect()
}
