//! Ctrl-C.
#![cfg(unix)]

use crate::command::{Folder, Outcome};
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Starts a solve of minutes, lets it work for `before`, sends `signal` and waits for its end.
fn interrupted(folder: &Folder, signal: Signal, before: Duration) -> Outcome {
    stopped(
        folder,
        "solve builtin:offices --out results --epsilon 1e-9 --gradient 1e-6 --min-area 0",
        signal,
        before,
    )
}

/// As [`interrupted`], of any command.
fn stopped(folder: &Folder, arguments: &str, signal: Signal, before: Duration) -> Outcome {
    let mut child = folder
        .command(&arguments.split_whitespace().collect::<Vec<_>>())
        .spawn()
        .unwrap();
    sleep(before);
    assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
    let sent = Instant::now();
    kill_process(Pid::from_child(&child), signal).unwrap();
    let outcome = Outcome::of(child.wait_with_output().unwrap());
    let waited = sent.elapsed();
    // Far above what a task takes, far below what the solve would.
    assert!(waited < Duration::from_secs(10), "{waited:?}");
    outcome
}

#[test]
fn a_stopped_solve_says_so_and_leaves_nothing() {
    let folder = Folder::new();
    let run = interrupted(&folder, Signal::INT, Duration::from_secs(3));
    run.ends_with(130, "interrupted")
        .says(&["interrupted", "nothing was"]);
    assert!(folder.names("results").is_empty());
}

#[test]
fn results_of_an_earlier_solve_stay() {
    let folder = Folder::new();
    fs::create_dir(folder.path("results")).unwrap();
    let old = ["solution.ply", "stats.json", "view.exr", "view.png"];
    for name in old {
        folder.write(&format!("results/{name}"), name);
    }
    interrupted(&folder, Signal::TERM, Duration::from_secs(2)).ends_with(130, "terminated");
    assert_eq!(folder.names("results"), old);
    for name in old {
        let path = folder.path("results").join(name);
        assert_eq!(fs::read(path).unwrap(), name.as_bytes());
    }
}

#[test]
fn a_stopped_measurement_leaves_the_earlier_one() {
    let folder = Folder::new();
    folder.write("ref.json", "earlier");
    stopped(
        &folder,
        "reference builtin:cornell --out ref.json --error 1e-6",
        Signal::INT,
        Duration::from_secs(2),
    )
    .ends_with(130, "interrupted")
    .says(&["interrupted"]);
    assert_eq!(folder.names("."), ["ref.json"]);
    assert_eq!(fs::read(folder.path("ref.json")).unwrap(), b"earlier");
}

#[test]
fn a_stopped_sweep_keeps_what_was_solved_and_goes_on() {
    let folder = Folder::new();
    let sweep = "sweep builtin:cornell --out results --reference-seconds 0.5 --technique normal --epsilon 1e-3,3e-8 --rays 8 \
                 --gradient 5e-3 --min-area 1e-6 --stride auto --occluders 8 --occluder-size 1e-4 --flatness 1 \
                 --converge 1e-2 --repeat 1";
    // The first row takes a moment, the second minutes.
    stopped(&folder, sweep, Signal::INT, Duration::from_secs(6))
        .ends_with(130, "interrupted")
        .says(&["1 of 2 solves", "--resume"]);
    assert_eq!(
        folder.names("results"),
        ["reference.json", "sweep.csv", "sweep.json"]
    );
    let kept = fs::read_to_string(folder.path("results/sweep.csv")).unwrap();
    assert_eq!(kept.lines().count(), 2);
    let rest = sweep.replace("3e-8", "2e-3");
    folder
        .line(&format!("{rest} --resume"))
        .ends_with(0, "resumed");
    let resumed = fs::read_to_string(folder.path("results/sweep.csv")).unwrap();
    assert_eq!(resumed.lines().count(), 3);
    // All but the last columns: what stands on the front may change.
    let row = |text: &str| {
        let line = text.lines().nth(1).unwrap();
        line.rsplitn(3, ',').last().unwrap().to_owned()
    };
    assert_eq!(row(&kept), row(&resumed));
}

/// A suite is many solves, of minutes each where they are the paper's.
#[test]
fn a_stopped_suite_ends_in_the_middle_of_a_solve() {
    let folder = Folder::new();
    let line = "bench --suite paper --no-instructions --record now.json";
    stopped(&folder, line, Signal::INT, Duration::from_secs(3))
        .ends_with(130, "interrupted")
        .says(&["interrupted"]);
    assert!(folder.names(".").is_empty());
}
