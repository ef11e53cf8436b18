//! The layers of `src/`: who may import whom, who may open a socket, who may print, how long a file may be.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

mod graph;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use graph::Graph;
use proc_macro2::{TokenStream, TokenTree};

/// Each stage, from the bottom, and all that it uses: no less, and no more.
const LAYERS: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("files", &[]),
    // what others wrote, made harmless where it enters
    ("text", &[]),
    // of any series: nothing of flights, and no import
    ("stats", &[]),
    // rows of tables, whatever they hold
    ("table", &["text"]),
    // files in object stores, by their addresses
    ("store", &["text"]),
    // autopilots as tables
    ("autopilot", &[]),
    // what a stage has to say beside its result
    ("note", &[]),
    ("frames", &[]),
    ("vehicle", &[]),
    ("trajectory", &["frames"]),
    ("fence", &["frames"]),
    ("physics", &["units", "text", "vehicle"]),
    // a flight as typed streams, from wherever
    ("recording", &["autopilot"]),
    // MAVLink's bytes, frames and messages
    ("wire", &["units", "text", "autopilot", "frames", "recording"]),
    // files
    ("log", &["units", "text", "autopilot", "frames", "recording", "wire"]),
    // a log to share, byte for byte but for what tells where and of whom
    ("redact", &["text", "autopilot", "wire"]),
    // frames over sockets and serial ports, and their recording: live links need no files
    ("link", &["note", "text", "wire"]),
    // logs of a vehicle, over MAVLink: dialogues without I/O, and the file that they fill
    ("fetch", &["files", "text", "autopilot", "wire"]),
    // a log played as if it were a link
    ("replay", &["text", "wire", "log", "link"]),
    // vehicle: from actuator values to force
    ("signals", &["note", "stats", "autopilot", "vehicle", "recording"]),
    // the balance of a vehicle, over seconds
    ("trim", &["stats", "vehicle", "signals"]),
    // one vehicle over its flights
    ("change", &["vehicle", "trim"]),
    // flight path and parameters of the motion at once
    ("reconstruction", &["vehicle", "physics", "recording", "signals"]),
    // what a thrust stand measured of a rotor
    ("stand", &["units", "text", "vehicle"]),
    // a first description of a vehicle, from parameters, weight and a flight
    ("draft", &["text", "units", "autopilot", "vehicle", "recording", "signals"]),
    ("regression", &["signals"]),
    ("estimate", &["note", "vehicle", "physics", "signals", "regression"]),
    // never estimate
    ("simulate", &["units", "vehicle", "trajectory", "physics", "recording"]),
    ("config", &["note", "units", "text", "vehicle", "trajectory", "physics", "recording", "log"]),
    ("compare", &["vehicle", "physics", "recording", "signals", "simulate"]),
    // estimate: what a flight will determine is for its estimator to say
    (
        "plan",
        &[
            "note",
            "units",
            "vehicle",
            "trajectory",
            "recording",
            "signals",
            "regression",
            "estimate",
            "simulate",
        ],
    ),
    // plan: the flight that tells two explanations apart keeps the vehicle's limits
    (
        "diagnose",
        &[
            "note",
            "text",
            "stats",
            "vehicle",
            "trajectory",
            "physics",
            "recording",
            "signals",
            "trim",
            "change",
            "reconstruction",
            "regression",
            "estimate",
            "simulate",
            "compare",
            "plan",
        ],
    ),
    (
        "inspect",
        &[
            "units",
            "note",
            "stats",
            "autopilot",
            "vehicle",
            "recording",
            "wire",
            "log",
            "signals",
            "regression",
            "estimate",
            "draft",
            "diagnose",
        ],
    ),
    // a whole piece of work: opens files, calls the stages, collects what they say. `inspect` tells it of logs without a flight
    (
        "study",
        &[
            "note",
            "stats",
            "inspect",
            "autopilot",
            "units",
            "text",
            "vehicle",
            "trajectory",
            "physics",
            "recording",
            "wire",
            "log",
            "signals",
            "stand",
            "draft",
            "regression",
            "estimate",
            "simulate",
            "config",
            "compare",
            "plan",
            "diagnose",
            "trim",
            "change",
        ],
    ),
    // many logs as tables, and the tables as histories
    (
        "fleet",
        &[
            "files",
            "text",
            "stats",
            "table",
            "store",
            "note",
            "autopilot",
            "log",
            "inspect",
            "vehicle",
            "draft",
            "config",
            "diagnose",
            "trim",
            "change",
            "study",
        ],
    ),
    // one log within bounds: no files, no threads
    ("screen", &["text", "autopilot", "vehicle", "recording", "log", "signals", "trim", "draft", "diagnose"]),
    // streams for programs that plot
    ("convert", &["text", "table", "recording", "diagnose", "study", "fleet"]),
    // config: a model file is a vehicle file. Of the stages it names what a study holds, and fits nothing
    (
        "report",
        &[
            "note", "text", "vehicle", "physics", "signals", "estimate", "inspect", "config", "compare",
            "plan", "diagnose", "change", "study", "fleet",
        ],
    ),
    ("export", &["units", "text", "autopilot", "vehicle", "physics", "diagnose"]),
    ("sitl", &["units", "autopilot", "frames", "vehicle", "fence", "physics", "wire", "link", "simulate"]),
    (
        "fly",
        &[
            "units",
            "files",
            "text",
            "autopilot",
            "frames",
            "vehicle",
            "trajectory",
            "fence",
            "physics",
            "recording",
            "wire",
            "link",
            "signals",
            "regression",
            "estimate",
            "simulate",
            "plan",
        ],
    ),
    // the logs and parameters of a vehicle on the ground: the dialogues of `fetch`, held over a link
    ("onboard", &["note", "text", "autopilot", "wire", "fetch", "link", "fly"]),
];

