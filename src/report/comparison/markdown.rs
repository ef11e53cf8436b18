//! A summary in Markdown, to paste into a forum or an issue: the page for the terminal, with files by their names alone.

use super::text::comparison_text;
use crate::study::CompareStudy;

/// The summary.
#[must_use]
pub fn comparison_markdown(study: &CompareStudy) -> String {
    let paths = study.flights.iter().map(|flight| flight.input.path.as_str());
    let text = without_folders(&comparison_text(study), paths);
    format!("{}\nProgram: mavid {}, `mavid compare`.\n", fenced(&text), env!("CARGO_PKG_VERSION"))
}

/// The text with each of these paths as the name of its file.
fn without_folders<'a>(text: &str, paths: impl Iterator<Item = &'a str>) -> String {
    let mut paths: Vec<&str> = paths.collect();
    // one may end as another does
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    paths.into_iter().fold(text.to_owned(), |text, path| {
        let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
        text.replace(path, name)
    })
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
        let paths = ["logs/a.ulg", "/home/me/logs/a.ulg", "b.tlog"];
        let text =
            without_folders("changed since /home/me/logs/a.ulg, logs/a.ulg and b.tlog", paths.into_iter());
        assert_eq!(text, "changed since a.ulg, a.ulg and b.tlog");
        assert_eq!(fenced("a"), "```text\na\n```\n");
        assert_eq!(fenced("a ``` b"), "````text\na ``` b\n````\n");
    }
}
