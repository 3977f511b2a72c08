//! Solves that are killed and go on, and checkpoints that are refused.
#![cfg(unix)]

use crate::command::{COARSE, Folder, Outcome, ROOM, write_room};
use crate::determinism::counts;
use certilux::math::hash_u64;
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

const CHECKPOINT: &str = "results/solve.checkpoint";

/// A solve of many short passes.
const MANY_PASSES: &str =
    "solve builtin:cornell --no-view --epsilon 1e-4 --gradient 0.05 --passes 14 --quiet";

fn start(folder: &Folder, line: &str) -> Child {
    let words: Vec<&str> = line.split_whitespace().collect();
    folder.command(&words).spawn().unwrap()
}

/// Runs a solve into `results` until its first checkpoint stands there, and kills it.
fn kill_after_first_checkpoint(folder: &Folder, line: &str) {
    let mut child = start(folder, &format!("{line} --out results"));
    let began = Instant::now();
    while !folder.path(CHECKPOINT).exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        assert!(began.elapsed() < Duration::from_secs(60), "no checkpoint");
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(folder.path(CHECKPOINT).exists(), "it ended by itself");
}

/// A solve of some hundred passes, seconds in all.
const ROOM_LINE: &str =
    "solve room.obj --no-view --epsilon 1e-5 --gradient 0.01 --min-area 1e-6 --converge 1e-30";

/// A folder in which [`ROOM_LINE`] was killed after its first checkpoint.
fn killed_room() -> Folder {
    let folder = Folder::new();
    write_room(&folder);
    kill_after_first_checkpoint(&folder, ROOM_LINE);
    folder
}

/// Kills a solve by SIGKILL `kills` times at random moments, each time going on with `--resume` and another
/// number of threads, and compares the end with a solve that nobody disturbed.
fn survives(kills: u32) {
    let folder = Folder::new();
    let began = Instant::now();
    let whole = folder.line(&format!("{MANY_PASSES} --out whole"));
    let duration = began.elapsed();
    whole.ends_with(0, "whole");

    let mut killed = 0;
    let mut rounds = 0;
    let mut took_up = 0;
    for attempt in 0u64.. {
        let threads = 1 + attempt % 3;
        let line = format!("{MANY_PASSES} --out results --resume --threads {threads}");
        took_up += u32::from(folder.path(CHECKPOINT).exists());
        let mut child = start(&folder, &line);
        // At most two thirds of a whole solve; a process that ends before that finished its round.
        let share = (hash_u64(attempt ^ u64::from(kills)) % 1000) as f64 / 1500.0;
        let until = Instant::now() + duration.mul_f64(share);
        let ended = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break Some(status);
            }
            if killed < kills && Instant::now() >= until {
                break None;
            }
            sleep(Duration::from_millis(1));
        };
        if ended.is_none() {
            child.kill().unwrap();
            killed += 1;
        }
        let outcome = Outcome::of(child.wait_with_output().unwrap());
        if ended.is_none() {
            continue;
        }
        outcome.ends_with(0, "resumed");
        rounds += 1;
        let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
        assert!(solution("whole") == solution("results"), "round {rounds}");
        assert_eq!(
            counts(folder.stats("whole")),
            counts(folder.stats("results"))
        );
        assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
        if killed == kills {
            break;
        }
        fs::remove_dir_all(folder.path("results")).unwrap();
    }
    println!("{killed} kills, {took_up} runs took up a checkpoint, {rounds} solves completed");
    assert!(took_up > 0, "no run ever met a checkpoint");
}

#[test]
fn a_killed_solve_goes_on_to_the_same_bytes() {
    survives(6);
}

#[test]
#[ignore = "minutes: 50 kills"]
fn fifty_kills_leave_no_trace() {
    survives(50);
}

#[test]
fn an_interrupted_solve_says_how_to_go_on() {
    let folder = Folder::new();
    write_room(&folder);
    let child = start(&folder, &format!("{ROOM_LINE} --out results"));
    while !folder.path(CHECKPOINT).exists() {
        sleep(Duration::from_millis(1));
    }
    kill_process(Pid::from_child(&child), Signal::INT).unwrap();
    Outcome::of(child.wait_with_output().unwrap())
        .ends_with(130, "interrupted")
        .says(&["interrupted", "--resume", "solve.checkpoint"]);
    assert_eq!(folder.names("results"), ["solve.checkpoint"]);
}

