//! Disks that are full: nothing that was there is lost, and no half file appears.

use crate::command::{COARSE, Folder, Outcome, write_room};
use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};

/// What a folder holds.
fn content(folder: &Folder, name: &str) -> BTreeMap<String, Vec<u8>> {
    (folder.names(name).into_iter())
        .filter_map(|file| {
            let bytes = fs::read(folder.path(name).join(&file)).ok()?;
            Some((file, bytes))
        })
        .collect()
}

/// Runs a command line in a shell that has done `before`.
fn shell(folder: &Folder, before: &str, line: &str) -> Outcome {
    let program = env!("CARGO_BIN_EXE_certilux");
    let mut command = Command::new("sh");
    command
        .current_dir(folder.path(""))
        .args(["-c", &format!("{before} exec {program} {line}")])
        .stdin(Stdio::null());
    Outcome::of(command.output().unwrap())
}

/// Results of a room, and the line that solves it anew with other light.
fn solved() -> (Folder, String) {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line(&format!("solve room.obj --out results {COARSE}"))
        .ends_with(0, "first");
    let line = format!("solve room.obj --out results --seed 2 {COARSE}");
    (folder, line)
}

/// A limit on the size of files fails a write in its middle, as a full disk does, for any user.
#[cfg(target_os = "linux")]
#[test]
fn a_write_that_fails_in_its_middle_leaves_the_old_results() {
    let (folder, line) = solved();
    let old = content(&folder, "results");
    assert_eq!(
        old.keys().collect::<Vec<_>>(),
        ["solution.ply", "stats.json"]
    );
    let blocks = old["solution.ply"].len() / 512;
    assert!(blocks > 16);
    // With the limit's signal ignored by whoever started us, and without.
    let limits = [0, 1, blocks / 2, blocks - 8].into_iter();
    for (limit, trap) in limits.flat_map(|limit| [(limit, "trap '' XFSZ;"), (limit, "")]) {
        // The checkpoint does not fit either, which is no failure by itself.
        let run = shell(&folder, &format!("{trap} ulimit -f {limit};"), &line);
        run.ends_with(3, "no room").says(&["solution.ply"]);
        let now = content(&folder, "results");
        for (name, bytes) in &old {
            assert!(now[name] == *bytes, "{name} has changed");
        }
        let more: Vec<_> = now.keys().filter(|n| !old.contains_key(*n)).collect();
        assert!(more.iter().all(|n| *n == "solve.checkpoint"), "{more:?}");
        assert!(
            !folder
                .names("results")
                .iter()
                .any(|n| n.ends_with(".partial"))
        );
    }
    // And once there is room, the solve goes on.
    folder
        .line(&format!("{line} --resume"))
        .ends_with(0, "with room");
    let new = content(&folder, "results");
    assert_eq!(
        new.keys().collect::<Vec<_>>(),
        ["solution.ply", "stats.json"]
    );
    assert!(new["solution.ply"] != old["solution.ply"]);
}

/// Every command that writes one file.
#[cfg(target_os = "linux")]
#[test]
fn other_files_are_whole_or_as_they_were() {
    let (folder, _) = solved();
    for (file, line) in [
        ("view.png", "view results --out view.png --size 320x240"),
        ("view.exr", "view results --out view.exr --size 320x240"),
        ("clusters.ply", "clusters room.obj --out clusters.ply"),
        (
            "ref.json",
            "reference room.obj --out ref.json --error 0.5 --max-seconds 1",
        ),
        ("report.html", "report results --out report.html"),
        ("occluders.obj", "occluders room.obj --out occluders.obj"),
    ] {
        folder.write(file, "as it was");
        let run = shell(&folder, "trap '' XFSZ; ulimit -f 0;", line);
        run.ends_with(3, line).says(&[file]);
        assert_eq!(fs::read(folder.path(file)).unwrap(), b"as it was", "{line}");
        let names = folder.names(".");
        assert!(!names.iter().any(|n| n.ends_with(".partial")), "{names:?}");
    }
}

/// A disk of 24 kB of its own, where the system lets us make one.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_runs_full() {
    let folder = Folder::new();
    write_room(&folder);
    fs::create_dir(folder.path("disk")).unwrap();
    let program = env!("CARGO_BIN_EXE_certilux");
    let script = format!(
        "mount -t tmpfs -o size=24k none disk || exit 99; echo keep > disk/kept; \
         {program} solve room.obj --out disk/results {COARSE}; code=$?; cat disk/kept; ls disk/results; exit $code"
    );
    let output = Command::new("unshare")
        .current_dir(folder.path(""))
        .args(["--mount", "--map-root-user", "sh", "-c", &script])
        .stdin(Stdio::null())
        .output();
    match output.map(Outcome::of) {
        Ok(run) if run.code == Some(3) => {
            run.says(&["disk/results", "No space left"]);
            let left: Vec<&str> = run.stdout.split_whitespace().collect();
            assert!(
                left == ["keep"] || left == ["keep", "solve.checkpoint"],
                "{left:?}"
            );
        }
        Ok(run)
            if run.code != Some(0) && run.stderr.contains("unshare")
                || run.stderr.contains("mount") =>
        {
            println!("no disk can be made here: {}", run.stderr);
        }
        Ok(run) => panic!("{:?} {}", run.code, run.stderr),
        Err(error) => println!("no disk can be made here: {error}"),
    }
}

/// What is printed is either taken or missed, files or none; a reader that left had enough.
#[cfg(target_os = "linux")]
#[test]
fn printed_results_that_are_lost_are_an_error() {
    let (folder, _) = solved();
    let into_full_disk = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let full = fs::OpenOptions::new().write(true).open("/dev/full");
        let mut command = folder.command(&words);
        Outcome::of(command.stdout(full.unwrap()).output().unwrap())
    };
    for line in [
        "completions bash",
        "generate --list",
        "generate cornell --out scenes",
        "solve room.obj --out results --no-view --epsilon 1e-2",
        "compare room.obj --epsilon 1e-2 --passes 1 --repeat 1 --quiet --csv table.csv",
        "audit room.obj --epsilon 1e-2 --claims 10 --quiet",
        "reference room.obj --out ref.json --error 0.5",
        "view results --out view.png --size 32x24",
    ] {
        (into_full_disk(line).ends_with(3, line)).says(&["cannot write to standard output"]);
    }
    // The files are whole by then.
    for file in ["scenes/cornell.obj", "table.csv", "ref.json", "view.png"] {
        assert!(folder.path(file).is_file(), "{file}");
    }
    let quiet = "generate cornell --out scenes --quiet";
    into_full_disk(quiet).ends_with(0, "nothing is printed");
    // A pipe whose reader is gone before anything is written.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = folder.command(&["completions", "bash"]);
    let run = Outcome::of(command.stdout(writer).output().unwrap());
    run.ends_with(0, "no reader");
    assert_eq!(run.stderr, "");
}
