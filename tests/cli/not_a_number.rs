//! NaN and infinity in every number that a user can write.

use crate::command::{Folder, Outcome, ROOM, write_room};
use std::collections::BTreeSet;

/// What no field takes.
const BAD: [&str; 4] = ["NaN", "inf", "-inf", "1e999"];

/// Every command with what it cannot do without.
const COMMANDS: [(&str, &str); 14] = [
    ("solve", "room.obj --out out"),
    ("batch", "jobs.toml --out out"),
    ("view", "solved --out out.png"),
    ("reference", "room.obj --out out.json"),
    ("error", "solved ref.json"),
    ("generate", "cornell --out out"),
    ("clusters", "room.obj --out out.ply"),
    ("bench", "--check baseline.json"),
    ("compare", "room.obj"),
    ("sweep", "room.obj --out out"),
    ("error-budget", "room.obj --reference ref.json"),
    ("report", "solved --out out.html"),
    ("occluders", "room.obj --out out.obj"),
    ("audit", "room.obj"),
];

/// The flags of a command that take a value which is no file, folder or name, read off its help.
fn flags(folder: &Folder, command: &str) -> BTreeSet<String> {
    let help = folder.run(&[command, "--help"]).stdout;
    help.lines()
        .filter_map(|line| {
            let (flag, value) = line.trim_start().split_once(" <")?;
            let names_a_file = ["DIR", "FILE", "NAME", "SCENE", "REF.json"];
            let is_value = !names_a_file.iter().any(|word| value.starts_with(word));
            (flag.starts_with("--") && is_value).then(|| flag.to_owned())
        })
        .collect()
}

fn nothing_happened(run: &Outcome, folder: &Folder, what: &str, word: &str) {
    run.ends_with(2, what).says(&[word]);
    assert!(
        !folder.names(".").iter().any(|n| n.starts_with("out")),
        "{what} wrote {:?}",
        folder.names(".")
    );
}

#[test]
fn no_flag_takes_one() {
    let folder = Folder::new();
    write_room(&folder);
    let mut tried = 0;
    for (command, rest) in COMMANDS {
        for flag in flags(&folder, command) {
            for bad in BAD {
                let line = format!("{command} {rest} {flag}={bad}");
                nothing_happened(&folder.line(&line), &folder, &line, &flag);
                tried += 1;
            }
        }
    }
    // 14 of solve, as many of four other commands that solve, and those of their own.
    assert!(tried > 300, "{tried}");
}

#[test]
fn no_key_of_the_configuration_takes_one() {
    let folder = Folder::new();
    write_room(&folder);
    for key in flags(&folder, "solve") {
        let key = key.trim_start_matches("--");
        for value in ["nan", "inf", "-inf", "\"NaN\""] {
            folder.write("certilux.toml", format!("[solve]\n{key} = {value}\n"));
            let what = format!("{key} = {value}");
            let run = folder.line("solve room.obj --out out");
            nothing_happened(&run, &folder, &what, &format!("certilux.toml:2: `{key}`"));
        }
    }
    folder.write("certilux.toml", "");
    for (variable, value) in [("CERTILUX_EPSILON", "NaN"), ("CERTILUX_MIN_AREA", "inf")] {
        let mut command = folder.command(&["solve", "room.obj", "--out", "out"]);
        let run = Outcome::of(command.env(variable, value).output().unwrap());
        nothing_happened(&run, &folder, variable, variable);
    }
    folder.write(
        "jobs.toml",
        "[[job]]\nname = \"a\"\nscene = \"room.obj\"\nepsilon = nan\n",
    );
    let run = folder.line("batch jobs.toml --out out");
    nothing_happened(&run, &folder, "a job", "jobs.toml:4");
}

#[test]
fn no_field_of_a_scene_takes_one() {
    let folder = Folder::new();
    write_room(&folder);
    let mut tried = 0;
    for bad in BAD {
        let fields = [
            format!("v {bad} 0 0"),
            format!("v 0 {bad} 0"),
            format!("v 0 0 {bad}"),
            format!("v 0 0 0 {bad}"),
            format!("v 0 0 0 1 {bad} 1"),
            format!("vt {bad}"),
            format!("vt 0 {bad}"),
            format!("vt 0 0 {bad}"),
            format!("vn {bad} 0 1"),
            format!("vn 0 0 {bad}"),
            format!("f 1 2 {bad}"),
            format!("f 1/{bad} 2/1 3/1"),
            format!("f 1//1 2//{bad} 3//1"),
        ];
        for field in fields {
            folder.write("bad.obj", format!("{}{field}\n", ROOM[0]));
            let run = folder.line("solve bad.obj --out out");
            nothing_happened(&run, &folder, &field, "bad.obj:");
            tried += 1;
        }
        for field in [
            format!("Kd {bad} 0 0"),
            format!("Kd 0 0 {bad}"),
            format!("Kd {bad}"),
            format!("Ke {bad} 0 0"),
            format!("Ke 0 {bad} 0"),
            format!("Ka {bad} 0 0"),
            format!("Ks 0 0 {bad}"),
            format!("Tf {bad} 1 1"),
            format!("Ns {bad}"),
            format!("Ni {bad}"),
            format!("d {bad}"),
            format!("Tr {bad}"),
            format!("illum {bad}"),
            format!("map_Kd -s {bad} 1 1 picture.png"),
            format!("map_Ke -o 0 {bad} 0 picture.png"),
            format!("map_Kd -mm {bad} 1 picture.png"),
        ] {
            folder.write("bad.obj", ROOM[0].replace("room.mtl", "bad.mtl"));
            folder.write("bad.mtl", format!("{}{field}\n", ROOM[1]));
            let run = folder.line("solve bad.obj --out out");
            nothing_happened(&run, &folder, &field, "bad.mtl:");
            tried += 1;
        }
    }
    assert_eq!(tried, BAD.len() * (13 + 16));
}
