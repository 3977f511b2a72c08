//! Places where no result can be written.

use crate::command::{COARSE, Folder, Outcome, write_room};
use std::fs;
use std::path::Path;

#[test]
fn a_file_in_the_place_of_the_folder() {
    let folder = Folder::new();
    write_room(&folder);
    folder.write("taken", "keep me");
    for out in ["taken", "taken/below"] {
        folder
            .line(&format!("solve room.obj --out {out} {COARSE}"))
            .ends_with(3, out)
            .says(&["taken"]);
    }
    assert_eq!(fs::read(folder.path("taken")).unwrap(), b"keep me");
}

/// Nor are the files of a measurement.
#[cfg(target_os = "linux")]
#[test]
fn a_file_in_a_folder_that_takes_none() {
    let folder = Folder::new();
    write_room(&folder);
    for line in [
        "reference room.obj --out /proc/ref.json --error 1e-9",
        "bench --suite paper --record /proc/bench.json",
    ] {
        let run = folder.line(line);
        run.ends_with(3, line).says(&["cannot write /proc"]);
        assert_eq!(run.stdout, "", "{line}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files() {
    let folder = Folder::new();
    write_room(&folder);
    for out in ["/proc/certilux", "/proc/self"] {
        folder
            .line(&format!("solve room.obj --out {out} {COARSE}"))
            .ends_with(3, out)
            .says(&["/proc"]);
    }
}

/// Minutes of work are not done for a file that has no place.
#[test]
fn a_report_that_has_no_place_is_refused_before_the_work() {
    let folder = Folder::new();
    write_room(&folder);
    for command in [
        "audit room.obj --json none/a.json",
        "compare room.obj --csv none/a.csv",
        "compare room.obj --json a.json --markdown .",
        "reference room.obj --out none/a.json",
        "bench --suite paper --record none/a.json",
    ] {
        // Nothing has been said of any scene yet.
        let ended = folder.line(command);
        ended.ends_with(3, command).says(&["cannot write"]);
        assert_eq!(ended.stdout, "", "{command}");
    }
    assert!(!folder.path("a.json").exists());
}

/// Known before the solve: one that runs leaves its checkpoint.
#[test]
fn a_folder_in_the_place_of_a_result() {
    for name in ["stats.json", "solution.ply", "view.png"] {
        let folder = Folder::new();
        write_room(&folder);
        fs::create_dir_all(folder.path("results").join(name)).unwrap();
        folder
            .line("solve room.obj --out results --epsilon 1e-3")
            .ends_with(3, name)
            .says(&[name]);
        assert_eq!(folder.names("results"), [name]);
    }
}

/// A user that owns nothing here, whose number means nobody nearly everywhere.
#[cfg(unix)]
const NOBODY: u32 = 65_534;

/// Whether permissions do not bind whoever runs the tests.
#[cfg(unix)]
fn is_superuser(read_only: &Path) -> bool {
    let probe = read_only.join("probe");
    let made = fs::File::create(&probe).is_ok();
    if made {
        fs::remove_file(&probe).unwrap();
    }
    made
}

/// The superuser may write anyway, so the program then runs as somebody else.
#[cfg(unix)]
#[test]
fn a_read_only_folder_is_known_before_the_solve() {
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::CommandExt;
    let folder = Folder::new();
    write_room(&folder);
    let permit = |name: &str, mode| {
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(mode)).unwrap();
    };
    fs::create_dir(folder.path("results")).unwrap();
    // Anybody may come here and read the scene.
    permit("", 0o755);
    permit("results", 0o555);
    let superuser = is_superuser(&folder.path("results"));
    let run = |line: &str| {
        let mut command = folder.command(&line.split(' ').collect::<Vec<_>>());
        if superuser {
            command.uid(NOBODY).gid(NOBODY);
        }
        command.output().map(Outcome::of)
    };
    // The program may lie below a folder of the superuser's own, or a container may not let it be anybody else.
    if !run("--version").is_ok_and(|outcome| outcome.code == Some(0)) {
        assert!(superuser, "the program does not run");
        eprintln!("NOT TESTED: a read-only folder; the program cannot be run as another user");
        return;
    }
    let run = run("solve room.obj --out results --passes 2").unwrap();
    let left = folder.names("results");
    permit("results", 0o755);
    run.ends_with(3, "read-only")
        .says(&["cannot write into results"]);
    // Nothing was solved.
    assert!(!run.stderr.contains("checkpoint"), "{}", run.stderr);
    assert!(left.is_empty(), "{left:?}");
}

/// Links to a device, not the device itself: nothing of the machine is at stake.
#[cfg(target_os = "linux")]
#[test]
fn a_device_in_the_place_of_a_result() {
    let folder = Folder::new();
    write_room(&folder);
    fs::create_dir(folder.path("results")).unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.path("results/solution.ply")).unwrap();
    folder
        .line(&format!("solve room.obj --out results {COARSE}"))
        .ends_with(3, "a device")
        .says(&["solution.ply"]);
    // Nothing was solved.
    assert_eq!(folder.names("results"), ["solution.ply"]);
}
