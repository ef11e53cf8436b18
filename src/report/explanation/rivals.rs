//! An effect that explains nearly the same as a named one, in words.

use crate::diagnose::{Confusable, called};
use crate::study::ExplainStudy;

/// What the flights say of an effect that is like a named one.
pub(super) fn rival(study: &ExplainStudy, other: &Confusable) -> String {
    words(other, study.these_flights())
}

fn words(other: &Confusable, these_flights: &str) -> String {
    let name = called(other.id);
    let apart = other.distinguishability.map_or_else(String::new, |distance| {
        format!(": {distance:.1} standard deviations apart in {these_flights}")
    });
    if other.is_told_apart() {
        format!("explained nearly as much, and is told apart: {name}{apart}")
    } else {
        format!("confusable with {name}{apart}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rival_is_said_to_be_told_apart_where_it_is() {
        let said = |distinguishability| {
            words(&Confusable { id: "transport_delay", distinguishability }, "this flight")
        };
        let name = called("transport_delay");
        assert_eq!(said(None), format!("confusable with {name}"));
        assert_eq!(
            said(Some(4.14)),
            format!("confusable with {name}: 4.1 standard deviations apart in this flight")
        );
        assert!(said(Some(17.0)).starts_with("explained nearly as much, and is told apart: "));
        // a lag and a delay need more than other pairs
        assert!(said(Some(7.0)).starts_with("confusable with"));
    }
}
