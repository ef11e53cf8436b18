//! A report's page: one file of HTML, nothing loaded from anywhere, light and dark, printable.
//!
//! Its plots are drawings. The script of the page makes them into plots to zoom and to read values from; without it, and on
//! paper, the drawings stay.

use super::html::{BREAK, whole};
use crate::text::{clean_lines, unbroken};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = concat!(include_str!("assets/uplot.min.css"), "\n", include_str!("assets/report.css"));
/// The plotting library with its licence, and the page's own script.
const SCRIPT: &str = concat!(
    include_str!("assets/language.js"),
    "/*\n",
    include_str!("assets/uplot.LICENSE"),
    "\n*/\n",
    include_str!("assets/uplot.min.js"),
    "\n",
    include_str!("assets/report.js")
);

/// The whole file: title, answer, tags and sections. The script comes along where there is a plot.
pub(super) fn page(title: &str, answer: &str, tags: &[String], sections: &Markup) -> String {
    let has_plots =
        sections.0.contains("<div class=\"plot\">") || sections.0.contains("<div class=\"path3\">");
    let page = html! {
        (DOCTYPE) (BREAK)
        html lang="en" { (BREAK)
            head { (BREAK)
                meta charset="utf-8"; (BREAK)
                meta name="viewport" content="width=device-width, initial-scale=1"; (BREAK)
                title { (title) } (BREAK)
                style { (PreEscaped(STYLE)) } (BREAK)
            }
            (BREAK)
            body { main { (BREAK)
                h1 { (title) } (BREAK)
                p.answer { (whole(answer)) } (BREAK)
                p.tags { @for tag in tags { span { (unbroken(tag)) } " " } } (BREAK)
                (sections)
            }
            @if has_plots { script { (PreEscaped(SCRIPT)) } }
            }
            (BREAK)
        }
        (BREAK)
    };
    clean_lines(&page.into_string()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_is_whole_and_ends_no_element() {
        assert!(!SCRIPT.contains("</script") && !STYLE.contains("</style"));
        assert!(SCRIPT.contains("Permission is hereby granted, free of charge"));
        // nothing of it is changed on the way
        assert_eq!(clean_lines(SCRIPT), SCRIPT);
        assert_eq!(clean_lines(STYLE), STYLE);
    }
}
