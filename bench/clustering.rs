//! Time and memory of building the hierarchy, over four sizes, on one thread.
//!
//! `cargo bench --bench clustering` prints CSV. Every case runs in a process of its own, so that
//! its peak memory is its own; `seconds` is the least wall time and `cpu_seconds` the least
//! processor time of the repeats. `growth` is the exponent of processor time since the size before.

#[allow(dead_code)]
#[path = "../tests/clustering/meshes.rs"]
mod meshes;

use certilux::cluster::{ClusterConfig, Hierarchy, NodeKind, build_hierarchy};
use certilux::math::NodeId;
use certilux::scene::Scene;
use glam::{Quat, Vec3};
use meshes::{Mesh, Random, both_sides, cuboid, fronts, grid, random_wall, sphere};
use std::process::Command;
use std::time::Instant;

/// Polygons asked for.
const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
const CASES: [&str; 5] = [
    "furnished",
    "furnished_two_sided",
    // As `furnished`, volume clusters taking over where a face cluster would bend by 60 degrees.
    "furnished_narrow",
    "coplanar_grid",
    "specks",
];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|a| a == "--case") {
        run_case(
            &arguments[at + 1],
            arguments[at + 2].parse().expect("a size"),
        );
        return;
    }
    if arguments.iter().any(|a| a == "--test") {
        return;
    }
    println!(
        "case,polygons,facets,seconds,cpu_seconds,growth,peak_rss_mib,scene_rss_mib,hierarchy_mib,\
         depth,mean_depth,face_clusters,volume_clusters,box_cost"
    );
    let me = std::env::current_exe().expect("a bench has a path");
    for case in CASES {
        let mut last: Option<(f64, f64)> = None;
        for size in SIZES {
            let output = Command::new(&me)
                .args(["--case", case, &size.to_string()])
                .env("RAYON_NUM_THREADS", "1")
                .output()
                .expect("a bench can start itself");
            assert!(output.status.success(), "{case} {size} failed");
            let text = String::from_utf8(output.stdout).expect("numbers are text");
            let mut fields: Vec<String> = text.trim().split(',').map(str::to_owned).collect();
            let facets: f64 = fields[2].parse().expect("a count");
            let cpu: f64 = fields[4].parse().expect("seconds");
            let growth = last.map(|(f, c)| (cpu / c).ln() / (facets / f).ln());
            last = Some((facets, cpu));
            fields.insert(5, growth.map_or(String::new(), |g| format!("{g:.2}")));
            println!("{}", fields.join(","));
        }
    }
}

fn run_case(case: &str, size: usize) {
    let mesh = match case {
        "coplanar_grid" => coplanar_grid(size),
        "specks" => specks(size),
        _ => furnished(size),
    };
    let scene = mesh.scene();
    drop(mesh);
    let facets = if case == "furnished_two_sided" {
        both_sides(&scene)
    } else {
        fronts(&scene)
    };
    let mut config = ClusterConfig::default();
    if case == "furnished_narrow" {
        config.widest = 60.0_f64.to_radians();
    }
    let scene_memory = peak_memory_mib();
    let repeats = if size > 100_000 { 1 } else { 5 };
    let (mut wall, mut cpu) = (f64::INFINITY, f64::INFINITY);
    let mut hierarchy = None;
    for _ in 0..repeats {
        drop(hierarchy.take());
        let (start, used) = (Instant::now(), cpu_seconds());
        hierarchy = Some(build_hierarchy(&scene, &facets, &config));
        wall = wall.min(start.elapsed().as_secs_f64());
        cpu = cpu.min(cpu_seconds() - used);
    }
    let peak = peak_memory_mib();
    let hierarchy = hierarchy.expect("at least one repeat");
    let (depth, mean_depth) = depths(&hierarchy);
    let count = |kind| hierarchy.nodes.iter().filter(|n| n.kind == kind).count();
    println!(
        "{case},{},{},{wall:.4},{cpu:.4},{peak:.0},{scene_memory:.0},{:.0},{depth},{mean_depth:.1},{},{},{:.1}",
        scene.polygons.len(),
        facets.len(),
        hierarchy.bytes() as f64 / 1_048_576.0,
        count(NodeKind::FaceCluster),
        count(NodeKind::Volume),
        box_cost(&hierarchy, &scene),
    );
}

