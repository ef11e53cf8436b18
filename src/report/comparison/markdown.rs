//! A summary in Markdown, to paste into a forum or an issue: the page for the terminal, with files by their names alone.

use super::text::comparison_text;
use crate::report::bare::bare;
use crate::study::CompareStudy;

/// The summary.
#[must_use]
pub fn comparison_markdown(study: &CompareStudy) -> String {
    let paths: Vec<&str> = study.flights.iter().map(|flight| flight.input.path.as_str()).collect();
    let text = bare(&comparison_text(study), &paths);
    format!("{}\nProgram: mavid {}, `mavid compare`.\n", fenced(&text), env!("CARGO_PKG_VERSION"))
}

/// Text that keeps its columns and of which nothing is markup.
fn fenced(text: &str) -> String {
    let mut fence = "```".to_owned();
    while text.contains(&fence) {
        fence.push('`');
    }
    format!("{fence}text\n{text}\n{fence}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_shows_no_folder_and_ends_no_fence() {
        let text = bare("changed since /home/me/logs/a.ulg, logs/a.ulg\n/elsewhere/b.tlog", &["logs/a.ulg"]);
        assert_eq!(text, "changed since a.ulg, a.ulg\nb.tlog");
        assert_eq!(fenced("a"), "```text\na\n```\n");
        assert_eq!(fenced("a ``` b"), "````text\na ``` b\n````\n");
    }
}
