//! What a missing peer, recording or address does to a test.

use crate::require;

use require::{Needed, judge};
use std::path::{Path, PathBuf};

#[test]
fn what_is_missing_is_told_and_fails_only_where_it_is_required() {
    let why = "no Python at /nowhere";
    for required in ["", "shared", "mavsdk, ipv6", ","] {
        assert_eq!(judge(Needed::Peers, why, required).unwrap(), "skipped: no Python at /nowhere");
    }
    for required in ["peers", "shared,peers", " peers , mavsdk"] {
        let failure = judge(Needed::Peers, why, required).unwrap_err();
        assert_eq!(failure, "MAVID_REQUIRE asks for `peers`, which is missing: no Python at /nowhere");
    }
    let failure = judge(Needed::Peers, why, "peers,share").unwrap_err();
    assert_eq!(
        failure,
        "MAVID_REQUIRE: expected words out of peers, mavsdk, mujoco, tables, shared, ipv6, browser, found `share`"
    );
}

#[test]
fn tests_skip_by_one_helper() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")];
    let mut files: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    assert!(files.len() > 10, "{files:?}");
    // the two that say it in words of their own: the helper, and this test
    let own = |path: &PathBuf| path.ends_with("require.rs") || path.ends_with("requirements.rs");
    for path in files.iter().filter(|path| !own(path)) {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(!text.contains("\"skipped"), "{}: use support::skip", path.display());
    }
}
