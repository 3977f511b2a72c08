//! Files that were cut short, or hold something else: refused with their name, or read as far as they are whole, and
//! never a panic.

use crate::command::{COARSE, Folder, ROOM, write_room};
use std::fs;

/// Bytes that are no text.
fn noise(count: usize) -> Vec<u8> {
    (0..count as u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 11) as u8)
        .collect()
}

#[test]
fn scenes_cut_anywhere() {
    let folder = Folder::new();
    let mut ends = [0, 0];
    for (which, name) in ["room.obj", "room.mtl"].into_iter().enumerate() {
        for share in 0..24 {
            write_room(&folder);
            let text = ROOM[which];
            folder.write(name, &text[..text.len() * share / 24]);
            let what = format!("{name} cut to {share} of 24");
            let run = folder.line(&format!(
                "solve room.obj --out out --clamp-reflectance --passes 1 {COARSE}"
            ));
            // Half a file may be a whole scene.
            let code = run.code.unwrap();
            run.ends_with(if code == 0 { 0 } else { 2 }, &what);
            ends[usize::from(code == 2)] += 1;
            assert_eq!(folder.names("out").is_empty(), code == 2, "{what}");
            let _ = fs::remove_dir_all(folder.path("out"));
        }
    }
    assert!(ends.iter().all(|&n| n > 0), "{ends:?}");
}

#[test]
fn every_file_that_is_read_may_be_something_else() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line(&format!("solve room.obj --out solved {COARSE}"))
        .ends_with(0, "solve");
    folder
        .line("reference room.obj --out ref.json --error 0.2 --max-seconds 1")
        .ends_with(0, "reference");
    folder.write("jobs.toml", "[[job]]\nname = \"a\"\nscene = \"room.obj\"\n");
    for (name, line) in [
        ("room.obj", "solve room.obj --out out --no-view"),
        ("room.mtl", "solve room.obj --out out --no-view"),
        ("solved/solution.ply", "view solved --out out.png"),
        ("solved/solution.ply", "error solved ref.json"),
        ("ref.json", "error solved ref.json"),
        ("ref.json", "error-budget room.obj --reference ref.json"),
        (
            "ref.json",
            "sweep room.obj --out out --reference ref.json --quick",
        ),
        ("solved/stats.json", "report solved --out out.html"),
        ("jobs.toml", "batch jobs.toml --out out"),
        ("certilux.toml", "solve room.obj --out out --no-view"),
        ("baseline.json", "bench --check baseline.json"),
    ] {
        let whole = fs::read(folder.path(name)).ok();
        // A library without materials leaves the scene dark.
        let named = match name {
            "room.mtl" => "room.obj",
            _ => name.rsplit('/').next().unwrap(),
        };
        let mut forms = vec![noise(5_000), vec![0; 5_000], b"\x89PNG\r\n\x1a\n".to_vec()];
        if let Some(whole) = whole
            .as_ref()
            .filter(|_| name.starts_with("solved") || name == "ref.json")
        {
            forms.extend([1, 2, 3].map(|quarter| whole[..whole.len() * quarter / 4].to_vec()));
        }
        for (form, bytes) in forms.into_iter().enumerate() {
            folder.write(name, &bytes);
            let what = format!("{line}: {name} in form {form}");
            folder.line(line).ends_with(2, &what).says(&[named]);
            assert!(
                !folder.names(".").iter().any(|n| n.starts_with("out")),
                "{what}"
            );
        }
        match whole {
            Some(whole) => folder.write(name, whole),
            None => fs::remove_file(folder.path(name)).unwrap(),
        }
    }
}
