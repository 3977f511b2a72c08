//! `generate`, `view` and `clusters`.

use crate::command::{Folder, write_room};
use certilux::scene::generate::catalogue;
use std::fs;

#[test]
fn every_scene_of_the_list_is_generated() {
    let folder = Folder::new();
    let list = folder.line("generate --list");
    list.ends_with(0, "list");
    let names: Vec<&str> = (list.stdout.lines())
        .filter_map(|l| l.split_whitespace().next())
        .collect();
    assert_eq!(names.len(), catalogue().len());
    for name in ["cornell", "furnace", "sealed", "two-rooms"] {
        assert!(names.contains(&name), "{name}");
        let line = format!("generate {name} --out scenes");
        folder.line(&line).ends_with(0, &line);
        for ending in ["obj", "mtl"] {
            let path = folder.path("scenes").join(format!("{name}.{ending}"));
            assert!(fs::metadata(path).unwrap().len() > 0);
        }
    }
}

/// Width and height of a PNG, from its first chunk.
fn png_size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[12..16], b"IHDR");
    [16, 20].map(|i| u32::from_be_bytes(bytes[i..i + 4].try_into().unwrap()))
}

#[test]
fn pictures_of_a_solved_folder() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line("solve room.obj --out results --no-view --epsilon 1e-3")
        .ends_with(0, "solve");
    for (name, flags) in [
        ("a.png", ""),
        ("b.PNG", "--flat"),
        ("c.exr", ""),
        (
            "d.png",
            "--eye -0.9,-0.9,-0.9 --target 0.5,0.5,0.5 --up 0,0,1 --fov 90",
        ),
        ("e.png", "--exposure -2 --camera auto"),
        ("f.png", "--exposure 2"),
    ] {
        let line = format!("view results --out {name} --size 40x30 {flags}");
        folder.line(&line).ends_with(0, &line);
        let bytes = fs::read(folder.path(name)).unwrap();
        if name.ends_with("exr") {
            assert_eq!(bytes[..4], 20_000_630u32.to_le_bytes());
        } else {
            assert_eq!(png_size(&bytes), [40, 30]);
        }
    }
    let file = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_ne!(file("e.png"), file("f.png"), "the exposure has no effect");
    assert_ne!(file("a.png"), file("d.png"), "the camera has no effect");

    let before = folder.names(".");
    for flags in [
        "--out x.jpg",
        "--out x",
        "--out png",
        "--out x.png --size 0x10",
        "--out x.png --size 10",
        "--out x.png --size -1x5",
        "--out x.png --size 99999x99999",
        "--out x.png --fov 0",
        "--out x.png --fov 180",
        "--out x.png --fov NaN",
        "--out x.png --fov -30",
        "--out x.png --exposure NaN",
        "--out x.png --exposure inf",
        "--out x.png --eye 1,2",
        "--out x.png --eye 1,2,NaN",
        "--out x.png --eye 0,0,0 --target 0,0,0",
        "--out x.png --eye 1e300,0,0",
        "--out x.png --up 0,0,0",
        "--out x.png --camera upside-down",
    ] {
        let line = format!("view results {flags}");
        let run = folder.line(&line);
        run.ends_with(2, &line);
        assert!(!run.stderr.is_empty(), "{line}");
    }
    assert_eq!(folder.names("."), before);
}

#[test]
fn a_folder_without_a_solution_is_invalid_input() {
    let folder = Folder::new();
    fs::create_dir(folder.path("results")).unwrap();
    for content in [None, Some("ply\n"), Some("\0\0\0\0"), Some("")] {
        if let Some(content) = content {
            folder.write("results/solution.ply", content);
        }
        folder
            .line("view results --out x.png")
            .ends_with(2, "no solution")
            .says(&["solution.ply"]);
    }
    folder
        .line("view nowhere --out x.png")
        .ends_with(2, "no folder")
        .says(&["nowhere"]);
}

#[test]
fn clusters_are_written_as_a_mesh() {
    let folder = Folder::new();
    for count in [1, 8, 4_000_000_000u32] {
        let line = format!("clusters builtin:cornell --out c{count}.ply --count {count}");
        folder.line(&line).ends_with(0, &line);
        let bytes = fs::read(folder.path(format!("c{count}.ply"))).unwrap();
        assert!(bytes.starts_with(b"ply\n"));
    }
    folder
        .line("clusters builtin:cornell --out no/such/folder/c.ply")
        .ends_with(3, "no folder")
        .says(&["no/such/folder"]);
}
