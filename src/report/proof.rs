//! The table of `prove` for the terminal.

use crate::study::{Proof, ProofSummary, ScoredCase, SizeError};
use crate::text;
use std::fmt::Write;

/// The page for the terminal: one line for each case, its sizes below, then the counts.
#[must_use]
pub fn proof_text(document: &Proof) -> String {
    let mut page = String::new();
    if !document.cases.is_empty() {
        let _ = writeln!(
            page,
            "{:<28} {:<6} {:<17} {:<34} {:>22} {:>6}",
            "case", "right", "verdict", "named (expected)", "hold-out gain %", "s"
        );
    }
    for case in &document.cases {
        add_case(&mut page, case);
    }
    for verdict in &document.unscored {
        let names: Vec<&str> = verdict.effects.iter().map(|effect| effect.id.as_str()).collect();
        let _ =
            writeln!(page, "{:<28} (no answer) {:<17} {}", verdict.case, verdict.verdict, names.join(", "));
    }
    if let Some(summary) = &document.summary {
        let _ = writeln!(page, "\n{}", counts(summary));
    }
    for note in &document.notes {
        let _ = writeln!(page, "note: {note}");
    }
    let _ = writeln!(
        page,
        "verdicts in {}, sealed as {}",
        text::path(&document.verdicts),
        document.sealed_sha256
    );
    page.truncate(page.trim_end().len());
    page
}

fn add_case(page: &mut String, case: &ScoredCase) {
    let _ = writeln!(
        page,
        "{:<28} {:<6} {:<17} {:<34} {:>22} {:>6.2}",
        case.case,
        if case.right { "yes" } else { "NO" },
        case.verdict,
        names(case),
        gain(case),
        case.seconds
    );
    for size in &case.sizes {
        let _ = writeln!(page, "    {}", line(size));
    }
    if let Some(error) = &case.error {
        let _ = writeln!(page, "    {error}");
    }
}

fn counts(summary: &ProofSummary) -> String {
    format!(
        "{} of {} right; {} false names, {} missed; {} of {} sizes within 10 % (worst {}), {} within 2 sigma; {} of {} \
         hold-outs improved; slowest {:.2} s",
        summary.right,
        summary.cases,
        summary.false_names,
        summary.missed,
        summary.sizes_within_10_percent,
        summary.sizes,
        summary.worst_size_error_percent.map_or("none".to_owned(), |worst| format!("{worst:.1} %")),
        summary.sizes_within_2_sigma,
        summary.holdouts_improved,
        summary.holdouts,
        summary.slowest_s
    )
}

fn names(case: &ScoredCase) -> String {
    let shown = |ids: &[String]| if ids.is_empty() { "nothing".to_owned() } else { ids.join(", ") };
    if case.named == case.expected {
        shown(&case.named)
    } else {
        format!("{} ({})", shown(&case.named), shown(&case.expected))
    }
}

fn gain(case: &ScoredCase) -> String {
    match (case.improvement_percent, case.improvement_range) {
        (Some(value), Some((low, high))) => format!("{value:.1} [{low:.1}, {high:.1}]"),
        (Some(value), None) => format!("{value:.1}"),
        (None, _) => "none".to_owned(),
    }
}

fn line(size: &SizeError) -> String {
    format!(
        "{}.{} {:.4} +- {:.4} {} (truth {:.4}: {:+.1} %{})",
        size.effect,
        size.parameter,
        size.value,
        size.std,
        size.unit,
        size.truth,
        size.error_percent,
        size.sigmas.map_or_else(String::new, |sigmas| format!(", {sigmas:+.1} sigma"))
    )
}