/// The binary's own modules: they may use anything, and nothing of the library may use them.
const BINARY: &[&str] = &["main", "cli", "commands"];

/// Who may open a socket or name the runtime.
const NETWORK: &[&str] = &["store", "link", "replay", "fly", "onboard", "sitl", "main", "cli", "commands"];

/// Who may print.
const PRINT: &[&str] = &["main", "commands"];

/// Lines of a file.
const LINES_MAX: usize = 400;

/// A file of `src/`.
struct Source {
    /// from `src`, with `/`
    path: String,
    /// stage, or module of the binary
    module: String,
    /// nesting: 1 for `src/log/mod.rs`, 2 for `src/log/recording.rs`
    depth: usize,
    text: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut folders = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(source(&root, &path));
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(found.len() > 10, "no sources under {}", root.display());
    found
}

fn source(root: &Path, path: &Path) -> Source {
    let relative: PathBuf = path.strip_prefix(root).unwrap().to_owned();
    let mut parts: Vec<String> =
        relative.iter().map(|part| part.to_str().unwrap().trim_end_matches(".rs").to_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    Source {
        path: relative.iter().map(|part| part.to_str().unwrap()).collect::<Vec<_>>().join("/"),
        module: parts[0].clone(),
        depth: parts.len(),
        text: std::fs::read_to_string(path).unwrap(),
    }
}

/// The code without comments (a `//` in a string cuts its line, which hides nothing that matters here).
fn code(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

impl Source {
    /// Holds nothing but tests.
    fn is_test(&self) -> bool {
        self.path.ends_with("tests.rs") || self.path.contains("/tests/")
    }

    /// The text before the test module at the end; nothing of a file of tests.
    fn without_tests(&self) -> &str {
        if self.is_test() {
            return "";
        }
        let ends = ["#[cfg(test)]\nmod ", "#[cfg(test)]\npub(super) mod "].map(|head| self.text.find(head));
        ends.into_iter().flatten().min().map_or(&self.text, |end| &self.text[..end])
    }
}

/// First names of the paths that a `use` tree or path begins with: `a::b` or `{a::b, c}`.
fn heads(tree: &str) -> Vec<String> {
    let Some(group) = tree.strip_prefix('{') else {
        let name: String =
            tree.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect();
        return vec![name];
    };
    let mut names = Vec::new();
    let (mut level, mut start) = (0_usize, 0_usize);
    for (at, letter) in group.char_indices() {
        match letter {
            '{' => level += 1,
            ',' | '}' if level == 0 => {
                names.extend(heads(group[start..at].trim()));
                start = at + 1;
                if letter == '}' {
                    break;
                }
            }
            '}' => level -= 1,
            _ => {}
        }
    }
    names
}

/// Top-level modules that the code names, by `crate::` or by `super::` up to the root.
fn imports(text: &str, depth: usize) -> BTreeSet<String> {
    let code = code(text);
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        found.extend(heads(code[at + "crate::".len()..].trim_start()));
    }
    let up = "super::".repeat(depth);
    for (at, _) in code.match_indices(&up) {
        found.extend(heads(code[at + up.len()..].trim_start()));
    }
    found
}

/// Each stage with what it uses directly, itself among it.
fn allowed() -> BTreeMap<&'static str, BTreeSet<&'static str>> {
    let mut all: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (stage, below) in LAYERS {
        for name in *below {
            // in order from the bottom: there can be no circle
            assert!(all.contains_key(name), "{stage} is listed above {name}");
        }
        all.insert(stage, below.iter().copied().chain([*stage]).collect());
    }
    all
}

/// All stages that a stage reaches, itself among them.
fn reached(stage: &str) -> BTreeSet<&'static str> {
    let allowed = allowed();
    let mut reached: BTreeSet<&str> = BTreeSet::new();
    let mut open: Vec<&str> = allowed[stage].iter().copied().collect();
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            open.extend(&allowed[name]);
        }
    }
    reached
}

