//! Odd but legal scenes: the program ends with 0 and finite numbers.

use crate::command::{COARSE, Folder, ROOM, write_room};
use certilux::output::read_ply;
use std::fmt::Write;
use std::fs;

/// Solves `name` coarsely; checks that every number is finite and that nothing is negative.
#[track_caller]
fn solves(folder: &Folder, name: &str) {
    let mut arguments = vec!["solve", name, "--out", "results"];
    arguments.extend(COARSE.split_whitespace());
    folder.run(&arguments).ends_with(0, name);
    let stats = folder.stats("results");
    let power = |key: &str| stats["power"][key].as_f64().unwrap();
    assert!(power("emitted") > 0.0, "{name}");
    assert!(
        power("absorbed") >= 0.0 && power("escaped") >= 0.0,
        "{name}"
    );
    // Reading refuses what is not finite.
    let mesh = read_ply(&folder.path("results/solution.ply")).unwrap();
    assert!(!mesh.faces.is_empty(), "{name}");
    for face in &mesh.faces {
        let light = face.radiosity.iter().chain(&face.irradiance);
        assert!(light.copied().all(|x| x >= 0.0), "{name}: {face:?}");
    }
    fs::remove_dir_all(folder.path("results")).unwrap();
}

/// The room's vertices through `map`.
fn mapped(map: impl Fn(f64) -> f64) -> String {
    let mut text = String::new();
    for line in ROOM[0].lines() {
        match line.strip_prefix("v ") {
            Some(rest) => {
                text.push('v');
                for word in rest.split_whitespace() {
                    write!(text, " {:?}", map(word.parse().unwrap())).unwrap();
                }
            }
            None => text.push_str(line),
        }
        text.push('\n');
    }
    text
}

#[test]
fn sizes_and_places() {
    let folder = Folder::new();
    write_room(&folder);
    for exponent in [-60, -20, -6, 6, 20, 59] {
        let name = format!("scale{exponent}.obj");
        folder.write(&name, mapped(|x| x * 10f64.powi(exponent)));
        solves(&folder, &name);
    }
    for distance in [1e3, 1e6, -1e9] {
        let name = format!("at{distance}.obj");
        folder.write(&name, mapped(|x| x + distance));
        solves(&folder, &name);
    }
}

#[test]
fn brightness() {
    let folder = Folder::new();
    folder.write("room.obj", ROOM[0]);
    for ke in ["1e30 1e30 1e30", "1e-30 1e-30 1e-30", "0 0 1e-3"] {
        folder.write("room.mtl", ROOM[1].replace("10 10 10", ke));
        solves(&folder, "room.obj");
    }
    folder.write("room.mtl", ROOM[1].replace("0.5 0.5 0.5", "0 0 0"));
    solves(&folder, "room.obj");
}

#[test]
fn few_faces() {
    let folder = Folder::new();
    write_room(&folder);
    let lamp = "mtllib room.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("one.obj", lamp);
    solves(&folder, "one.obj");
    folder.write("back_to_back.obj", format!("{lamp}usemtl wall\nf 3 2 1\n"));
    solves(&folder, "back_to_back.obj");
    let far = format!("{lamp}v 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl wall\nf 6 5 4\n");
    folder.write("two.obj", far);
    solves(&folder, "two.obj");
}

#[test]
fn surfaces_that_overlap_touch_and_degenerate() {
    let folder = Folder::new();
    write_room(&folder);
    // The floor again, turned, moved by a rounding error, and cut otherwise.
    for (name, extra) in [
        ("again", "f 2 3 4 1\n"),
        ("turned", "f 4 3 2 1\n"),
        (
            "near",
            "v -1 -1 -0.99999999\nv 1 -1 -1\nv 1 1 -0.99999999\nf 13 14 15\n",
        ),
        (
            "inside",
            "v -0.5 -0.5 -1\nv 0.5 -0.5 -1\nv 0 0.5 -1\nf 13 14 15\n",
        ),
        (
            "sliver",
            "v -1 0 0\nv 1 1e-9 0\nv 1 -1e-9 0\nf 13 14 15\nv 0 0 0\nv 0.5 0.5 1e-7\nf 13 16 17\n",
        ),
        ("crossing", "f 1 2 7 8\nf 4 3 6 5\n"),
    ] {
        let name = format!("{name}.obj");
        let obj = ROOM[0].replace("usemtl lamp", "usemtl lamp_later");
        let obj = format!("{obj}usemtl wall\n{extra}").replace("lamp_later", "lamp");
        folder.write(&name, obj);
        solves(&folder, &name);
    }
}

