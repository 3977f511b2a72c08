//! OBJ files kept by expected outcome: what is valid loads as it should, what is invalid is refused
//! with every defect at its line.

use certilux::scene::{Defect, LoadConfig, LoadError, Reason, Scene, load_file, load_text};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn folder(outcome: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/obj")
        .join(outcome)
}

fn load_valid(name: &str) -> Scene {
    load_file(&folder("valid").join(name), &LoadConfig::default()).unwrap()
}

/// File (without its folder), line and reason of every defect.
type Findings = Vec<(String, Option<usize>, Reason)>;

fn refuse(name: &str) -> Findings {
    let error = load_file(&folder("invalid").join(name), &LoadConfig::default());
    let Err(LoadError { defects, .. }) = error else {
        panic!("{name} was taken");
    };
    let split = |d: Defect| {
        let file = Path::new(&d.file).file_name().unwrap();
        (file.to_str().unwrap().to_owned(), d.line, d.reason)
    };
    defects.into_iter().map(split).collect()
}

fn not_finite(text: &str) -> Reason {
    Reason::NotFinite(text.into())
}

fn not_a_number(text: &str) -> Reason {
    Reason::NotANumber(text.into())
}

fn bad_corner(text: &str) -> Reason {
    Reason::BadCorner(text.into())
}

fn arity(keyword: &str, expected: &'static str, found: usize) -> Reason {
    Reason::Arity {
        keyword: keyword.into(),
        expected,
        found,
    }
}

fn index(kind: &'static str, index: i64, count: usize) -> Reason {
    Reason::IndexOutOfRange { kind, index, count }
}

fn missing_name(keyword: &str) -> Reason {
    Reason::MissingName(keyword.into())
}

fn no_emitter(names_library: bool, missing: &[&str]) -> Reason {
    Reason::NoEmitter {
        names_library,
        missing_libraries: missing.iter().map(|&m| m.into()).collect(),
    }
}

