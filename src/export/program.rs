//! A program in Python beside a file: it does in the simulator what the file cannot hold.

use crate::text;
use std::path::Path;

/// Ends the names of such programs, without the ending of the file.
const MARK: &str = "_effects";

/// A program in Python that makes, in a simulator, the effects that the exported file cannot hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EffectsProgram {
    /// first line of its documentation
    pub(super) title: String,
    /// all that comes after its documentation
    pub(super) body: String,
}

impl EffectsProgram {
    /// Name of the program's file beside the model's file: `model.xml` has `model_effects.py`. Python can import it: a character that no
    /// module's name may have becomes an underscore.
    #[must_use]
    pub fn file_name(model: &Path) -> String {
        format!("{}.py", module(model))
    }

    /// The text of the program for the model in this file.
    #[must_use]
    pub fn text(&self, model: &Path) -> String {
        let (title, body, module, loads) = (&self.title, &self.body, module(model), loads(model));
        format!(
            "\"\"\"{title}\n\n    import mujoco\n    import {module}\n\n    model = {loads}\n    \
             {module}.install(model)\n\nSI, axes of the body: forward, left, up.\n\"\"\"\n\n{body}"
        )
    }

    /// Whether a text is such a program for the model in this file, of whatever version of the model.
    #[must_use]
    pub fn is_of(text: &str, model: &Path) -> bool {
        text.contains(&loads(model))
    }
}

/// Name of the module for the model in this file.
fn module(model: &Path) -> String {
    let stem = text::path(model.file_stem().unwrap_or_default());
    let allowed = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let name: String = stem.chars().map(allowed).collect();
    let first = if name.starts_with(|letter: char| letter.is_ascii_digit()) { "_" } else { "" };
    format!("{first}{name}{MARK}")
}

/// How a program in Python loads the model in this file.
fn loads(model: &Path) -> String {
    // no quote ends the text of the module
    let name = text::path(model.file_name().unwrap_or_default()).replace(['"', '\\'], "'");
    format!("mujoco.MjModel.from_xml_path(\"{name}\")")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_names_the_file_of_its_model_and_can_be_imported() {
        let program = EffectsProgram { title: "one".to_owned(), body: "import mujoco\n".to_owned() };
        for (file, name) in [
            ("folder/model.xml", "model_effects.py"),
            ("x500-v2.xml", "x500_v2_effects.py"),
            ("2.xml", "_2_effects.py"),
            ("a.b.xml", "a_b_effects.py"),
        ] {
            let file = Path::new(file);
            assert_eq!(EffectsProgram::file_name(file), name);
            let text = program.text(file);
            assert!(text.contains(&format!("import {}\n", name.trim_end_matches(".py"))), "{text}");
            assert!(EffectsProgram::is_of(&text, file));
        }
        let text = program.text(Path::new("x500-v2.xml"));
        assert!(text.contains("from_xml_path(\"x500-v2.xml\")"), "{text}");
        assert!(!EffectsProgram::is_of(&text, Path::new("x500_v2.xml")));
    }
}