/// One plane of many squares and a lamp over it.
#[test]
fn a_finely_cut_plane() {
    let folder = Folder::new();
    write_room(&folder);
    const SIDE: usize = 100;
    let mut obj = String::from("mtllib room.mtl\nusemtl wall\n");
    for y in 0..=SIDE {
        for x in 0..=SIDE {
            writeln!(obj, "v {x} {y} 0").unwrap();
        }
    }
    for y in 0..SIDE {
        for x in 0..SIDE {
            let a = y * (SIDE + 1) + x + 1;
            let b = a + SIDE + 1;
            writeln!(obj, "f {a} {} {} {b}", a + 1, b + 1).unwrap();
        }
    }
    obj.push_str("v 40 40 30\nv 60 40 30\nv 60 60 30\nv 40 60 30\nusemtl lamp\nf -1 -2 -3 -4\n");
    folder.write("plane.obj", obj);
    solves(&folder, "plane.obj");
}

#[test]
fn ways_of_writing_a_file() {
    let folder = Folder::new();
    write_room(&folder);
    let solution = |folder: &Folder, name: &str| {
        let mut arguments = vec!["solve", name, "--out", "results"];
        arguments.extend(COARSE.split_whitespace());
        folder.run(&arguments).ends_with(0, name);
        fs::read(folder.path("results/solution.ply")).unwrap()
    };
    let plain = solution(&folder, "room.obj");
    for (name, text) in [
        ("windows.obj", ROOM[0].replace('\n', "\r\n")),
        ("unended.obj", ROOM[0].trim_end().to_owned()),
        ("tabs.obj", ROOM[0].replace(' ', " \t ")),
        ("mark.obj", format!("\u{feff}{}", ROOM[0])),
        ("Zimmer für zwei 部屋.obj", ROOM[0].to_owned()),
    ] {
        folder.write(name, text);
        assert!(solution(&folder, name) == plain, "{name}");
    }
    folder.write("Wände 壁.mtl", ROOM[1].replace("wall", "weiße Wand"));
    let named = ROOM[0]
        .replace("room.mtl", "Wände 壁.mtl")
        .replace("usemtl wall", "usemtl weiße Wand");
    folder.write("named.obj", named);
    assert!(solution(&folder, "named.obj") == plain, "named.obj");

    fs::create_dir(folder.path("a folder")).unwrap();
    folder.write("a folder/room.obj", ROOM[0]);
    folder.write("a folder/room.mtl", ROOM[1]);
    assert!(solution(&folder, "a folder/room.obj") == plain);
}

#[test]
fn textures_that_are_not_there_or_not_pictures() {
    let folder = Folder::new();
    folder.write("room.obj", ROOM[0]);
    folder.write("broken.png", "no picture");
    for map in ["map_Kd missing.png", "map_Kd broken.png", "map_Kd ."] {
        let mtl = ROOM[1].replace("newmtl lamp", &format!("{map}\nnewmtl lamp"));
        folder.write("room.mtl", mtl);
        let run = folder.line(&format!("solve room.obj --out results {COARSE}"));
        run.ends_with(0, map).says(&["warning"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_in_no_known_encoding() {
    use std::os::unix::ffi::OsStringExt;
    let folder = Folder::new();
    write_room(&folder);
    let name = std::ffi::OsString::from_vec(b"r\xe4ume.obj".to_vec());
    fs::copy(folder.path("room.obj"), folder.path(&name)).unwrap();
    let mut arguments: Vec<std::ffi::OsString> =
        ["solve", "--out", "results"].map(Into::into).to_vec();
    arguments.extend(COARSE.split_whitespace().map(Into::into));
    arguments.push(name);
    folder.run(&arguments).ends_with(0, "a Latin-1 name");
    assert!(folder.stats("results")["power"]["emitted"].as_f64() > Some(0.0));
}

#[test]
fn leaves_count_the_black_faces() {
    let folder = Folder::new();
    write_room(&folder);
    // A small sealed box beside the room, seen from inside only: no light reaches any of its fronts.
    let inside = ROOM[0].replace("usemtl lamp", "usemtl wall");
    let mut obj = ROOM[0].to_owned();
    let vertices = ROOM[0].lines().filter(|l| l.starts_with("v ")).count();
    for line in inside.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                writeln!(obj, "v {} {} {}", c[0] + 9.0, c[1], c[2]).unwrap();
            }
            Some("f") => {
                let corners: Vec<usize> = words.map(|w| w.parse().unwrap()).collect();
                let shifted: Vec<String> =
                    corners.iter().map(|c| (c + vertices).to_string()).collect();
                writeln!(obj, "f {}", shifted.join(" ")).unwrap();
            }
            Some("usemtl") => writeln!(obj, "{line}").unwrap(),
            _ => {}
        }
    }
    folder.write("room.obj", obj);
    folder
        .line(&format!("solve room.obj --out results {COARSE}"))
        .ends_with(0, "a dark box");
    let mesh = read_ply(&folder.path("results/solution.ply")).unwrap();
    let leaves = folder.stats("results")["hierarchy"]["leaves"].as_u64();
    assert_eq!(leaves, Some(mesh.faces.len() as u64));
    assert!(mesh.faces.iter().any(|f| f.irradiance == [0.0; 3]));
}