/// Asserts that the checkpoint in `results` is refused whole: nothing is solved, and it stays as it is.
#[track_caller]
fn refused(folder: &Folder, line: &str, words: &[&str], what: &str) {
    let before = fs::read(folder.path(CHECKPOINT)).unwrap();
    folder
        .line(&format!("{line} --out results --resume"))
        .ends_with(2, what)
        .says(&["solve.checkpoint", "--resume"])
        .says(words);
    assert_eq!(folder.names("results"), ["solve.checkpoint"], "{what}");
    assert!(
        fs::read(folder.path(CHECKPOINT)).unwrap() == before,
        "{what}"
    );
}

#[test]
fn no_damaged_checkpoint_is_loaded() {
    let folder = killed_room();
    let whole = fs::read(folder.path(CHECKPOINT)).unwrap();
    assert!(whole.len() > 2000, "{}", whole.len());
    // The head closely, the rest here and there.
    let places = (0..16)
        .chain((16..400).step_by(48))
        .chain((400..whole.len()).step_by(whole.len() / 24));
    for at in places {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        fs::write(folder.path(CHECKPOINT), flipped).unwrap();
        refused(&folder, ROOM_LINE, &[], &format!("byte {at}"));
    }
    for length in [0, 1, 8, 11, 12, 40, 300, whole.len() / 2, whole.len() - 1] {
        fs::write(folder.path(CHECKPOINT), &whole[..length]).unwrap();
        refused(&folder, ROOM_LINE, &["damaged"], &format!("{length} bytes"));
    }
    let mut newer = whole.clone();
    newer[8] += 1;
    fs::write(folder.path(CHECKPOINT), newer).unwrap();
    refused(&folder, ROOM_LINE, &["newer"], "newer");
    fs::write(folder.path(CHECKPOINT), "# notes\n").unwrap();
    refused(
        &folder,
        ROOM_LINE,
        &["no checkpoint of certilux"],
        "foreign file",
    );
}

#[test]
fn a_checkpoint_of_another_scene_or_of_other_settings_is_refused() {
    let folder = killed_room();
    for (more, words) in [
        ("--epsilon=2e-4", "epsilon is 1e-5 there and 2e-4 here"),
        (
            "--technique=normal",
            "technique is occlusion there and normal here",
        ),
        ("--seed=2", "seed"),
        ("--rays=16", "rays"),
        ("--sides=two", "sides"),
        ("--occluders=1", "occluders"),
        ("--stride=4", "stride"),
        ("--normalise=off", "normalise"),
    ] {
        let line = match more.starts_with("--epsilon") {
            true => &ROOM_LINE.replace("--epsilon 1e-5", ""),
            false => ROOM_LINE,
        };
        refused(
            &folder,
            &format!("{line} {more}"),
            &["another solve", words],
            more,
        );
    }
    let line = ROOM_LINE.replace("--converge 1e-30", "--passes 9");
    refused(&folder, &line, &["another solve", "passes"], "passes");

    folder.write(
        "room.mtl",
        ROOM[1].replace("Kd 0.5 0.5 0.5", "Kd 0.5 0.5 0.6"),
    );
    refused(&folder, ROOM_LINE, &["another scene"], "another colour");
    folder.write("room.mtl", ROOM[1]);
    folder.write(
        "room.obj",
        ROOM[0].replace("v 1 1 1\n", "v 1 1 1.0000001\n"),
    );
    refused(&folder, ROOM_LINE, &["another scene"], "another vertex");
}

#[test]
fn resuming_what_is_done_does_nothing_and_what_was_never_begun_begins_it() {
    let folder = Folder::new();
    write_room(&folder);
    let line = "solve room.obj --no-view --epsilon 1e-3 --out results --resume";
    folder.line(line).ends_with(0, "begun");
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
    let stats = || fs::read(folder.path("results/stats.json")).unwrap();
    let first = stats();
    let again = folder.line(line);
    again.ends_with(0, "again");
    assert!(again.stdout.contains("already"), "{}", again.stdout);
    assert_eq!(stats(), first);

    // Not all of it, not whole, not asked to.
    let seconds = "\"seconds\"";
    assert!(String::from_utf8_lossy(&first).contains(seconds));
    for (what, change) in [
        (
            "picture",
            &(|| folder.line(&line.replace("--no-view ", ""))) as &dyn Fn() -> Outcome,
        ),
        ("bytes", &|| {
            let path = folder.path("results/solution.ply");
            let mut bytes = fs::read(&path).unwrap();
            let end = bytes.len() - 5;
            bytes[end] ^= 1;
            fs::write(&path, bytes).unwrap();
            folder.line(line)
        }),
        ("anew", &|| folder.line(line.trim_end_matches(" --resume"))),
    ] {
        let run = change();
        run.ends_with(0, what);
        assert!(!run.stdout.contains("already"), "{what}: {}", run.stdout);
        folder.line(line).ends_with(0, "restore");
    }
}

