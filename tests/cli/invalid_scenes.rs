//! Scenes that are refused: exit code 2, the place and the reason, and no results.

use crate::command::{COARSE, Folder, ROOM, write_room};
use std::fs;

/// Solves `name` and expects a refusal that holds `words`.
#[track_caller]
fn refused(folder: &Folder, name: &str, words: &[&str]) {
    folder
        .run(&["solve", name, "--out", "results", "--no-view"])
        .ends_with(2, name)
        .says(words);
    assert!(folder.names("results").is_empty());
}

#[test]
fn files_that_are_no_scene() {
    let folder = Folder::new();
    write_room(&folder);
    fs::create_dir(folder.path("directory.obj")).unwrap();
    folder.write("empty.obj", "");
    folder.write("comment.obj", "# nothing\n");
    folder.write("vertices.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let noise: Vec<u8> = (0..20_000u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8)
        .collect();
    folder.write("noise.obj", noise);
    folder.write("zeros.obj", [0; 4096]);
    for name in ["missing.obj", "directory.obj", "", "noise.obj"] {
        refused(&folder, name, &[name]);
    }
    for name in ["empty.obj", "comment.obj", "vertices.obj", "zeros.obj"] {
        refused(&folder, name, &[name]);
    }
    refused(&folder, "room.mtl", &["room.mtl"]);
    refused(&folder, "room.obj/below.obj", &["room.obj/below.obj"]);
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_not_read() {
    let folder = Folder::new();
    write_room(&folder);
    std::os::unix::fs::symlink("nowhere.obj", folder.path("link.obj")).unwrap();
    refused(&folder, "link.obj", &["link.obj", "a link"]);
    refused(&folder, "/dev/zero", &["/dev/zero", "device"]);
    // Opening a pipe that nobody writes into would wait for ever.
    let pipe = folder.path("pipe.obj");
    rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RUSR).unwrap();
    refused(&folder, "pipe.obj", &["pipe.obj", "a pipe"]);
    fs::remove_file(folder.path("room.mtl")).unwrap();
    fs::rename(&pipe, folder.path("room.mtl")).unwrap();
    refused(&folder, "room.obj", &["room.mtl", "could not be read"]);
}

#[test]
fn defects_are_named_with_file_and_line() {
    let folder = Folder::new();
    write_room(&folder);
    for (name, from, to, words) in [
        ("nan", "v 1 -1 -1", "v NaN -1 -1", ["nan.obj:3", "NaN"]),
        ("inf", "v 1 -1 -1", "v 1 -inf -1", ["inf.obj:3", "inf"]),
        ("big", "v 1 -1 -1", "v 1 1e999 -1", ["big.obj:3", "1e999"]),
        ("few", "v 1 -1 -1", "v 1 -1", ["few.obj:3", "`v`"]),
        ("range", "f 1 2 3 4", "f 1 2 3 99", ["range.obj:15", "99"]),
        ("zero", "f 1 2 3 4", "f 0 1 2 3", ["zero.obj:15", "0"]),
        ("back", "f 1 2 3 4", "f -99 1 2 3", ["back.obj:15", "-99"]),
    ] {
        folder.write(&format!("{name}.obj"), ROOM[0].replace(from, to));
        refused(&folder, &format!("{name}.obj"), &words);
    }
}

#[test]
fn materials_that_no_light_can_live_with() {
    let folder = Folder::new();
    for (kd, ke, words) in [
        ("Kd 0.5 NaN 0.5", "Ke 10 10 10", ["scene.mtl:2", "NaN"]),
        ("Kd -0.1 0 0", "Ke 10 10 10", ["scene.mtl:2", "negative"]),
        ("Kd 0.5 0.5 0.5", "Ke -1 0 0", ["scene.mtl:5", "negative"]),
        ("Kd 0.5 0.5 0.5", "Ke inf 0 0", ["scene.mtl:5", "inf"]),
        ("Kd 0.5 0.5 0.5", "Ke 0 0 0", ["emit", "scene.obj"]),
        ("Kd 0.5 0.5 0.5", "Ke 1e-40 0 9e-31", ["9e-31", "1e-30"]),
        ("Kd 0.5 0.5 0.5", "Ke 1 1 2e34", ["scene.mtl:5", "1e34"]),
        ("Kd 1 1 1", "Ke 10 10 10", ["wall", "--clamp-reflectance"]),
    ] {
        folder.write("scene.obj", ROOM[0].replace("room.mtl", "scene.mtl"));
        let mtl = ROOM[1]
            .replace("Kd 0.5 0.5 0.5", kd)
            .replace("Ke 10 10 10", ke);
        folder.write("scene.mtl", mtl);
        refused(&folder, "scene.obj", &words);
    }
    folder.write("scene.obj", ROOM[0].replace("room.mtl", "missing.mtl"));
    refused(&folder, "scene.obj", &["missing.mtl", "emit"]);
}

/// The room's vertices `factor` times as far from the origin.
fn scaled(factor: &str) -> String {
    let line = |l: &str| match l.strip_prefix("v ") {
        Some(rest) => {
            let numbers = rest.split(' ').map(|x| format!("{x}{factor}"));
            format!("v {}\n", numbers.collect::<Vec<_>>().join(" "))
        }
        None => format!("{l}\n"),
    };
    ROOM[0].lines().map(line).collect()
}

#[test]
fn units_in_which_areas_have_no_squares() {
    let folder = Folder::new();
    write_room(&folder);
    for factor in ["e-62", "e61", "e-100", "e200"] {
        folder.write("huge.obj", scaled(factor));
        refused(&folder, "huge.obj", &["huge.obj", "1e-60 and 1e60"]);
    }
    // What is allowed gives the same picture, and the same reference.
    let mut pictures = Vec::new();
    for factor in ["e0", "e-60", "e59"] {
        folder.write("room.obj", scaled(factor));
        for line in [
            format!("solve room.obj --out results {COARSE}"),
            "view results --out view.png --size 64x48".to_owned(),
            "reference room.obj --out ref.json --error 0.5 --max-seconds 1".to_owned(),
        ] {
            folder.line(&line).ends_with(0, factor);
        }
        pictures.push(fs::read(folder.path("view.png")).unwrap());
    }
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn a_room_without_a_size_beside_what_lies_far_off() {
    let folder = Folder::new();
    write_room(&folder);
    let far = "v 1e10 1e10 1e10\nv 10000000001 1e10 1e10\nv 1e10 10000000001 1e10\nf -1 -2 -3\n";
    folder.write("far.obj", ROOM[0].to_owned() + far);
    refused(
        &folder,
        "far.obj",
        &["far.obj:", "collapse in single precision"],
    );
}

#[test]
fn a_clamped_reflectance_is_solved_with_a_warning() {
    let folder = Folder::new();
    folder.write("room.obj", ROOM[0]);
    folder.write("room.mtl", ROOM[1].replace("0.5 0.5 0.5", "1 0.5 2"));
    folder
        .line(&format!(
            "solve room.obj --out results --clamp-reflectance --passes 2 {COARSE}"
        ))
        .ends_with(0, "clamped")
        .says(&["warning", "wall"]);
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
}