#[test]
fn imports_point_one_way() {
    let allowed = allowed();
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.module != "lib") {
        if BINARY.contains(&source.module.as_str()) {
            continue;
        }
        let Some(may) = allowed.get(source.module.as_str()) else {
            wrong.push(format!("{}: `{}` is not among the layers", source.path, source.module));
            continue;
        };
        for name in imports(source.without_tests(), source.depth) {
            let is_module = allowed.contains_key(name.as_str()) || BINARY.contains(&name.as_str());
            if is_module && !may.contains(name.as_str()) {
                wrong.push(format!("{}: {} may not use {name}", source.path, source.module));
            }
        }
    }
    assert!(wrong.is_empty(), "imports against the layers:\n{}", wrong.join("\n"));
}

/// What a stage may use is what some file of it uses.
#[test]
fn the_layers_are_no_looser_than_what_is_used() {
    let sources = sources();
    let mut unused = Vec::new();
    for (stage, below) in LAYERS {
        let of_stage = sources.iter().filter(|source| source.module == *stage);
        let used: BTreeSet<String> =
            of_stage.flat_map(|source| imports(source.without_tests(), source.depth)).collect();
        unused.extend(
            below.iter().filter(|name| !used.contains(**name)).map(|name| format!("{stage}: {name}")),
        );
    }
    assert!(unused.is_empty(), "allowed and not used:\n{}", unused.join("\n"));
}

#[test]
fn no_two_files_import_each_other() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for root in ["lib.rs", "main.rs"] {
        let graph = Graph::of(&src, root);
        let circles = graph.circles();
        println!("{root}: {} files, {} circles", graph.files.len(), circles.len());
        let text: Vec<String> =
            circles.iter().map(|circle| format!("{} files: {}", circle.len(), circle.join(" "))).collect();
        assert!(circles.is_empty(), "circles of imports:\n{}", text.join("\n"));
    }
}

/// `mod.rs` is a table of contents.
#[test]
fn mod_files_declare_and_export() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.path.ends_with("/mod.rs")) {
        let file = syn::parse_file(&source.text).unwrap();
        let holds = |item: &syn::Item| match item {
            syn::Item::Mod(inner) => inner.content.is_some(),
            other => !matches!(other, syn::Item::Use(_)),
        };
        if file.items.iter().any(holds) {
            wrong.push(source.path.clone());
        }
    }
    assert!(wrong.is_empty(), "items in mod.rs, which belong into files of their own:\n{}", wrong.join("\n"));
}

