//! `certilux view`: gathering, and what `--show` shows.

use crate::command::{COARSE, Folder, write_room};
use std::fs;

/// A folder with a solved room in `results`.
fn solved() -> Folder {
    let folder = Folder::new();
    write_room(&folder);
    let line = format!("solve room.obj --out results {COARSE}");
    folder.line(&line).ends_with(0, &line);
    folder
}

#[test]
fn everything_can_be_shown() {
    let folder = solved();
    folder
        .line("reference room.obj --out ref.json --error 0.2 --max-seconds 2")
        .ends_with(0, "reference");
    let mut pictures = Vec::new();
    for (show, flags, says) in [
        ("radiance", "", ""),
        ("irradiance", "--gather 4", "irradiance: 0 to "),
        ("irradiance", "--greatest 7", "irradiance: 0 to 7 W/m2"),
        ("error", "--reference ref.json", "relative RMS error"),
        ("mesh", "--gather 4", ""),
        ("clusters", "--clusters 5", "5 clusters"),
        ("clusters", "", " clusters"),
        ("occluders", "", " occluders"),
        ("rays", "", " rays through Embree"),
    ] {
        let line = format!("view results --out x.png --size 400x300 --show {show} {flags}");
        let run = folder.line(&line);
        run.ends_with(0, &line);
        assert!(run.stdout.contains(says), "{line}: {}", run.stdout);
        assert!(!run.stderr.contains("warning"), "{line}: {}", run.stderr);
        let bytes = fs::read(folder.path("x.png")).unwrap();
        assert!(!pictures.contains(&bytes), "{line} shows what another does");
        pictures.push(bytes);
    }
    // The same scale whatever is seen, so that pictures can be compared.
    let quiet = folder.line("--quiet view results --out x.png --size 9x9 --show irradiance");
    quiet.ends_with(0, "quiet");
    assert!(
        quiet.stdout.starts_with("irradiance: 0 to "),
        "the scale is a result: {}",
        quiet.stdout
    );
    let quiet = folder.line("--quiet view results --out x.png --size 9x9");
    assert_eq!(quiet.ends_with(0, "quiet").stdout, "");
}

#[test]
fn rays_are_those_of_the_solve() {
    let folder = solved();
    let run = folder.line("view results --out x.png --size 20x15 --show rays");
    run.ends_with(0, "rays");
    let stats = folder.stats("results");
    let passes = stats["passes"].as_array().unwrap();
    let rays: u64 = passes.iter().map(|p| p["rays"].as_u64().unwrap()).sum();
    let says = format!("{rays} rays through Embree");
    assert!(run.stdout.contains(&says), "{says}: {}", run.stdout);
}

#[test]
fn gathering_does_not_depend_on_threads() {
    let folder = solved();
    for threads in [1, 2, 3] {
        let line = format!(
            "view results --out g{threads}.exr --size 40x30 --gather 7 --threads {threads}"
        );
        folder.line(&line).ends_with(0, &line);
    }
    let file = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(file("g1.exr"), file("g2.exr"));
    assert_eq!(file("g1.exr"), file("g3.exr"));
}

#[test]
fn a_scene_that_is_gone_or_changed_is_named() {
    let folder = solved();
    let view = "view results --out x.png --size 20x15 --show clusters";
    fs::rename(folder.path("room.obj"), folder.path("moved.obj")).unwrap();
    folder
        .line(view)
        .ends_with(2, "gone")
        .says(&["room.obj", "--scene"]);
    let named = format!("{view} --scene moved.obj");
    folder.line(&named).ends_with(0, "moved");
    let text = fs::read_to_string(folder.path("moved.obj")).unwrap();
    folder.write("moved.obj", text.replace("v 1 1 1\n", "v 1 1 1.5\n"));
    folder
        .line(&named)
        .ends_with(2, "changed")
        .says(&["moved.obj", "content differs"]);
    for content in [
        "",
        "[1]",
        "{\"scene\":{\"path\":7}}",
        "{\"scene\":{\"path\":\"builtin:cornell\"}}",
    ] {
        folder.write("results/stats.json", content);
        folder
            .line(view)
            .ends_with(2, content)
            .says(&["stats.json"]);
    }
    fs::remove_file(folder.path("results/stats.json")).unwrap();
    folder.line(view).ends_with(2, "none").says(&["stats.json"]);
    // What needs no scene asks for none.
    folder
        .line("view results --out y.png --size 20x15 --show mesh")
        .ends_with(0, "mesh");
}

