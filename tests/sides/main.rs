//! Which sides exist: closed and open rooms of known answer, and what finding out costs.

use certilux::embree::{CommittedScene, Device, DeviceConfig};
use certilux::scene::{Facet, LoadConfig, Scene, Side, SidesMode, load_text, resolve_sides};
use glam::DVec3;
use std::fmt::Write;

/// An OBJ file under construction.
#[derive(Default)]
struct Mesh {
    text: String,
    vertices: usize,
}

impl Mesh {
    /// A parallelogram of `n` x `n` squares, front towards `u x v`.
    fn sheet(&mut self, material: &str, corner: DVec3, u: DVec3, v: DVec3, n: usize) {
        writeln!(self.text, "usemtl {material}").unwrap();
        let at =
            |i: usize, j: usize| corner + u * (i as f64 / n as f64) + v * (j as f64 / n as f64);
        for j in 0..=n {
            for i in 0..=n {
                let p = at(i, j);
                writeln!(self.text, "v {} {} {}", p.x, p.y, p.z).unwrap();
            }
        }
        let first = self.vertices + 1;
        for j in 0..n {
            for i in 0..n {
                let a = first + j * (n + 1) + i;
                let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
                writeln!(self.text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
            }
        }
        self.vertices += (n + 1) * (n + 1);
    }

    /// The six walls of a cube about `centre`, turned by `turn`, fronts inwards or outwards. The first
    /// is of material `first`, the others of `wall`.
    fn cube(&mut self, first: &str, centre: DVec3, side: f64, inwards: bool, n: usize) {
        let h = side / 2.0;
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut normal = DVec3::ZERO;
                normal[axis] = -sign;
                let u = DVec3::AXES[(axis + 1) % 3];
                let v = normal.cross(u);
                let (u, v) = if inwards { (u, v) } else { (v, u) };
                let corner = centre - normal * h - (u + v) * h;
                let material = if axis == 0 && sign > 0.0 {
                    first
                } else {
                    "wall"
                };
                self.sheet(material, corner, u * side, v * side, n);
            }
        }
    }

    fn scene(self) -> Scene {
        let mtl = "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl sheet\nKd .3 .3 .3\nnewmtl box\nKd .2 .2 .2\n";
        let obj = format!("mtllib m.mtl\n{}", self.text);
        let files: [(&str, &[u8]); 1] = [("m.mtl", mtl.as_bytes())];
        load_text("test", obj.as_bytes(), &files, &LoadConfig::default()).unwrap()
    }
}

fn committed(scene: &Scene) -> CommittedScene {
    let mut config = DeviceConfig::default();
    config.isa = Some("avx2");
    let triangles: Vec<_> = scene.polygons.iter().map(|p| p.vertices).collect();
    CommittedScene::build(&Device::new(&config).unwrap(), &scene.positions, &triangles).unwrap()
}

fn auto(scene: &Scene) -> Vec<Facet> {
    resolve_sides(scene, &committed(scene), SidesMode::Auto, 1)
}

/// How many fronts and backs of a material's polygons exist, and how many polygons there are.
fn count(scene: &Scene, facets: &[Facet], material: &str) -> [usize; 3] {
    let of = |side| {
        facets
            .iter()
            .filter(|f| f.side == side && scene.surface(f.polygon).material == material)
            .count()
    };
    let all = scene
        .polygons
        .iter()
        .filter(|p| scene.surfaces[p.surface as usize].material == material)
        .count();
    [of(Side::Front), of(Side::Back), all]
}

#[test]
fn a_closed_room_has_only_insides() {
    for n in [1, 12] {
        let mut mesh = Mesh::default();
        mesh.cube("lamp", DVec3::ZERO, 1.0, true, n);
        let scene = mesh.scene();
        let facets = auto(&scene);
        assert_eq!(facets.len(), scene.polygons.len());
        assert!(facets.iter().all(|f| f.side == Side::Front));
    }
}

#[test]
fn turned_walls_are_lit_on_their_backs() {
    for n in [1, 12] {
        let mut mesh = Mesh::default();
        mesh.cube("wall", DVec3::ZERO, 1.0, false, n);
        mesh.sheet(
            "lamp",
            DVec3::new(-0.1, -0.1, 0.4),
            DVec3::Y * 0.2,
            DVec3::X * 0.2,
            n,
        );
        let scene = mesh.scene();
        let facets = auto(&scene);
        let walls = 12 * n * n;
        assert_eq!(count(&scene, &facets, "wall"), [0, walls, walls]);
        let lamps = 2 * n * n;
        assert_eq!(count(&scene, &facets, "lamp"), [lamps, lamps, lamps]);
    }
}

