//! No result takes the place of what a command reads, or of another of its results.

use crate::command::{COARSE, Folder, write_room};
use std::fs;
use std::path::Path;

/// Every file below a folder with its bytes.
fn content(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => files.extend(content(&path)),
            false => files.push((path.clone(), fs::read(&path).unwrap())),
        }
    }
    files.sort();
    files
}

#[test]
fn what_is_read_is_not_overwritten() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line(&format!("solve room.obj --out s {COARSE}"))
        .ends_with(0, "solve");
    folder
        .line("reference room.obj --out ref.json --error 0.5")
        .ends_with(0, "reference");
    let list = "[[job]]\nscene = \"room.obj\"\n";
    folder.write("batch.json", list);
    // A scene and a texture that are called as results are.
    let [obj, mtl] = ["room.obj", "room.mtl"].map(|f| fs::read(folder.path(f)).unwrap());
    folder.write("view.png", &obj);
    fs::create_dir(folder.path("textured")).unwrap();
    folder.write("textured/a.obj", &obj);
    folder.write(
        "textured/room.mtl",
        [&mtl[..], b"\nmap_Kd view.png\n"].concat(),
    );
    folder.write("textured/view.png", "not looked at");
    let before = content(&folder.path(""));
    for (line, words) in [
        ("report s --out s/stats.json", ["--out", "DIR"]),
        ("report s --out s/solution.ply", ["--out", "DIR"]),
        ("error s ref.json --json ref.json", ["--json", "reference"]),
        (
            "error s ref.json --json ./s/solution.ply",
            ["--json", "solution"],
        ),
        ("occluders room.obj --out room.obj", ["--out", "SCENE"]),
        ("reference room.obj --out room.obj", ["--out", "SCENE"]),
        ("reference s/../room.obj --out room.mtl", ["--out", "SCENE"]),
        ("compare room.obj --csv room.obj", ["--csv", "SCENE"]),
        ("audit room.obj --json room.obj", ["--json", "SCENE"]),
        (
            "error-budget room.obj --reference ref.json --json ref.json",
            ["--json", "--reference"],
        ),
        ("solve view.png --out .", ["--out", "SCENE"]),
        (
            "solve textured/a.obj --out textured",
            ["--out", "textures of SCENE"],
        ),
        (
            "solve textured/a.obj --out textured --no-view",
            ["--out", "textures of SCENE"],
        ),
        (
            "view s --show error --reference view.png --out view.png",
            ["--out", "--reference"],
        ),
        ("batch batch.json --out .", ["--out", "JOBS.toml"]),
        ("compare room.obj --csv x --json x", ["--csv", "--json"]),
        (
            "compare room.obj --json x --markdown s/../x",
            ["--json", "--markdown"],
        ),
        (
            "occluders room.obj --out a.obj --json a.obj",
            ["--out", "--json"],
        ),
    ] {
        let run = folder.line(line);
        run.ends_with(2, line).says(&words).says(&["overwrite"]);
        assert_eq!(run.stdout, "", "{line}");
        assert!(content(&folder.path("")) == before, "{line}");
    }
}

/// What stands where a result goes is replaced, as ever.
#[test]
fn results_are_overwritten() {
    let folder = Folder::new();
    write_room(&folder);
    for _ in 0..2 {
        for line in [
            &format!("solve room.obj --out . {COARSE}"),
            "view . --out view.png --size 32x24",
            "occluders room.obj --out o.obj --json o.json",
            "report . --out report.html",
        ] {
            folder.line(line).ends_with(0, line);
        }
    }
}
