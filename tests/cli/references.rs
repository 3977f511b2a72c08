//! `reference` and `error`.

use crate::command::{COARSE, Folder, Outcome, ROOM, write_room};
use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::process::Stdio;

fn reference(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.path(name)).unwrap()).unwrap()
}

/// The room measured and solved.
fn measured_room() -> Folder {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line("reference room.obj --out ref.json --error 0.05")
        .ends_with(0, "reference");
    folder
        .line(&format!("solve room.obj --out solved {COARSE}"))
        .ends_with(0, "solve");
    folder
}

#[test]
fn a_reference_holds_what_the_contract_says() {
    let folder = measured_room();
    let file = reference(&folder, "ref.json");
    let faces = file["faces"].as_array().unwrap();
    assert!(faces.len() >= 7);
    for face in faces {
        assert!(face["area"].as_f64().unwrap() > 0.0);
        assert!(face["side"] == 0 || face["side"] == 1);
        for key in ["B_rgb", "stderr_rgb", "Kd_rgb", "Ke_rgb"] {
            let colour = face[key].as_array().unwrap();
            assert_eq!(colour.len(), 3, "{key}");
            assert!(colour.iter().all(|x| x.as_f64().unwrap() >= 0.0), "{key}");
        }
    }
    let wall = &faces[0];
    assert_eq!(
        (&wall["face_index"], &wall["area"]),
        (&json!(0), &json!(4.0))
    );
    let (b, stderr) = (&wall["B_rgb"][0], &wall["stderr_rgb"][0]);
    assert!(b.as_f64().unwrap() > 0.0);
    let relative = stderr.as_f64().unwrap() / b.as_f64().unwrap();
    assert!(relative > 0.0 && relative < 0.1, "{relative}");
    let meta = &file["meta"];
    assert_eq!(meta["scene"], "room.obj");
    for key in ["rays", "seconds", "mean_stderr", "rounds", "threads"] {
        assert!(meta[key].as_f64().unwrap() > 0.0, "{key}");
    }
    for key in ["certilux", "embree", "sides"] {
        assert!(!meta[key].as_str().unwrap().is_empty(), "{key}");
    }
    assert_eq!(
        folder.names("."),
        ["ref.json", "room.mtl", "room.obj", "solved"]
    );
}

#[test]
fn the_same_faces_at_any_number_of_threads() {
    let folder = Folder::new();
    write_room(&folder);
    for threads in ["1", "3"] {
        let line = format!(
            "reference room.obj --out {threads}.json --error 0.1 --faces 3 --seed 7 --sides one --quiet --threads {threads}"
        );
        let run = folder.line(&line);
        run.ends_with(0, &line);
        assert!(run.stdout.is_empty() && run.stderr.is_empty());
    }
    let [one, three] = ["1.json", "3.json"].map(|f| reference(&folder, f));
    assert_eq!(one["faces"], three["faces"]);
    assert_eq!(one["faces"].as_array().unwrap().len(), 3);
    assert_eq!(one["meta"]["rays"], three["meta"]["rays"]);
    assert_eq!(one["meta"]["sides"], "one");
}

#[test]
fn time_is_kept() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line("reference room.obj --out ref.json --error 1e-7 --max-seconds 0.3")
        .ends_with(0, "a second");
    assert_eq!(reference(&folder, "ref.json")["meta"]["reached"], false);
}

#[test]
fn a_solution_is_compared() {
    let folder = measured_room();
    let run = folder.line("error solved ref.json --json error.json");
    run.ends_with(0, "error");
    let figures = reference(&folder, "error.json");
    let rms = figures["relative_rms"].as_f64().unwrap();
    assert!(rms > 0.0 && rms < 0.2, "{rms}");
    assert!(figures["noise"].as_f64().unwrap() > 0.0);
    assert!(
        run.stdout.contains(&format!("{:.4} %", 100.0 * rms)),
        "{}",
        run.stdout
    );
    assert!(run.stdout.contains("bias") && run.stdout.contains("noise"));

    let file = folder.line("error solved/solution.ply ref.json");
    assert_eq!(file.ends_with(0, "file").stdout, run.stdout);
    let line = format!("error solved ref.json --max {}", 1.01 * rms);
    folder.line(&line).ends_with(0, &line);
    let line = format!("error solved ref.json --max {}", 0.99 * rms);
    folder.line(&line).ends_with(1, &line).says(&["above"]);
}