#[test]
fn a_free_sheet_is_lit_on_both_sides_and_a_sealed_box_outside() {
    for n in [1, 8] {
        let mut mesh = Mesh::default();
        mesh.cube("lamp", DVec3::ZERO, 4.0, true, n);
        mesh.sheet(
            "sheet",
            DVec3::new(-1.0, -1.0, 1.0),
            DVec3::X,
            DVec3::new(0.1, 1.0, 0.3),
            n,
        );
        let text_before = mesh.text.len();
        mesh.cube("wall", DVec3::new(0.9, 0.8, -1.0), 0.7, false, n);
        let boxed = mesh
            .text
            .split_off(text_before)
            .replace("usemtl wall", "usemtl box");
        mesh.text.push_str(&boxed);
        let scene = mesh.scene();
        let facets = auto(&scene);
        let of = |material| count(&scene, &facets, material);
        assert_eq!(of("sheet"), [2 * n * n; 3]);
        assert_eq!(of("box"), [12 * n * n, 0, 12 * n * n]);
        assert_eq!(of("wall"), [10 * n * n, 0, 10 * n * n]);
    }
}

#[test]
fn light_finds_its_way_through_a_door_and_round_a_corner() {
    // A dark cube beside the lit one, joined by an opening of a fifth of the wall's width.
    let n = 5;
    let mut mesh = Mesh::default();
    mesh.cube("lamp", DVec3::ZERO, 1.0, true, n);
    mesh.cube("box", DVec3::Y, 1.0, true, n);
    // Both walls in the plane y = 1/2 lose the same square.
    let middle = |line: &str, vertices: &[DVec3]| {
        let corners: Vec<DVec3> = line
            .split_whitespace()
            .skip(1)
            .map(|i| vertices[i.parse::<usize>().unwrap() - 1])
            .collect();
        let centre = corners.iter().sum::<DVec3>() / 3.0;
        (centre - DVec3::Y * 0.5).abs().max_element() < 0.1
    };
    let vertices: Vec<DVec3> = mesh
        .text
        .lines()
        .filter_map(|l| l.strip_prefix("v "))
        .map(|l| {
            let mut c = l.split(' ').map(|c| c.parse().unwrap());
            DVec3::from_array(std::array::from_fn(|_| c.next().unwrap()))
        })
        .collect();
    let kept: Vec<&str> = mesh
        .text
        .lines()
        .filter(|l| !(l.starts_with("f ") && middle(l, &vertices)))
        .collect();
    assert_eq!(mesh.text.lines().count() - kept.len(), 4);
    mesh.text = kept.join("\n");
    let scene = mesh.scene();
    let facets = auto(&scene);
    assert_eq!(facets.len(), scene.polygons.len());
    assert!(facets.iter().all(|f| f.side == Side::Front));
}

#[test]
fn without_light_on_it_a_polygon_keeps_its_front() {
    let mut mesh = Mesh::default();
    mesh.cube("lamp", DVec3::ZERO, 1.0, true, 1);
    mesh.cube("box", DVec3::splat(3.0), 1.0, true, 1);
    let scene = mesh.scene();
    let facets = auto(&scene);
    assert_eq!(facets.len(), scene.polygons.len());
    assert!(facets.iter().all(|f| f.side == Side::Front));
}

#[test]
fn the_other_modes_ask_nothing() {
    let mut mesh = Mesh::default();
    mesh.cube("lamp", DVec3::ZERO, 1.0, false, 1);
    let scene = mesh.scene();
    let committed = committed(&scene);
    let one = resolve_sides(&scene, &committed, SidesMode::One, 1);
    assert_eq!(one.len(), 12);
    assert!(one.iter().all(|f| f.side == Side::Front));
    let two = resolve_sides(&scene, &committed, SidesMode::Two, 1);
    assert_eq!(two.len(), 24);
    assert!(two.is_sorted_by_key(|f| (f.polygon, f.side)));
}

#[test]
fn any_number_of_threads_gives_the_same_sides() {
    let mut mesh = Mesh::default();
    mesh.cube("lamp", DVec3::ZERO, 4.0, true, 6);
    for i in 0..20 {
        let turn = f64::from(i);
        let u = DVec3::new(turn.cos(), turn.sin(), 0.3);
        mesh.sheet(
            "sheet",
            u * 1.1,
            u.any_orthogonal_vector() * 0.6,
            u * 0.5,
            3,
        );
    }
    let scene = mesh.scene();
    let committed = committed(&scene);
    let with = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| resolve_sides(&scene, &committed, SidesMode::Auto, 7))
    };
    let one = with(1);
    assert!(one.len() > scene.polygons.len(), "some have both sides");
    assert_eq!(one, with(2));
    assert_eq!(one, with(3));
}

#[test]
fn fifty_thousand_polygons_are_quick() {
    let mut mesh = Mesh::default();
    mesh.cube("lamp", DVec3::ZERO, 4.0, true, 46);
    mesh.cube("box", DVec3::splat(0.5), 1.0, false, 46);
    let scene = mesh.scene();
    assert!(scene.polygons.len() > 50_000);
    let committed = committed(&scene);
    let start = std::time::Instant::now();
    let facets = resolve_sides(&scene, &committed, SidesMode::Auto, 1);
    let elapsed = start.elapsed();
    assert_eq!(facets.len(), scene.polygons.len());
    println!("{} polygons: {elapsed:?}", scene.polygons.len());
    // A third of a second on two idle cores; a loaded machine is given room.
    assert!(elapsed.as_secs_f64() < 10.0, "{elapsed:?}");
}