/// Whoever says `--resume` expects nothing to be lost: what another solve has finished is not overwritten.
#[test]
fn resuming_over_another_finished_solve_is_refused() {
    let folder = Folder::new();
    write_room(&folder);
    let line = format!("solve room.obj --out results {COARSE}");
    folder.line(&line).ends_with(0, "finished");
    let read = || ["solution.ply", "stats.json"].map(|f| fs::read(folder.path("results").join(f)));
    let before = read().map(Result::unwrap);
    let advice = ["results", "without --resume", "another --out"];
    let refused = |more: &str, words: &str| {
        let run = folder.line(&format!("{line} --resume {more}"));
        run.ends_with(2, words).says(&[words]).says(&advice);
        assert!(!run.stderr.contains("seed is 1 there and 1"), "{words}");
        assert!(read().map(Result::unwrap) == before, "{words}");
        assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
    };
    for (more, words) in [
        ("--seed 7", "seed is 1 there and 7 here"),
        (
            "--technique normal",
            "technique is occlusion there and normal here",
        ),
        ("--passes 2", "passes is not set there and 2 here"),
        ("--rays 16 --format vtu", "rays is 8 there and 16 here"),
    ] {
        refused(more, words);
    }
    folder.write("room.mtl", ROOM[1].replace("Ke 10 10 10", "Ke 20 20 20"));
    refused("", "another scene");
    folder.write("room.mtl", ROOM[1]);

    // The same settings in other words, and what does not affect the light.
    let again = folder.line(&format!("{line} --resume --seed=1 --rays 8 --threads 1"));
    again.ends_with(0, "the same");
    assert!(again.stdout.contains("already"), "{}", again.stdout);
    // What is taken for another version's.
    let text = String::from_utf8(before[1].clone()).unwrap();
    let version = format!("\"certilux\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version));
    folder.write(
        "results/stats.json",
        text.replace(&version, "\"certilux\": \"0.0.0\""),
    );
    folder
        .line(&format!("{line} --resume"))
        .ends_with(2, "another version")
        .says(&["certilux is 0.0.0 there"])
        .says(&advice);
    // The advice holds.
    folder
        .line(&format!("{line} --resume --seed 7").replace("results", "others"))
        .ends_with(0, "another folder");
    folder
        .line(&format!("{line} --seed 7"))
        .ends_with(0, "without --resume");
    assert_eq!(folder.stats("results")["seed"], 7);
}

/// A solve that was begun over another one goes on: that the other is lost was decided when it began.
#[test]
fn a_checkpoint_over_another_finished_solve_is_taken_up() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line(&format!("solve room.obj --out results {COARSE} --seed 7"))
        .ends_with(0, "finished");
    kill_after_first_checkpoint(&folder, ROOM_LINE);
    let run = folder.line(&format!("{ROOM_LINE} --out results --resume"));
    run.ends_with(0, "resumed");
    assert!(run.stdout.contains("went on after pass"), "{}", run.stdout);
    assert_eq!(folder.stats("results")["seed"], 1);
}