/// How well a reference is known is one figure, whoever prints it.
#[test]
fn a_reference_says_the_noise_that_a_comparison_finds() {
    let folder = Folder::new();
    // Faces of many sizes, some of them dark, in three colours.
    let measured = folder.line("reference builtin:cornell --out ref.json --error 0.2");
    measured.ends_with(0, "reference");
    folder
        .line(&format!("solve builtin:cornell --out solved {COARSE}"))
        .ends_with(0, "solve");
    let compared = folder.line("error solved ref.json --json error.json");
    compared.ends_with(0, "error");
    let figures = reference(&folder, "error.json");
    let meta = &reference(&folder, "ref.json")["meta"];
    for key in ["noise", "bias_noise"] {
        let [measured, compared] = [&meta[key], &figures[key]].map(|x| x.as_f64().unwrap());
        assert!(measured > 0.0, "{key}");
        assert!(
            (measured / compared - 1.0).abs() < 1e-12,
            "{key}: {measured} is not {compared}"
        );
    }
    let percent = |key: &str| 100.0 * meta[key].as_f64().unwrap();
    let says = format!(
        "{:.4} % of RMS error, {:.4} % of bias",
        percent("noise"),
        percent("bias_noise")
    );
    for run in [&measured, &compared] {
        assert!(run.stdout.contains(&says), "{says}: {}", run.stdout);
    }
}

/// Where nothing is reflected there is nothing to be unsure of.
#[test]
fn a_black_room_is_measured_without_noise() {
    let folder = Folder::new();
    write_room(&folder);
    folder.write("room.mtl", ROOM[1].replace("Kd 0.5 0.5 0.5", "Kd 0 0 0"));
    folder
        .line("reference room.obj --out ref.json --error 0.5")
        .ends_with(0, "black");
    assert_eq!(reference(&folder, "ref.json")["meta"]["noise"], 0.0);
}

/// A reference of two faces of the room, written by hand.
fn by_hand(material: bool) -> Value {
    let mut faces = json!([
        { "face_index": 0, "area": 4.0, "B_rgb": [1, 2, 3], "stderr_rgb": [0, 0, 0] },
        { "face_index": 5, "side": 0, "area": 4.0, "B_rgb": [2, 2, 2], "stderr_rgb": [0.1, 0.1, 0.1] },
        { "face_index": 6, "area": 0.25, "B_rgb": [40, 40, 40], "stderr_rgb": [0, 0, 0] },
    ]);
    if material {
        for (i, face) in faces.as_array_mut().unwrap().iter_mut().enumerate() {
            let (kd, ke) = if i == 2 { (0.0, 10.0) } else { (0.5, 0.0) };
            face["Kd_rgb"] = json!([kd, kd, kd]);
            face["Ke_rgb"] = json!([ke, ke, ke]);
        }
    }
    json!({ "faces": faces })
}

#[test]
fn references_of_others_need_the_scene_for_their_materials() {
    let folder = measured_room();
    folder.write("full.json", by_hand(true).to_string());
    folder.write("bare.json", by_hand(false).to_string());
    let full = folder.line("error solved full.json");
    full.ends_with(0, "full");
    assert!(
        full.stdout.contains(" 2 faces"),
        "the lamp reflects nothing: {}",
        full.stdout
    );
    folder
        .line("error solved bare.json")
        .ends_with(2, "bare")
        .says(&["face 0", "--scene"]);
    let bare = folder.line("error solved bare.json --scene room.obj");
    assert_eq!(bare.ends_with(0, "bare").stdout, full.stdout);
}

