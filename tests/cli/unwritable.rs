//! Places where no result can be written.

use crate::command::{COARSE, Folder, write_room};
use std::fs;

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

#[test]
fn a_folder_in_the_place_of_a_result() {
    let folder = Folder::new();
    write_room(&folder);
    fs::create_dir_all(folder.path("results/stats.json")).unwrap();
    folder
        .line(&format!("solve room.obj --out results {COARSE}"))
        .ends_with(3, "stats.json is a folder")
        .says(&["stats.json"]);
    assert!(
        !folder
            .names("results")
            .iter()
            .any(|n| n.ends_with(".partial"))
    );
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
    // The light is not lost: the solve goes on from its end once the name is free.
    assert_eq!(
        folder.names("results"),
        ["solution.ply", "solve.checkpoint"]
    );
    fs::remove_file(folder.path("results/solution.ply")).unwrap();
    folder
        .line(&format!("solve room.obj --out results --resume {COARSE}"))
        .ends_with(0, "the name is free");
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
}
