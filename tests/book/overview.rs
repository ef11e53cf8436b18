//! The table of all effects, and their place in the book's contents.

use super::blocks::table;
use mavid::diagnose::called;
use mavid::physics::Effect;
use mavid::physics::effects::ALL;

/// One row an effect.
pub fn table_of_effects() -> String {
    let row = |effect: &&dyn Effect| {
        let link = format!("[`{0}`](effects/{0}.md)", effect.id());
        vec![link, effect.sentence().trim_end_matches('.').to_owned(), parameters(*effect)]
    };
    table(&["id", "meaning", "parameters"], &ALL.iter().map(row).collect::<Vec<_>>())
}

/// `dx`, `dy`, `dz` N/(m/s), (`at_hubs`)
fn parameters(effect: &dyn Effect) -> String {
    let mut parts: Vec<String> = Vec::new();
    let common = effect.parameters();
    for (index, parameter) in common.iter().enumerate() {
        let last_of_unit = common.get(index + 1).is_none_or(|next| next.unit != parameter.unit);
        let unit = if last_of_unit && parameter.unit != "-" {
            format!(" {}", parameter.unit)
        } else {
            String::new()
        };
        parts.push(format!("`{}`{unit}", parameter.name));
    }
    for parameter in effect.finer_parameters() {
        let unit = if parameter.unit == "-" { String::new() } else { format!(" {}", parameter.unit) };
        parts.push(format!("(`{}`{unit})", parameter.name));
    }
    parts.join(", ")
}

/// One line an effect, below the chapter of all.
pub fn contents() -> String {
    let line = |effect: &&dyn Effect| format!("  - [{}](effects/{}.md)", title(*effect), effect.id());
    ALL.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What the effect is called, as a heading.
pub fn title(effect: &dyn Effect) -> String {
    let noun = called(effect.id());
    let noun = ["a ", "an ", "the "].iter().find_map(|article| noun.strip_prefix(article)).unwrap_or(noun);
    let mut letters = noun.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
