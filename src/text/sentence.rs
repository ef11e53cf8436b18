//! Words that become a sentence.

/// A clause with a capital at its beginning.
#[must_use]
pub fn capital(clause: &str) -> String {
    let mut letters = clause.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_begins_with_a_capital() {
        assert_eq!(capital("rotor 3 gives 0.93"), "Rotor 3 gives 0.93");
        assert_eq!((capital(""), capital("2 flights")), (String::new(), "2 flights".to_owned()));
    }
}
