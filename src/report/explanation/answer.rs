//! The answer in one sentence.

use super::located::Located;
use super::show::Predicted;
use super::story::Story;
use super::words::{called, clause};
use crate::diagnose::{Along, DetectionLimit, Verdict};
use crate::report::number::{significant, spoken};
use std::fmt::Write;

impl Story {
    /// The answer in one sentence.
    #[must_use]
    pub fn answer(&self) -> String {
        match self.verdict() {
            Verdict::NothingMissing => self.nothing(),
            Verdict::Explained => format!("{}{}.", self.clauses(), self.gain()),
            Verdict::PartlyExplained => format!(
                "{}{}; but something else is there that no known effect accounts for, {}.",
                self.clauses(),
                self.gain(),
                whereabouts(&Located::left(&self.explanation))
            ),
            Verdict::Unexplained => self.unexplained(),
        }
    }

    fn clauses(&self) -> String {
        let vehicle = self.vehicle();
        let all: Vec<String> = self
            .effects
            .iter()
            .enumerate()
            .map(|(index, effect)| {
                let text = clause(effect, vehicle);
                if index == 0 || text.starts_with("Rotor ") { text } else { lowered(&text) }
            })
            .collect();
        let mut text = all.join("; ");
        for effect in &self.effects {
            let names: Vec<&str> = effect.confusable_with.iter().map(|other| called(other.id)).collect();
            if !names.is_empty() {
                let _ = write!(
                    text,
                    " (this flight cannot tell {} from {})",
                    called(effect.id),
                    names.join(" or ")
                );
            }
        }
        text
    }

    /// What the model gains, on what was not used for it.
    fn gain(&self) -> String {
        let (Some(pair), with) = (self.holdout.as_ref(), if self.effects.len() > 1 { "them" } else { "it" })
        else {
            return String::new();
        };
        pair.most().map_or_else(String::new, |(name, percent)| {
            let shown = self.shown_on.words();
            if percent >= 0.5 {
                format!("; with {with} the 0.5 s {name} error on {shown} falls by {percent:.0} %")
            } else {
                format!("; with {with} the 0.5 s errors on {shown} do not fall")
            }
        })
    }

    fn nothing(&self) -> String {
        let seen: Vec<String> = ["linear_drag", "com_offset", "weak_rotor", "ground_effect"]
            .iter()
            .filter_map(|id| self.limit(id))
            .map(|limit| seen_from(&limit))
            .take(3)
            .collect();
        let would = match seen.as_slice() {
            [] => String::new(),
            [one] => format!("; {one} would have been named"),
            [most @ .., last] => format!("; {} or {last} would have been named", most.join(", ")),
        };
        format!(
            "Nothing is missing that this flight could show: the rigid body with its rotors follows it down to the noise{would}."
        )
    }

    fn unexplained(&self) -> String {
        let closest: Vec<&str> = self.closest.iter().map(|effect| called(effect.id)).collect();
        let closest = if closest.is_empty() {
            String::new()
        } else {
            format!("; {} comes closest and does not serve", closest.join(" with "))
        };
        let term = self.empirical.as_ref().map_or_else(String::new, |term| {
            let gain = self.holdout.as_ref().and_then(Predicted::most).map_or_else(
                String::new,
                |(name, percent)| {
                    format!(
                        " and lowers the 0.5 s {name} error on {} by {percent:.0} %",
                        self.shown_on.words()
                    )
                },
            );
            format!(
                "; an empirical force that follows {}, not a mechanism, stands in for it{gain}",
                spoken_along(term.along)
            )
        });
        format!(
            "Something is there that no known effect accounts for, {}{closest}{term}.",
            whereabouts(&self.located)
        )
    }

    /// The largest limit of an effect's parameters.
    fn limit(&self, id: &str) -> Option<DetectionLimit> {
        let limits = self.explanation.limits.iter().filter(|limit| limit.id == id);
        limits.copied().max_by(|a, b| a.limit.total_cmp(&b.limit))
    }
}

/// Where a misfit lives: axis, place or state, band.
fn whereabouts(located: &Located) -> String {
    let mut parts = Vec::new();
    if let Some(field) = &located.field {
        parts.push(format!(
            "{} N along world {} where {} is about {:.1} m in the room, {} m wide",
            significant(field.force_n, 2),
            field.force_along,
            field.changes_along,
            field.at_m,
            significant(field.extent_m, 1)
        ));
    } else if let Some(axis) = located.axes.first() {
        let what =
            axis.axis.replace("force_", "a force along body ").replace("torque_", "a torque about body ");
        parts.push(format!("mainly as {what} ({:.0} % of it)", axis.share_percent));
        if let Some(state) = located.state.first() {
            parts.push(format!("following {} ({:.0} %)", state.variable, state.share_percent));
        }
    }
    if let Some([low, high]) = located.band_hz {
        parts.push(format!("at {} to {} Hz", significant(low, 2), significant(high, 2)));
    }
    if parts.is_empty() { "nowhere in particular".to_owned() } else { parts.join(", ") }
}

fn seen_from(limit: &DetectionLimit) -> String {
    match limit.id {
        "com_offset" => {
            format!("a centre of mass off by {} mm", significant(1e3 * limit.limit, 2))
        }
        "weak_rotor" => format!("a rotor weaker by {} %", significant(100.0 * limit.limit, 2)),
        id => format!("{} of {} {}", called(id), significant(limit.limit, 2), spoken(limit.unit))
            .trim_end()
            .to_owned(),
    }
}

/// What an empirical term depends on.
fn spoken_along(along: Along) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    match along {
        Along::Position(axis) => format!("world {}", AXES[axis.min(2)]),
        Along::Velocity(axis) => format!("the velocity along body {}", AXES[axis.min(2)]),
    }
}

fn lowered(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}
