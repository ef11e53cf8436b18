//! The documents: every relative link has a target, the README is short, and the book lists all of its chapters.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

/// Lines that the README may have.
const README_LINES: usize = 150;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files with this extension below a folder, sorted.
fn files_below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_below(&path, extension));
        } else if path.extension().is_some_and(|own| own == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The documents whose links are checked.
fn documents() -> Vec<PathBuf> {
    let single = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "fixtures/README.md", "fuzz/README.md"];
    let mut documents: Vec<PathBuf> =
        single.iter().map(|name| root().join(name)).filter(|path| path.exists()).collect();
    documents.extend(files_below(&root().join("docs"), "md"));
    documents
}

/// The lines outside of code fences, with their numbers from 1.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let mut fence: Option<&str> = None;
    let mut lines = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let start = line.trim_start();
        let mark = ["```", "~~~"].into_iter().find(|mark| start.starts_with(mark));
        match (fence, mark) {
            (None, Some(mark)) => fence = Some(mark),
            (Some(open), Some(mark)) if open == mark => fence = None,
            (None, None) => lines.push((index + 1, line)),
            _ => {}
        }
    }
    lines
}

/// A line without its inline code.
fn without_code(line: &str) -> String {
    let mut parts: Vec<&str> = line.split('`').collect();
    // an unpaired mark begins no code
    let unpaired = if parts.len().is_multiple_of(2) { parts.pop() } else { None };
    let mut text: String = parts.iter().step_by(2).copied().collect();
    text.extend(unpaired);
    text
}

/// The targets of links and images in one line: `[text](target)`, `[name]: target`, `src="target"`, `href="target"`.
fn targets(line: &str) -> Vec<String> {
    let line = without_code(line);
    let mut found = Vec::new();
    for (opening, closing) in [("](", ')'), ("src=\"", '"'), ("href=\"", '"')] {
        for rest in line.split(opening).skip(1) {
            let target = rest.split(closing).next().unwrap_or_default();
            // a title may stand behind the target
            found.extend(target.split_whitespace().next().map(str::to_owned));
        }
    }
    if line.starts_with('[')
        && let Some((_, target)) = line.split_once("]: ")
    {
        found.extend(target.split_whitespace().next().map(str::to_owned));
    }
    found
}

/// The text of a heading without its markup: links become their text.
fn heading_text(heading: &str) -> String {
    let mut text = String::new();
    let mut rest = heading;
    while let Some((before, link)) = rest.split_once("](") {
        text.push_str(before);
        rest = link.split_once(')').map_or("", |(_, after)| after);
    }
    text.push_str(rest);
    text
}

/// The anchors of a document's headings, as GitHub and mdBook make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut anchors = BTreeSet::new();
    for (_, line) in prose(text) {
        let heading = line.trim_start_matches('#');
        let depth = line.len() - heading.len();
        if depth == 0 || depth > 6 || !heading.starts_with(' ') {
            continue;
        }
        let mut slug = String::new();
        for letter in heading_text(heading.trim()).to_lowercase().chars() {
            if letter.is_alphanumeric() || letter == '-' || letter == '_' {
                slug.push(letter);
            } else if letter == ' ' {
                slug.push('-');
            }
        }
        let count = seen.entry(slug.clone()).or_insert(0);
        anchors.insert(if *count == 0 { slug } else { format!("{slug}-{count}") });
        *count += 1;
    }
    anchors
}

fn is_elsewhere(target: &str) -> bool {
    ["http://", "https://", "mailto:"].iter().any(|scheme| target.starts_with(scheme))
}

/// A path without `.` and `..`.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                normal.pop();
            }
            other => normal.push(other),
        }
    }
    normal
}

/// What is wrong with a link of a document; `None` where it has a target.
fn fault(document: &Path, target: &str) -> Option<String> {
    let (file, anchor) = target.split_once('#').map_or((target, None), |(file, anchor)| (file, Some(anchor)));
    let path = match file {
        "" => document.to_owned(),
        file if file.starts_with('/') => return Some("is absolute".to_owned()),
        file => normal(&document.parent().unwrap().join(file)),
    };
    if !path.starts_with(root()) {
        return Some("leads out of the repository".to_owned());
    }
    if !path.exists() {
        return Some("has no file".to_owned());
    }
    let anchor = anchor?;
    if path.extension().is_none_or(|extension| extension != "md") {
        return Some("has an anchor, but is no Markdown".to_owned());
    }
    (!anchors(&read(&path)).contains(anchor)).then(|| "has no such heading".to_owned())
}