#[test]
fn what_cannot_be_shown_is_refused_before_any_work() {
    let folder = Folder::new();
    for (flags, says) in [
        ("--out x.png --show error", "--reference"),
        (
            "--out x.png --show mesh --reference ref.json",
            "--reference",
        ),
        ("--out x.exr --show mesh", ".png"),
        ("--out x.exr --show rays", ".png"),
        ("--out x.png --show clusters --gather 8", "--gather"),
        ("--out x.png --show everything", "possible values"),
        ("--out x.png --gather -1", "--gather"),
        ("--out x.png --gather 70000", "--gather"),
        ("--out x.png --clusters 0", "--clusters"),
        ("--out x.png --greatest 0", "--greatest"),
        ("--out x.png --greatest NaN", "--greatest"),
    ] {
        folder
            .line(&format!("view nowhere {flags}"))
            .ends_with(2, flags)
            .says(&[says]);
    }
}

/// What a flag does for one picture it does not do for another, and then it is said to do nothing.
#[test]
fn flags_that_change_nothing_are_named() {
    let folder = solved();
    folder
        .line("reference room.obj --out ref.json --error 0.2 --max-seconds 2")
        .ends_with(0, "reference");
    let all = [
        ("--exposure", "--exposure 1"),
        ("--greatest", "--greatest 7"),
        ("--flat", "--flat"),
        ("--clusters", "--clusters 5"),
        ("--scene", "--scene room.obj"),
    ];
    // A reference with materials needs no scene, but may be given one.
    for (file, show, used) in [
        ("x.png", "radiance", "--exposure --flat"),
        ("x.exr", "radiance", "--flat"),
        ("x.png", "irradiance", "--greatest --flat"),
        ("x.exr", "irradiance", "--flat"),
        ("x.png", "error --reference ref.json", "--greatest --scene"),
        ("x.png", "mesh", "--exposure --flat"),
        ("x.png", "clusters", "--clusters --scene"),
        ("x.png", "occluders", "--exposure --flat --scene"),
        ("x.png", "rays", "--greatest --scene"),
    ] {
        let line = format!("view results --out {file} --size 40x30 --show {show}");
        let picture = |flags: &str| {
            let run = folder.line(&format!("{line} {flags}"));
            run.ends_with(0, &format!("{line} {flags}"));
            (run.stderr, fs::read(folder.path(file)).unwrap())
        };
        let (quiet, plain) = picture("");
        assert_eq!(quiet, "", "{line}");
        for (name, flag) in all {
            let (says, changed) = picture(flag);
            let is_used = used.split(' ').any(|u| u == name);
            let warning = format!("certilux: warning: {name} is not used: ");
            assert_eq!(
                says.starts_with(&warning),
                !is_used,
                "{line} {flag}: {says}"
            );
            assert_eq!(says.lines().count(), usize::from(!is_used), "{says}");
            assert!(
                is_used || changed == plain,
                "{line} {flag} changes the picture"
            );
        }
    }
}

#[test]
fn an_error_needs_a_reference_of_the_scene() {
    let folder = solved();
    let view = "view results --out x.png --size 20x15 --show error --reference ref.json";
    folder.line(view).ends_with(2, "none").says(&["ref.json"]);
    folder.write("ref.json", "{}");
    folder.line(view).ends_with(2, "empty").says(&["ref.json"]);
    let face =
        "{\"face_index\":0,\"side\":0,\"area\":4.0,\"B_rgb\":[1,1,1],\"stderr_rgb\":[0,0,0]}";
    folder.write("ref.json", format!("{{\"meta\":{{}},\"faces\":[{face}]}}"));
    folder
        .line(view)
        .ends_with(2, "no material")
        .says(&["--scene"]);
    folder
        .line(&format!("{view} --scene room.obj"))
        .ends_with(0, "with the scene");
}