/// An effect is known by its equation, its signature and the exporters: nothing else asks for one by its identifier.
#[test]
fn effects_are_asked_for_by_role_and_not_by_name() {
    const MOST: usize = 20;
    let own = ["physics/effects/", "diagnose/signatures/", "export/"];
    let mut all = Vec::new();
    for source in sources().iter().filter(|source| !own.iter().any(|path| source.path.starts_with(path))) {
        let mut found = Vec::new();
        mentions(source.without_tests().parse().unwrap(), &mut found);
        all.extend(found.iter().map(|mention| format!("{}: {mention}", source.path)));
    }
    println!("mentions of effects outside of their own files: {}\n{}", all.len(), all.join("\n"));
    assert!(all.len() <= MOST, "at most {MOST} are allowed:\n{}", all.join("\n"));
}

/// Each place of the code that names an effect: its type, its identifier as an identifier of the code (also in capitals), or as
/// text, alone, before a `.`, or as a word of two parts in a sentence. Documentation is none of them.
fn mentions(tokens: TokenStream, found: &mut Vec<String>) {
    let is_id = |word: &str| mavid::physics::effects::by_id(word).is_some();
    let is_type =
        |name: &str| mavid::physics::effects::ALL.iter().any(|effect| format!("{effect:?}") == name);
    let mut after_hash = false;
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                let name = name.to_string();
                // one word is a word of the language: a gust, a tether
                let is_module = name.contains('_') && is_id(&name.to_lowercase());
                found.extend((is_module || is_type(&name)).then_some(name));
            }
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                let Some(text) = text.strip_prefix('"').and_then(|text| text.strip_suffix('"')) else {
                    continue;
                };
                let words = text.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '_'));
                let of_two = words.filter(|word| word.contains('_') && is_id(word)).map(str::to_owned);
                let of_two: Vec<String> = of_two.collect();
                let head = text.split('.').next().unwrap_or_default();
                found.extend((of_two.is_empty() && is_id(head)).then(|| head.to_owned()));
                found.extend(of_two);
            }
            // documentation is an attribute
            TokenTree::Group(group) if !(after_hash && group.stream().to_string().starts_with("doc")) => {
                mentions(group.stream(), found);
            }
            TokenTree::Group(_) => {}
            TokenTree::Punct(mark) => {
                after_hash = mark.as_char() == '#' || after_hash && mark.as_char() == '!';
                continue;
            }
        }
        after_hash = false;
    }
}

#[test]
fn mentions_of_effects_are_seen_however_they_are_written() {
    let text = "/// linear_drag\nfn f() { g(\"linear_drag.dx\", &LinearDrag, LINEAR_DRAG, \"with motor_lag, or so\"); \
                h(\"tether\", tether, \"a tether\", \"gust.sigma\"); }";
    let mut found = Vec::new();
    mentions(text.parse().unwrap(), &mut found);
    assert_eq!(found, ["linear_drag", "LinearDrag", "LINEAR_DRAG", "motor_lag", "tether", "gust"]);
}

#[test]
fn simulation_never_sees_an_estimate() {
    assert!(!reached("simulate").contains("estimate"));
}

#[test]
fn imports_are_seen_however_they_are_written() {
    let text = "use crate::{frames::{Body, World}, units};\n// crate::report\nfn f() { crate::log::g(); }\n\
                #[cfg(test)]\nmod tests { use super::super::estimate; }";
    let names: Vec<String> = imports(text, 2).into_iter().collect();
    assert_eq!(names, ["estimate", "frames", "log", "units"]);
}

/// What is shown was found before: the report names nothing that fits, searches or computes a statistic.
#[test]
fn the_report_computes_nothing() {
    const STAGES: [&str; 8] =
        ["search", "fit", "Rows", "Trace", "paper_models", "Recording", "statrs", "rayon"];
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.module == "report") {
        let tokens: TokenStream = source.without_tests().parse().unwrap();
        let named = identifiers(tokens);
        wrong.extend(
            STAGES
                .iter()
                .filter(|stage| named.contains(**stage))
                .map(|stage| format!("{}: {stage}", source.path)),
        );
    }
    assert!(wrong.is_empty(), "the report is a view of a study, which holds this:\n{}", wrong.join("\n"));
}

/// Every identifier of the code, also inside of macros.
fn identifiers(tokens: TokenStream) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                found.insert(name.to_string());
            }
            TokenTree::Group(group) => found.extend(identifiers(group.stream())),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
    found
}