/// An invalid file, its own defects, and those of the files that it names.
type Case = (
    &'static str,
    Vec<(usize, Reason)>,
    Vec<(&'static str, usize, Reason)>,
);

/// Every invalid file with all its defects: those of the OBJ file first, then those of others.
fn expectations() -> Vec<Case> {
    const VERTEX: &str = "3 coordinates (and a weight or a colour)";
    const CORNERS: &str = "at least 3 corners";
    // Line 0 stands for a defect of the whole file.
    let obj = |name, defects| (name, defects, vec![]);
    vec![
        obj("empty.obj", vec![(0, Reason::Empty)]),
        obj("only_comments.obj", vec![(0, Reason::Empty)]),
        obj("no_faces.obj", vec![(0, Reason::NoFaces)]),
        obj(
            "prose.obj",
            vec![(0, Reason::NotObj("none of its lines is an OBJ statement"))],
        ),
        obj("image.obj", vec![(0, Reason::NotObj("it is a PNG image"))]),
        obj(
            "mesh_ply.obj",
            vec![(0, Reason::NotObj("it is a PLY mesh"))],
        ),
        obj(
            "binary.obj",
            vec![(0, Reason::NotObj("it has binary content (a NUL byte)"))],
        ),
        obj(
            "utf16.obj",
            vec![(0, Reason::NotObj("it is UTF-16 text; save it as UTF-8"))],
        ),
        obj(
            "nan_vertex.obj",
            vec![
                (6, not_finite("nan")),
                (7, not_finite("-inf")),
                (7, not_finite("1e999")),
                (8, not_finite("-nan(ind)")),
            ],
        ),
        obj(
            "not_numbers.obj",
            vec![
                (6, not_a_number("1,5")),
                (7, not_a_number("x")),
                (8, not_a_number("1.0f")),
            ],
        ),
        obj("infinite_normal.obj", vec![(6, not_finite("inf"))]),
        obj(
            "vertex_arity.obj",
            vec![
                (6, arity("v", VERTEX, 2)),
                (7, arity("v", VERTEX, 0)),
                (8, arity("v", VERTEX, 5)),
                (9, arity("vt", "1 to 3 coordinates", 0)),
                (10, arity("vn", "3 coordinates", 2)),
            ],
        ),
        obj("zero_weight.obj", vec![(6, Reason::ZeroWeight)]),
        obj(
            "overflowing_weight.obj",
            vec![(6, not_finite(&format!("{}/{}", 1e300, 1e-300)))],
        ),
        obj(
            "index_too_high.obj",
            vec![
                (6, index("vertex", 4, 3)),
                (8, index("texture coordinate", 1, 0)),
                (8, index("texture coordinate", 1, 0)),
                (8, index("texture coordinate", 1, 0)),
                (9, index("normal", 2, 0)),
                (9, index("normal", 2, 0)),
                (9, index("normal", 2, 0)),
            ],
        ),
        obj("index_zero.obj", vec![(6, index("vertex", 0, 3))]),
        obj(
            "index_too_low.obj",
            vec![
                (6, index("vertex", -4, 3)),
                (8, index("texture coordinate", -2, 1)),
            ],
        ),
        obj(
            "corner_syntax.obj",
            vec![
                (6, bad_corner("x")),
                (7, bad_corner("1/2/3/4")),
                (8, bad_corner("/")),
                (9, bad_corner("1.5")),
                (10, bad_corner("99999999999999999999")),
            ],
        ),
        obj(
            "face_arity.obj",
            vec![
                (6, arity("f", CORNERS, 2)),
                (7, arity("f", CORNERS, 1)),
                (8, arity("f", CORNERS, 0)),
            ],
        ),
        obj(
            "missing_names.obj",
            vec![(1, missing_name("mtllib")), (2, missing_name("usemtl"))],
        ),
        obj("no_library.obj", vec![(0, no_emitter(false, &[]))]),
        obj("no_emitter.obj", vec![(0, no_emitter(true, &[]))]),
        obj(
            "missing_library.obj",
            vec![(0, no_emitter(true, &["nowhere.mtl"]))],
        ),
        obj(
            "emitter_without_area.obj",
            vec![(0, Reason::EmittersDropped(1))],
        ),
        obj("no_area.obj", vec![(0, Reason::NoArea(2))]),
        obj("one_point.obj", vec![(0, Reason::NoArea(1))]),
        obj(
            "far_vertex.obj",
            vec![(
                8,
                Reason::Collapsed {
                    span: 2f64.powi(40),
                    faces: 3,
                    total: 4,
                    farthest: [0.0, 1e12, 0.0],
                },
            )],
        ),
        obj("absurd_span.obj", vec![(0, Reason::SpanOutOfRange(1e200))]),
        (
            "materials.obj",
            vec![],
            vec![
                ("materials.mtl", 1, Reason::NoMaterialYet("Kd".into())),
                ("materials.mtl", 8, not_finite("nan")),
                ("materials.mtl", 9, not_a_number("x")),
                ("materials.mtl", 10, arity("Ke", "1 or 3 numbers", 2)),
                ("materials.mtl", 11, arity("Ke", "1 or 3 numbers", 0)),
                ("materials.mtl", 12, missing_name("newmtl")),
                (
                    "materials.mtl",
                    16,
                    Reason::UnsupportedColour("Kd spectral".into()),
                ),
                ("materials.mtl", 17, missing_name("map_Kd")),
                ("materials.mtl", 18, not_finite("inf")),
                ("materials.mtl", 19, not_finite("inf")),
                (
                    "materials.mtl",
                    3,
                    Reason::ReflectanceTooHigh {
                        material: "mirror".into(),
                        value: [0.5, 1.0, 0.5],
                        texture: None,
                    },
                ),
                (
                    "materials.mtl",
                    5,
                    Reason::Negative {
                        material: "black light".into(),
                        keyword: "Kd",
                        value: [-0.1, 0.0, 0.0],
                    },
                ),
                (
                    "materials.mtl",
                    6,
                    Reason::Negative {
                        material: "black light".into(),
                        keyword: "Ke",
                        value: [0.0, -1.0, 0.0],
                    },
                ),
            ],
        ),
        (
            "everything_at_once.obj",
            vec![
                (3, not_finite("nan")),
                (6, index("vertex", 9, 3)),
                (8, arity("f", CORNERS, 2)),
                (0, no_emitter(true, &[])),
            ],
            vec![("white.mtl", 2, too_white())],
        ),
        (
            "reflectance.obj",
            vec![],
            vec![("white.mtl", 2, too_white())],
        ),
    ]
}

fn too_white() -> Reason {
    Reason::ReflectanceTooHigh {
        material: "white".into(),
        value: [1.0; 3],
        texture: None,
    }
}

#[test]
fn invalid_files_are_refused_with_every_defect() {
    let expectations = expectations();
    for (name, own, others) in &expectations {
        let line = |line: usize| (line > 0).then_some(line);
        let own = own
            .iter()
            .map(|(l, r)| ((*name).to_owned(), line(*l), r.clone()));
        let others = others
            .iter()
            .map(|(f, l, r)| ((*f).to_owned(), line(*l), r.clone()));
        let expected: Findings = own.chain(others).collect();
        let mut found = refuse(name);
        // The order between files is of no account.
        found.sort_by_key(|(file, ..)| file != name);
        assert_eq!(found, expected, "{name}");
    }
    let listed: BTreeSet<String> = expectations.iter().map(|e| e.0.to_owned()).collect();
    let present: BTreeSet<String> = std::fs::read_dir(folder("invalid"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".obj"))
        .collect();
    assert_eq!(listed, present);
}

#[test]
fn messages_say_where_and_what_to_do() {
    let text = |name: &str| {
        let path = folder("invalid").join(name);
        let folder = format!("{}/", folder("invalid").display());
        let error = load_file(&path, &LoadConfig::default()).unwrap_err();
        error.to_string().replace(&folder, "")
    };
    assert_eq!(
        text("index_too_high.obj").lines().next().unwrap(),
        "index_too_high.obj:6: vertex index 4 is out of range: 1 to 3 and -1 to -3 are valid there"
    );
    assert_eq!(
        text("reflectance.obj"),
        "white.mtl:2: material `white`: Kd 1 1 1 reflects all light or more; every channel must be \
         below 1 (change it, or pass --clamp-reflectance to go on with 0.999)"
    );
    assert_eq!(
        text("missing_library.obj"),
        "missing_library.obj: nothing emits light (the material library nowhere.mtl could not be \
         read): give the material of at least one face an emitted radiance, for example \
         `Ke 10 10 10`, in the MTL file"
    );
    assert_eq!(
        text("no_library.obj"),
        "no_library.obj: nothing emits light (the file names no material library, as `mtllib NAME.mtl` would): give the \
         material of at least one face an emitted radiance, for example `Ke 10 10 10`, in the MTL file"
    );
    assert!(text("everything_at_once.obj").lines().count() == 5);
}

#[test]
fn what_is_no_file_is_refused() {
    let reason = |path: &Path| {
        let error = load_file(path, &LoadConfig::default()).unwrap_err();
        assert_eq!(error.defects.len(), 1);
        error.defects[0].reason.clone()
    };
    assert_eq!(
        reason(&folder("invalid").join("nowhere.obj")),
        Reason::Missing
    );
    assert_eq!(reason(&folder("invalid")), Reason::Directory);
    assert!(matches!(
        reason(&folder("invalid").join("empty.obj/below.obj")),
        Reason::Unreadable(_)
    ));
}

#[test]
fn a_reflectance_of_one_can_be_clamped() {
    let mut config = LoadConfig::default();
    config.clamp_reflectance = true;
    let scene = load_file(&folder("invalid").join("reflectance.obj"), &config).unwrap();
    assert_eq!(scene.surfaces[0].reflectance, [0.999; 3]);
    assert_eq!(scene.warnings.len(), 1);
    assert!(
        scene.warnings[0]
            .0
            .ends_with("white.mtl:2: material `white`: Kd 1 1 1 is clamped to 0.999")
    );
}

/// Area in the file's units.
fn area(scene: &Scene) -> f64 {
    let normalised: f64 = (0..scene.polygons.len())
        .map(|i| {
            let [a, b, c] = scene.polygons[i]
                .vertices
                .map(|v| scene.source_positions[v as usize]);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    normalised
}

#[test]
fn valid_files_load() {
    let mut names = BTreeSet::new();
    // Name, faces, polygons, dropped, area, warnings.
    for (name, faces, polygons, dropped, expected_area, warnings) in [
        ("triangle.obj", 1, 1, vec![], 0.5, 0),
        ("windows.obj", 1, 2, vec![], 1.0, 0),
        ("latin1.obj", 2, 2, vec![], 1.0, 1),
        ("old_macintosh.obj", 1, 1, vec![], 0.5, 0),
        ("forward_reference.obj", 1, 1, vec![], 0.5, 0),
        ("corner_forms.obj", 4, 4, vec![], 1.5 + 0.75f64.sqrt(), 0),
        ("comb.obj", 1, 10, vec![], 11.0, 0),
        // Kept: a square, its back, and a triangle with a corner given twice. Dropped: faces on a
        // line or with two corners in one place, and the square again from another corner.
        ("dropped.obj", 8, 5, vec![1, 2, 4, 6, 7], 2.5, 2),
        ("unknown_material.obj", 3, 3, vec![], 1.5, 3),
        ("translucent.obj", 2, 2, vec![], 1.0, 6),
        ("slivers.obj", 3, 3, vec![], 0.5 + 0.5e-6 + 1e-7, 0),
    ] {
        let scene = load_valid(name);
        assert_eq!(scene.source_faces, faces, "{name}");
        assert_eq!(
            scene.polygons.len(),
            polygons,
            "{name}: {:?}",
            scene.polygons
        );
        assert_eq!(scene.dropped_faces, dropped, "{name}");
        assert!(
            (area(&scene) - expected_area).abs() < 1e-9,
            "{name}: {}",
            area(&scene)
        );
        assert_eq!(
            scene.warnings.len(),
            warnings,
            "{name}: {:#?}",
            scene.warnings
        );
        assert_eq!(scene.positions.len(), scene.source_positions.len());
        names.insert(name.to_owned());
    }
    let present: BTreeSet<String> = std::fs::read_dir(folder("valid"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".obj"))
        .collect();
    assert_eq!(names, present);
}

#[test]
fn ignored_properties_are_named_once_a_kind() {
    let warnings: Vec<String> = load_valid("translucent.obj")
        .warnings
        .into_iter()
        .map(|w| w.0)
        .collect();
    let count = |what: &str| warnings.iter().filter(|w| w.contains(what)).count();
    for what in [
        "transparency",
        "specular",
        "transmission",
        "relief",
        "metallic",
        "missing.png",
    ] {
        assert_eq!(count(what), 1, "{what}: {warnings:#?}");
    }
    assert_eq!(count("2 materials, the first is `glass`"), 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the bytes, there is an answer; and what is accepted keeps the scene's promises.
    #[test]
    fn no_text_makes_the_loader_panic(
        obj in prop::collection::vec(statement(), 0..40),
        mtl in prop::collection::vec(material_statement(), 0..12),
        clamp_reflectance in any::<bool>(),
    ) {
        let (obj, mtl) = (obj.concat(), mtl.concat());
        let files: [(&str, &[u8]); 1] = [("m.mtl", &mtl)];
        let mut config = LoadConfig::default();
        config.clamp_reflectance = clamp_reflectance;
        if let Ok(scene) = load_text("fuzz", &obj, &files, &config) {
            for i in 0..scene.polygons.len() {
                let [a, b, c] = scene.corners(certilux::math::PolygonId::new(i));
                prop_assert!(a != b && b != c && c != a);
                prop_assert!([a, b, c].iter().all(|p| p.abs().max_element() <= 0.5));
                prop_assert!(scene.polygon_area(certilux::math::PolygonId::new(i)) > 0.0);
                prop_assert!(scene.polygons[i].source_face < scene.source_faces);
            }
            prop_assert!(scene.surfaces.iter().any(|s| s.emission != [0.0; 3]));
            for s in &scene.surfaces {
                prop_assert!(s.reflectance.iter().all(|c| (0.0..1.0).contains(c)));
                prop_assert!(s.emission.iter().all(|c| c.is_finite() && *c >= 0.0));
            }
        }
    }

    #[test]
    fn no_bytes_make_the_loader_panic(obj in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = load_text("fuzz", &obj, &[("m.mtl", &obj)], &LoadConfig::default());
    }
}

fn statement() -> impl Strategy<Value = Vec<u8>> {
    let number = prop_oneof![
        8 => (-3..4i32).prop_map(|n| n.to_string()),
        2 => (-1e3..1e3f64).prop_map(|x| x.to_string()),
        1 => any::<f64>().prop_map(|x| x.to_string()),
    ];
    let corner = prop_oneof![
        12 => (1..9i32).prop_map(|n| n.to_string()),
        2 => (-9..0i32).prop_map(|n| n.to_string()),
        2 => (1..6i32, 1..4i32).prop_map(|(v, t)| format!("{v}/{t}")),
        1 => "[0-9/-]{0,6}",
    ];
    let words =
        |word, count| prop::collection::vec(word, count).prop_map(|w: Vec<String>| w.join(" "));
    let line =
        |keyword: &'static str| move |rest: String| format!("{keyword} {rest}\n").into_bytes();
    prop_oneof![
        10 => words(number.clone().boxed(), 3..4).prop_map(line("v")),
        2 => words(number.clone().boxed(), 2..3).prop_map(line("vt")),
        10 => words(corner.clone().boxed(), 3..7).prop_map(line("f")),
        1 => words(corner.boxed(), 0..4).prop_map(line("f")),
        1 => words(number.boxed(), 0..8).prop_map(line("v")),
        4 => "[ab]".prop_map(line("usemtl")),
        1 => Just(b"mtllib m.mtl\n".to_vec()),
        1 => prop::collection::vec(any::<u8>(), 0..12),
    ]
}

fn material_statement() -> impl Strategy<Value = Vec<u8>> {
    let text = prop_oneof![
        "newmtl [ab]\n",
        "K[de] 0\\.[0-9] 0\\.[0-9] 0\\.[0-9]\n",
        "K[de] [0-9.e-]{1,4}\n",
        "(d|Tr|Ks|map_Kd|map_Ke) [a-z0-9. -]{0,9}\n",
    ];
    text.prop_map(String::into_bytes)
}