/// A finished solve is not solved again for other pictures or forms: they are what a solve with these options writes.
#[test]
fn resuming_with_other_outputs_makes_them_from_the_solution() {
    let folder = Folder::new();
    write_room(&folder);
    let line = "solve room.obj --epsilon 1e-3 --gradient 0.1 --min-area 1e-3";
    folder
        .line(&format!("{line} --no-view --out results"))
        .ends_with(0, "begun");
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    let without_outputs = |results: &str| {
        let mut stats = folder.stats(results);
        for key in ["outputs", "command", "seconds"] {
            stats.as_object_mut().unwrap().remove(key).unwrap();
        }
        for pass in stats["passes"].as_array_mut().unwrap() {
            pass.as_object_mut().unwrap().remove("seconds").unwrap();
        }
        stats
    };
    let solved = read("results/stats.json");
    let mut made = vec!["solution.ply".to_owned(), "stats.json".to_owned()];
    for (round, (options, says, names)) in [
        ("", "view.exr, view.png\n", "view.exr view.png"),
        (
            "--up z --format glb,vtu",
            "solution.glb, solution.vtu, view.exr (--up z instead of auto), view.png (--up z instead of auto)\n",
            "solution.glb solution.vtu view.exr view.png",
        ),
        (
            "--no-view --up x --format glb",
            "solution.glb (--up x instead of z)\n",
            "solution.glb",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let run = folder.line(&format!("{line} --resume {options} --out results"));
        run.ends_with(0, options);
        assert!(run.stdout.contains(says), "{options}: {}", run.stdout);
        assert!(!run.stdout.contains("exchanges"), "solved again: {}", run.stdout);
        let fresh = format!("fresh{round}");
        folder
            .line(&format!("{line} {options} --out {fresh}"))
            .ends_with(0, options);
        for name in names.split(' ') {
            let same = read(&format!("results/{name}")) == read(&format!("{fresh}/{name}"));
            assert!(same, "{options}: {name}");
            made.push(name.to_owned());
        }
        assert_eq!(without_outputs("results"), without_outputs(&fresh));
        made.sort();
        made.dedup();
        // What was made before and not asked for now is of the same light, and stays.
        assert_eq!(folder.names("results"), made, "{options}");

        let before = read("results/stats.json");
        let again = folder.line(&format!("{line} --resume {options} --out results"));
        again.ends_with(0, options);
        assert!(again.stdout.contains("already"), "{}", again.stdout);
        assert_eq!(before, read("results/stats.json"));
    }
    // Times and command are those of the solve.
    let key = |text: &[u8], key: &str| {
        let stats: serde_json::Value = serde_json::from_slice(text).unwrap();
        stats[key].clone()
    };
    for name in ["command", "seconds"] {
        assert_eq!(key(&solved, name), key(&read("results/stats.json"), name));
    }

    // A file that was lost is made again; a solve of other light leaves none of the old.
    fs::remove_file(folder.path("results/view.exr")).unwrap();
    folder
        .line(&format!("{line} --up z --resume --out results"))
        .ends_with(0, "lost");
    assert!(folder.path("results/view.exr").exists());
    folder
        .line(&format!("{line} --seed 7 --no-view --out results"))
        .ends_with(0, "other light");
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
}

/// A checkpoint that cannot be written costs a warning, not the solve.
#[test]
fn a_checkpoint_that_cannot_be_written_is_no_failure() {
    let folder = Folder::new();
    write_room(&folder);
    fs::create_dir_all(folder.path("results/solve.checkpoint")).unwrap();
    folder
        .line("solve room.obj --no-view --epsilon 1e-3 --out results")
        .ends_with(0, "solved")
        .says(&["warning", "without a checkpoint", "solve.checkpoint"]);
    assert!(folder.path("results/solution.ply").exists());
    // Not even tried.
    let run = folder.line("solve room.obj --no-view --epsilon 1e-3 --out results --no-checkpoint");
    run.ends_with(0, "no checkpoint");
    assert_eq!(run.stderr, "");
}

#[test]
fn two_solves_do_not_share_a_folder() {
    let folder = Folder::new();
    write_room(&folder);
    let mut first = start(
        &folder,
        "solve builtin:offices --out results --epsilon 1e-9 --min-area 0",
    );
    while !folder.path("results").exists() {
        sleep(Duration::from_millis(1));
    }
    // Made, and then locked.
    sleep(Duration::from_millis(200));
    folder
        .line("solve room.obj --out results --epsilon 1e-3")
        .ends_with(2, "second")
        .says(&["another solve is writing into results"]);
    first.kill().unwrap();
    first.wait().unwrap();
    folder
        .line("solve room.obj --no-view --out results --epsilon 1e-3")
        .ends_with(0, "third");
}

/// The estimate refuses before anything is made; what is found too much after a pass leaves a checkpoint.
#[test]
fn memory_is_bounded_before_and_during_a_solve() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line(&format!("{ROOM_LINE} --out results --max-memory 20M"))
        .ends_with(2, "estimate")
        .says(&["likely to need", "--max-memory 20 MiB"]);
    assert!(!folder.path("results").exists());
    // The guess does not know what becomes of a coarse gradient under a fine epsilon.
    let unlikely = "solve room.obj --no-view --epsilon 1e-5 --gradient 1e6 --converge 1e-30 --threads 32 --out results";
    folder
        .line(&format!("{unlikely} --max-memory 17M"))
        .ends_with(3, "guard")
        .says(&["after a pass", "--max-memory", "--resume"]);
    assert_eq!(folder.names("results"), ["solve.checkpoint"]);
    folder
        .line(&format!("{unlikely} --resume --max-memory 2G"))
        .ends_with(0, "with more");
    folder
        .line("solve room.obj --out x --max-memory lots")
        .ends_with(2, "size");
}