#[test]
fn every_relative_link_has_a_target() {
    let documents = documents();
    let mut count = 0;
    let mut faults = Vec::new();
    for document in &documents {
        let text = read(document);
        for (number, line) in prose(&text) {
            for target in targets(line).into_iter().filter(|target| !is_elsewhere(target)) {
                count += 1;
                if let Some(fault) = fault(document, &target) {
                    faults.push(format!("{}:{number}: `{target}` {fault}", document.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    // the README and the book's contents alone have as many
    assert!(documents.len() >= 10 && count >= 30, "{} documents, {count} links", documents.len());
}

#[test]
fn the_readme_is_short_and_states_the_command_of_the_tests() {
    let readme = read(&root().join("README.md"));
    let lines = readme.lines().count();
    assert!(lines <= README_LINES, "README.md: expected at most {README_LINES} lines, got {lines}");
    // .ci/run reads the command from between these
    let marked =
        readme.split("<!-- test -->\n").nth(1).unwrap().split("<!-- end of test -->").next().unwrap();
    let command: Vec<&str> = marked.lines().filter(|line| !line.starts_with("```")).collect();
    assert_eq!(command, ["cargo test --release"]);
}

#[test]
fn the_book_lists_all_of_its_chapters() {
    let source = root().join("docs/src");
    let summary = read(&source.join("SUMMARY.md"));
    let listed: Vec<PathBuf> = prose(&summary)
        .into_iter()
        .flat_map(|(_, line)| targets(line))
        .map(|target| normal(&source.join(target)))
        .collect();
    for chapter in files_below(&source, "md").iter().filter(|path| !path.ends_with("SUMMARY.md")) {
        let times = listed.iter().filter(|path| *path == chapter).count();
        assert_eq!(times, 1, "{}: expected once in SUMMARY.md", chapter.display());
    }
}

#[test]
fn links_are_found_and_faults_are_seen() {
    let line = "[a](b.md), ![c](d/e.svg \"title\"), `[no](code.md)`, <img src=\"f.png\"> and [g](#h)";
    assert_eq!(targets(line), ["b.md", "d/e.svg", "#h", "f.png"]);
    assert_eq!(targets("[name]: other.md"), ["other.md"]);
    let text =
        "# A `b` c\n```text\n# no heading\n[no](link.md)\n```\n## It's (2 of) A\n## Twice\n## Twice\n#no\n";
    let expected = ["a-b-c", "its-2-of-a", "twice", "twice-1"].map(str::to_owned);
    assert_eq!(anchors(text), BTreeSet::from(expected));
    assert_eq!(prose(text).len(), 5);
    let readme = root().join("README.md");
    for (target, wrong) in [
        ("Cargo.toml", None),
        ("docs/../Cargo.toml", None),
        ("#mavid", None),
        ("#no-such-heading", Some("has no such heading")),
        ("no-such-file.md", Some("has no file")),
        ("/etc/hosts", Some("is absolute")),
        ("../elsewhere.md", Some("leads out of the repository")),
        ("Cargo.toml#a", Some("has an anchor, but is no Markdown")),
    ] {
        assert_eq!(fault(&readme, target).as_deref(), wrong, "{target}");
    }
}

/// The limits that the guide states and flew are those of the file that it gives.
#[test]
fn the_parameter_file_of_the_guide_holds_what_the_guide_says() {
    let file = mavid::onboard::read_parameter_file(&root().join("fixtures/ardupilot-guided.parm")).unwrap();
    let guide = read(&root().join("docs/src/flying.md"));
    let stated: Vec<(String, f64)> = guide
        .split("--param ")
        .skip(1)
        .filter_map(|rest| rest.split_whitespace().next()?.split_once('='))
        .map(|(name, value)| (name.to_owned(), value.trim_end_matches('`').parse().unwrap()))
        .collect();
    // first in the names of 4.7, then in those of earlier releases and their units: a vehicle takes those that it has
    let (new, old) = file.split_at(stated.len());
    assert_eq!(new, stated);
    assert_eq!(old.len(), stated.len());
    let values = old.iter().cloned().collect();
    let old = mavid::fly::parameters::Parameters {
        autopilot: mavid::autopilot::Autopilot::ArduPilot,
        values,
        ..mavid::fly::parameters::Parameters::default()
    };
    let new = mavid::fly::parameters::Parameters { values: stated.into_iter().collect(), ..old.clone() };
    for name in old.values.keys() {
        assert_eq!(old.get(name), new.get(name), "{name}");
    }
}
