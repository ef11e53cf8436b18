//! The deterministic twin of each fuzz target: its corpus replayed, then seeded mutations of it. The laws are those
//! of `fuzz/src`; what the fuzzer finds is kept in the corpus, so that it is tried here from then on.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test ends where it fails"
)]

#[allow(dead_code, reason = "what only the fuzzer calls")]
#[path = "../../fuzz/src/lib.rs"]
mod fuzzing;

use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use fuzzing::{TARGETS, Target};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// An input is not made longer than this.
const LONGEST: usize = 4096;
/// Bytes that mean something to one of the readers.
const TOKENS: [&[u8]; 12] = [
    &[0xFD],
    &[0xFE],
    &[0xFF; 8],
    &[0; 4],
    &[0xFD, 0, 0, 0, 0, 1, 1, 0x83, 0, 0, 0],
    b"nan",
    b"1e308",
    b"-",
    b"\n",
    b"[[effect]]\n",
    b"\"",
    b",",
];

fn folder(of: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz").join(of).join(name)
}

/// The inputs of a folder by their names.
fn inputs(folder: &Path) -> Vec<Vec<u8>> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "no inputs in {}", folder.display());
    paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
}

/// One to eight changes to an input of the corpus.
fn mutated(random: &mut Pcg64, corpus: &[Vec<u8>]) -> Vec<u8> {
    let mut input = corpus[random.random_range(0..corpus.len())].clone();
    for _ in 0..random.random_range(1..=8) {
        let at = random.random_range(0..=input.len());
        let end = random.random_range(at..=input.len());
        match random.random_range(0..7) {
            0 if at < input.len() => input[at] ^= 1 << random.random_range(0..8),
            1 if at < input.len() => input[at] = random.random(),
            2 => drop(input.drain(at..end)),
            3 => drop(input.splice(at..at, TOKENS[random.random_range(0..TOKENS.len())].iter().copied())),
            4 => {
                let piece = input[at..end].to_vec();
                input.splice(at..at, piece);
            }
            5 => {
                let other = &corpus[random.random_range(0..corpus.len())];
                let from = random.random_range(0..=other.len());
                input.truncate(at);
                input.extend(&other[from..]);
            }
            _ => input.push(random.random()),
        }
        input.truncate(LONGEST);
    }
    input
}

/// The corpus, then so many mutations; the seeded bug is seen by the input that the fuzzer found it with.
fn twin(name: &str, mutations: u32) {
    let Target { run, .. } = TARGETS.into_iter().find(|target| target.name == name).unwrap();
    let corpus = inputs(&folder("corpus", name));
    for input in &corpus {
        run(input, false);
    }
    let mut random = Pcg64::seed_from_u64(2020);
    for _ in 0..mutations {
        let input = mutated(&mut random, &corpus);
        if let Err(broken) = catch_unwind(|| run(&input, false)) {
            // the input again, for a test of its own
            println!("{name}: {input:?}");
            std::panic::resume_unwind(broken);
        }
    }
    for input in &inputs(&folder("seeded", name)) {
        run(input, false);
        assert!(catch_unwind(|| run(input, true)).is_err(), "{name}: the seeded bug is not seen");
    }
}

#[test]
fn splitter() {
    twin("splitter", 100_000);
}

#[test]
fn tlog() {
    twin("tlog", 10_000);
}

#[test]
fn ulog() {
    twin("ulog", 10_000);
}

#[test]
fn dataflash() {
    twin("dataflash", 20_000);
}

#[test]
fn csv() {
    twin("csv", 20_000);
}

#[test]
fn toml() {
    twin("toml", 20_000);
}

#[test]
fn signing() {
    twin("signing", 10_000);
}

#[test]
fn flight() {
    twin("flight", 2000);
}

#[test]
fn identify() {
    twin("identify", 100);
}

#[test]
fn explain() {
    twin("explain", 10);
}