/// A reference of another scene is told by the areas of its faces.
#[test]
fn faces_of_another_size_are_named() {
    let folder = measured_room();
    let mut file = by_hand(true);
    // Another program's digits.
    file["faces"][0]["area"] = json!(4.0001);
    folder.write("ref.json", file.to_string());
    let run = folder.line("error solved ref.json");
    run.ends_with(0, "the same scene");
    assert_eq!(run.stderr, "");
    file["faces"][1]["area"] = json!(4.4);
    folder.write("ref.json", file.to_string());
    folder
        .line("error solved ref.json")
        .ends_with(0, "another scene")
        .says(&["1 of 2 faces have another area", "same scene? 5"]);
}

/// A scene that is not the reference's or the solution's gives figures of neither.
#[test]
fn another_scene_is_refused() {
    let folder = measured_room();
    let brighter = ROOM[1].replace("Ke 10 10 10", "Ke 20 20 20");
    folder.write("other.obj", ROOM[0].replace("room.mtl", "other.mtl"));
    folder.write("other.mtl", brighter);
    let line = "error solved ref.json";
    folder
        .line(&format!("{line} --scene room.obj"))
        .ends_with(0, "its scene");
    folder
        .line(&format!("{line} --scene other.obj"))
        .ends_with(2, "another scene")
        .says(&["--scene", "other.obj", "ref.json", "its content differs"]);
    folder.write("bare.json", by_hand(false).to_string());
    folder
        .line("error solved bare.json --scene other.obj")
        .ends_with(2, "not the solution's")
        .says(&["--scene", "solution.ply"]);
    folder
        .line(&format!("solve other.obj --out others {COARSE}"))
        .ends_with(0, "solve");
    let line = "error others ref.json";
    let words = ["ref.json was measured from another scene"];
    folder.line(line).ends_with(0, "warning").says(&words);
    let run = folder.line(&format!("{line} --max 10"));
    run.ends_with(2, "check").says(&words).says(&["--max"]);
    // A stats.json of other bytes says nothing of them.
    fs::copy(
        folder.path("solved/stats.json"),
        folder.path("others/stats.json"),
    )
    .unwrap();
    let run = folder.line(line);
    assert_eq!(run.ends_with(0, "unknown").stderr, "");
}

/// Read once, a reference may come from a pipe, and still says of which scene it is.
#[cfg(target_os = "linux")]
#[test]
fn a_reference_from_a_pipe_is_known_by_its_scene() {
    let folder = measured_room();
    folder.write("other.obj", ROOM[0].replace("room.mtl", "other.mtl"));
    folder.write("other.mtl", ROOM[1].replace("Ke 10 10 10", "Ke 20 20 20"));
    folder
        .line(&format!("solve other.obj --out others {COARSE}"))
        .ends_with(0, "solve");
    let text = fs::read(folder.path("ref.json")).unwrap();
    let piped = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut run = folder
            .command(&words)
            .stdin(Stdio::piped())
            .spawn()
            .unwrap();
        // Dropped at the end of the line: that is the end of the file.
        run.stdin.take().unwrap().write_all(&text).unwrap();
        Outcome::of(run.wait_with_output().unwrap())
    };
    let own = piped("error solved /dev/stdin --max 10");
    own.ends_with(0, "its own scene");
    assert_eq!(own.stdout, folder.line("error solved ref.json").stdout);
    piped("error others /dev/stdin --max 10")
        .ends_with(2, "another scene")
        .says(&["--max", "was measured from another scene"]);
}

/// What other programs keep in `meta` is their affair.
#[test]
fn meta_may_hold_anything() {
    let folder = measured_room();
    for meta in [
        json!([1]),
        json!("me"),
        json!(null),
        json!({ "scene_hash": 7 }),
        json!({ "scene_hash": null, "scene": "x" }),
    ] {
        let mut file = by_hand(true);
        file["meta"] = meta.clone();
        folder.write("ref.json", file.to_string());
        let run = folder.line("error solved ref.json --max 10");
        assert_eq!(run.ends_with(0, &meta.to_string()).stderr, "");
    }
}