fn depths(hierarchy: &Hierarchy) -> (u32, f64) {
    let mut depth = vec![0_u32; hierarchy.nodes.len()];
    let (mut greatest, mut sum) = (0, 0);
    for index in 0..depth.len() {
        match hierarchy.children(NodeId::new(index)) {
            Some(children) => {
                for child in children {
                    depth[child.index()] = depth[index] + 1;
                }
            }
            None => {
                greatest = greatest.max(depth[index]);
                sum += u64::from(depth[index]);
            }
        }
    }
    (greatest, sum as f64 / hierarchy.facets.len() as f64)
}

/// Sum of the inner boxes' areas over the scene's: the boxes that a random line through the scene
/// is expected to enter.
fn box_cost(hierarchy: &Hierarchy, scene: &Scene) -> f64 {
    let inner = hierarchy.nodes.iter().filter(|n| n.kind != NodeKind::Facet);
    let sum: f64 = inner.map(|n| f64::from(n.bounds.surface_area())).sum();
    sum / f64::from(scene.bounds().surface_area())
}

fn coplanar_grid(size: usize) -> Mesh {
    let cells = (size as f64 / 2.0).sqrt().ceil() as u32;
    grid(Vec3::splat(-0.5), Vec3::X, Vec3::Y, cells, cells).rotate(Quat::from_rotation_x(0.3))
}

fn specks(size: usize) -> Mesh {
    let mut random = Random::new(5);
    let mut mesh = Mesh::default();
    let span = 0.5 / (size as f32).cbrt();
    for _ in 0..size {
        let at = Vec3::new(random.unit(), random.unit(), random.unit());
        let base = mesh.positions.len() as u32;
        for _ in 0..3 {
            let away = Vec3::new(random.unit(), random.unit(), random.unit());
            mesh.positions.push(at + span * away);
        }
        mesh.triangles.push([base, base + 1, base + 2]);
    }
    mesh
}

/// Rooms in a row: walls meshed finely, irregularly or not at all, boxes on the floor, round things
/// on the boxes.
fn furnished(size: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random = Random::new(9);
    let rooms = (size as f64 / 4_000.0).sqrt().ceil() as usize;
    let a_room = size / rooms;
    let step = 1.0 / rooms as f32;
    for room in 0..rooms {
        let end = mesh.triangles.len() + a_room;
        let at = Vec3::new(room as f32 * step, 0.0, 0.0) - Vec3::splat(0.5);
        let (x, y, z) = (Vec3::X * step, Vec3::Y, Vec3::Z);
        let fine = ((a_room as f64 * 0.03).sqrt().ceil() as u32).max(1);
        mesh.append(&grid(at, x, y, fine, 2 * fine));
        mesh.append(&grid(at + z, y, x, 1, 1));
        mesh.append(&grid(at, y, z, 3, 2));
        mesh.append(&random_wall(at + x, z, y, a_room / 10 + 2, room as u64));
        mesh.append(&grid(at, z, x, fine, fine));
        mesh.append(&grid(at + y, x, z, 1, 1));
        while mesh.triangles.len() + 400 < end {
            let place = at
                + Vec3::new(
                    random.unit() * 0.9 * step,
                    random.unit() * 0.95,
                    0.001 + 0.5 * random.unit(),
                );
            let extent = 0.04 * step * Vec3::new(1.0, 1.0, 0.5 + random.unit());
            mesh.append(&cuboid(place, place + extent));
            let segments = 8 + 4 * random.below(8) as u32;
            let ball = sphere(Vec3::ZERO, 0.02 * step, segments);
            let top = place + extent + Vec3::Z * 0.03 * step;
            mesh.append(&ball.map(|p| top + p));
        }
    }
    mesh
}

/// Peak resident memory of this process so far.
fn peak_memory_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib: Option<f64> = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse().ok());
    kib.map_or(f64::NAN, |kib| kib / 1024.0)
}

/// Processor time of this process so far, all threads, from the kernel's count of nanoseconds.
fn cpu_seconds() -> f64 {
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else {
        return f64::NAN;
    };
    let nanoseconds = |thread: std::fs::DirEntry| {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    };
    threads.flatten().filter_map(nanoseconds).sum::<f64>() * 1.0e-9
}