#[test]
fn only_the_edges_open_sockets() {
    let mut wrong = Vec::new();
    for source in sources() {
        let code = code(&source.text);
        for needle in ["tokio", "std::net"] {
            if code.contains(needle) && !NETWORK.contains(&source.module.as_str()) {
                wrong.push(format!("{}: {needle}", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "only {} may:\n{}", NETWORK.join(", "), wrong.join("\n"));
}

#[test]
fn only_the_commands_print() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| !PRINT.contains(&source.module.as_str())) {
        let code = code(source.without_tests());
        for needle in ["print!(", "println!(", "stdout()", "stderr()"] {
            if code.contains(needle) {
                wrong.push(format!("{}: {needle}", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "only {} may print:\n{}", PRINT.join(", "), wrong.join("\n"));
}

/// A subscriber may stand still, as whoever reads what it writes: nothing between a setpoint's time and the wire says
/// anything to it. What is to be said of setpoints and of the link is said by the flight, which hears of it.
#[test]
fn nothing_that_carries_setpoints_waits_for_a_subscriber() {
    let carries = [
        "fly/runner/stream.rs",
        "fly/runner/priority.rs",
        "fly/safety/",
        "fly/law.rs",
        "fly/course.rs",
        "fly/setpoint.rs",
        "fly/target/",
        "link/incoming.rs",
        "link/outgoing.rs",
        "link/pen.rs",
        "link/recorder/",
        "link/shared.rs",
        "link/signing/",
        "link/transport/",
        "link/writer.rs",
        "wire/frame.rs",
        "wire/splitter.rs",
    ];
    let (all, mut wrong) = (sources(), Vec::new());
    for path in carries {
        let mut found = all.iter().filter(|source| source.path.starts_with(path)).peekable();
        assert!(found.peek().is_some(), "no file is {path}: where did it go?");
        wrong.extend(
            found
                .filter(|source| code(source.without_tests()).contains("tracing"))
                .map(|source| source.path.clone()),
        );
    }
    assert!(wrong.is_empty(), "they say something:\n{}", wrong.join("\n"));
}

/// The library says what it does; who hears it is the program's choice.
#[test]
fn only_the_program_installs_a_subscriber() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| !BINARY.contains(&source.module.as_str())) {
        let code = code(source.without_tests());
        for needle in ["set_global_default", "set_default", "with_default", "try_init"] {
            if code.contains(needle) {
                wrong.push(format!("{}: {needle}", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "only {} may:\n{}", BINARY.join(", "), wrong.join("\n"));
}

/// Messages that leave are made from types that cannot be out of range, and nowhere else.
#[test]
fn only_the_typed_orders_make_messages() {
    let mut wrong = Vec::new();
    for source in sources() {
        // the embedded vehicle's own messages, those of logs that tests read, and names of the dialect in patterns
        let makes = [
            "fly/target/",
            "fly/setpoint.rs",
            "fetch/peer.rs",
            "sitl/",
            "wire/encode.rs",
            "link/signing/tests.rs",
        ];
        if !makes.iter().any(|path| source.path.starts_with(path))
            && code(source.without_tests()).contains("_DATA {")
        {
            wrong.push(source.path);
        }
    }
    assert!(
        wrong.is_empty(),
        "messages are made in fly/target, fly/setpoint.rs and fetch/peer.rs, not in:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn files_stay_short() {
    let long: Vec<String> = sources()
        .iter()
        .map(|source| (&source.path, source.text.lines().count()))
        .filter(|(_, lines)| *lines > LINES_MAX)
        .map(|(path, lines)| format!("{path}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "more than {LINES_MAX} lines:\n{}", long.join("\n"));
}

/// Paths and documents hold what others wrote: `text` shows the ones and writes the others.
#[test]
fn foreign_text_goes_through_one_place() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.module != "text") {
        let code = code(source.without_tests());
        for needle in [".display()", "to_string_lossy()", "serde_json::to_string", "serde_json::to_writer"] {
            let names_the_system =
                ["fly/runner/link_kind.rs", "link/transport/pty.rs", "link/transport/serial.rs"];
            let hands_on = needle == "to_string_lossy()" && names_the_system.contains(&source.path.as_str());
            if code.contains(needle) && !hands_on {
                wrong.push(format!("{}: {needle}", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "only `text` may:\n{}", wrong.join("\n"));
}