#[test]
fn missing_faces_are_named() {
    let folder = measured_room();
    let mut file = by_hand(true);
    file["faces"][1]["face_index"] = json!(77);
    file["faces"][0]["side"] = json!(1);
    folder.write("ref.json", file.to_string());
    let run = folder.line("error solved ref.json --json error.json");
    run.ends_with(0, "missing")
        .says(&["2 of 2", "0 (back)", "77"]);
    let figures = reference(&folder, "error.json");
    assert_eq!(figures["bias"], -1.0);
}

#[test]
fn invalid_files_are_refused_with_the_reason() {
    let folder = measured_room();
    let with = |change: &dyn Fn(&mut Value)| {
        let mut file = by_hand(true);
        change(&mut file);
        file.to_string()
    };
    for (content, words) in [
        (String::new(), "not a reference"),
        ("{".to_owned(), "not a reference"),
        ("\0\u{1}".to_owned(), "not a reference"),
        ("{\"faces\": []}".to_owned(), "no faces"),
        ("{\"meta\": {}}".to_owned(), "faces"),
        (with(&|f| f["faces"][0]["area"] = json!(0)), "area"),
        (with(&|f| f["faces"][0]["area"] = json!(-1)), "area"),
        (with(&|f| f["faces"][0]["side"] = json!(2)), "side"),
        (
            with(&|f| f["faces"][0]["B_rgb"] = json!([1, 2])),
            "not a reference",
        ),
        (
            with(&|f| f["faces"][0]["B_rgb"] = json!([1, 2, -3])),
            "B_rgb",
        ),
        (
            with(&|f| f["faces"][0]["stderr_rgb"] = json!([null, 0, 0])),
            "not a reference",
        ),
        (with(&|f| f["faces"][1]["face_index"] = json!(0)), "before"),
        (
            with(&|f| f["faces"][1]["face_index"] = json!(-1)),
            "not a reference",
        ),
        (
            by_hand(true).to_string().replacen("4.0", "1e999", 1),
            "not a reference",
        ),
        (
            with(&|f| {
                for face in f["faces"].as_array_mut().unwrap() {
                    face["Kd_rgb"] = json!([0, 0, 0]);
                }
            }),
            "reflectance",
        ),
        (
            with(&|f| {
                for face in f["faces"].as_array_mut().unwrap() {
                    face["B_rgb"] = json!([0, 0, 0]);
                }
            }),
            "no relative error",
        ),
    ] {
        folder.write("bad.json", &content);
        folder
            .line("error solved bad.json")
            .ends_with(2, &content)
            .says(&[words]);
    }
    folder.write("full.json", by_hand(true).to_string());
    for line in [
        "error nowhere full.json",
        "error solved nowhere.json",
        "error solved/stats.json full.json",
        "error solved full.json --max NaN",
        "error solved full.json --max -1",
        "error solved full.json --max inf",
        "error solved full.json --scene nowhere.obj",
    ] {
        let run = folder.line(line);
        run.ends_with(2, line);
        assert!(!run.stderr.is_empty(), "{line}");
    }
}

#[test]
fn settings_out_of_range_write_nothing() {
    let folder = Folder::new();
    write_room(&folder);
    let before = folder.names(".");
    for flags in [
        "--error 0",
        "--error -1",
        "--error NaN",
        "--error inf",
        "--max-seconds 0",
        "--max-seconds -5",
        "--max-seconds NaN",
        "--faces 0",
        "--faces -1",
        "--faces 1.5",
        "--seed -1",
        "--sides both",
        "--threads x",
    ] {
        let line = format!("reference room.obj --out ref.json {flags}");
        folder.line(&line).ends_with(2, &line);
    }
    folder
        .line("reference nowhere.obj --out ref.json")
        .ends_with(2, "no scene");
    folder
        .line("reference room.obj --error 0.5 --out no/such/folder/ref.json")
        .ends_with(3, "no folder")
        .says(&["no/such/folder"]);
    assert_eq!(folder.names("."), before);
}
