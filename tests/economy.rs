//! Only what the scene requires is modelled: what is not needed is not there, and costs nothing. By counts; the seconds
//! are printed (`--nocapture`) and not judged.

use certilux::embree::DeviceConfig;
use certilux::math::PolygonId;
use certilux::occluder::OccluderConfig;
use certilux::scene::generate::generate;
use certilux::scene::{LoadConfig, Scene, Side, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, Solved, Stop, Technique, solve};
use glam::DVec3;
use std::time::Instant;

fn scene(name: &str, edit: impl Fn(&str) -> String) -> Scene {
    let text = generate(name).expect("a built-in scene");
    let mtl: String = text.mtl.lines().map(|l| edit(l) + "\n").collect();
    let library = format!("{name}.mtl");
    let files = [(library.as_str(), mtl.as_bytes())];
    load_text(name, text.obj.as_bytes(), &files, &LoadConfig::default()).expect("loads")
}

/// A material's line with the mean of its channels in all of them.
fn grey(line: &str) -> String {
    match line.split_once(' ') {
        Some((key @ ("Kd" | "Ke"), colour)) => {
            let channels: Vec<f64> = colour
                .split_whitespace()
                .map(|c| c.parse().unwrap())
                .collect();
            let mean = channels.iter().sum::<f64>() / channels.len() as f64;
            format!("{key} {mean:?} {mean:?} {mean:?}")
        }
        _ => line.to_owned(),
    }
}

/// The same with a blue that only just differs.
fn all_but_grey(line: &str) -> String {
    let line = grey(line);
    match line.strip_prefix("Kd").and_then(|_| line.rsplit_once(' ')) {
        Some((rest, blue)) => format!("{rest} {:?}", blue.parse::<f64>().unwrap() * (1.0 + 1e-12)),
        None => line,
    }
}

fn prepare(scene: Scene, sides: SidesMode, technique: Technique) -> PreparedScene {
    PreparedScene::new(scene, sides, 1, &DeviceConfig::default())
        .expect("Embree opens")
        .with_guarantees(technique, &OccluderConfig::default())
}

fn solved(prepared: &PreparedScene, technique: Technique) -> Solved {
    let mut config = SolveConfig::default();
    config.technique = technique;
    config.epsilon = 1.0e-4;
    config.stop = Stop::Passes(2);
    solve(prepared, &config, &Silent).expect("solves")
}

#[test]
fn grey_scenes_carry_one_channel() {
    let [one, three] = [grey as fn(&str) -> String, all_but_grey].map(|edit| {
        let prepared = prepare(
            scene("cornell-spheres", edit),
            SidesMode::Auto,
            Technique::Occlusion,
        );
        let start = Instant::now();
        let solved = solved(&prepared, Technique::Occlusion);
        (solved, start.elapsed().as_secs_f64())
    });
    assert_eq!((one.0.channels, three.0.channels), (1, 3));
    println!(
        "1 channel: {} bytes of light, {:.3} s; 3 channels: {} bytes, {:.3} s",
        one.0.bytes, one.1, three.0.bytes, three.1
    );
    // The work is the same, what is kept of it is not: three numbers in f64 and three corners become one each.
    for (a, b) in one.0.passes.iter().zip(&three.0.passes) {
        assert_eq!(
            (a.exchanges, a.rays, a.shafts),
            (b.exchanges, b.rays, b.shafts)
        );
    }
    assert!(2 * one.0.bytes < three.0.bytes);
    let patches = one.0.solution.patches.iter().zip(&three.0.solution.patches);
    for (a, b) in patches {
        assert_eq!(a.radiosity[0], a.radiosity[2]);
        assert!((a.radiosity[0] - b.radiosity[0]).abs() <= 1.0e-5 * a.radiosity[0].max(1.0e-3));
    }
}

#[test]
fn closed_rooms_have_no_backs() {
    for name in ["furnace", "furnace-blocks"] {
        let prepared = prepare(
            scene(name, str::to_owned),
            SidesMode::Auto,
            Technique::Occlusion,
        );
        let both = prepare(
            scene(name, str::to_owned),
            SidesMode::Two,
            Technique::Occlusion,
        );
        let (facets, nodes) = (&prepared.hierarchy.facets, prepared.hierarchy.nodes.len());
        let polygons = prepared.scene.polygons.len();
        println!(
            "{name}: {polygons} polygons, {} sides, {nodes} nodes; on both sides {} and {}",
            facets.len(),
            both.hierarchy.facets.len(),
            both.hierarchy.nodes.len()
        );
        assert!(facets.iter().all(|f| f.side == Side::Front));
        assert_eq!((facets.len(), nodes), (polygons, 2 * polygons - 1));
        assert_eq!(both.hierarchy.facets.len(), 2 * polygons);
        let [a, b] = [&prepared, &both].map(|p| solved(p, Technique::Occlusion));
        println!("light: {} and {} bytes", a.bytes, b.bytes);
        assert!(2 * prepared.hierarchy.bytes() < both.hierarchy.bytes() + 200);
    }
}

#[test]
fn what_a_technique_does_not_ask_for_is_not_built() {
    let of = |technique| {
        let prepared = prepare(
            scene("furnace-partitions", str::to_owned),
            SidesMode::Auto,
            technique,
        );
        let pass = solved(&prepared, technique).passes[0];
        (prepared.guarantees, pass)
    };
    for technique in [Technique::Normal, Technique::Unoccluded] {
        let (guarantees, pass) = of(technique);
        assert!(guarantees.is_none());
        assert_eq!(
            (pass.shafts, pass.native_rays, pass.exchanges_visible),
            (0, 0, 0)
        );
        assert_eq!(pass.rays == 0, technique == Technique::Unoccluded);
    }
    let (guarantees, pass) = of(Technique::Visibility);
    assert!(guarantees.unwrap().occluder_set.occluders.is_empty());
    assert_eq!((pass.occluded_claims, pass.native_rays), (0, 0));
    let (guarantees, pass) = of(Technique::Occlusion);
    assert!(!guarantees.unwrap().occluder_set.occluders.is_empty());
    assert!(pass.occluded_claims > 0 && pass.native_rays == 0);
}

/// Walls on the bounding box part nothing, and small things hide next to nothing.
#[test]
fn scenes_in_which_no_occluder_can_pay_have_none() {
    let empty = scene("furnace", str::to_owned);
    let centre = empty.normalisation.centre;
    let mut small = String::new();
    for step in [DVec3::ZERO, DVec3::X, DVec3::Y] {
        let corner = centre + 0.005 / empty.normalisation.scale * step;
        small += &format!("v {} {} {}\n", corner.x, corner.y, corner.z);
    }
    small += "f -1 -2 -3\n";
    let text = generate("furnace").expect("a built-in scene");
    let files = [("furnace.mtl", text.mtl.as_bytes())];
    let obj = text.obj + &small;
    let speck = load_text("speck", obj.as_bytes(), &files, &LoadConfig::default()).expect("loads");
    for scene in [empty, speck] {
        let polygons = scene.polygons.len();
        let prepared = prepare(scene, SidesMode::Auto, Technique::Blockers);
        let guarantees = prepared
            .guarantees
            .as_ref()
            .expect("visibility is asked for");
        assert!(guarantees.occluder_set.occluders.is_empty());
        assert_eq!(guarantees.occluders.bytes(), 0, "{polygons} polygons");
        let solved = solved(&prepared, Technique::Occlusion);
        assert!(solved.passes.iter().all(|p| p.occluded_claims == 0));
        assert!(solved.passes.iter().any(|p| p.visible_claims > 0));
    }
}

#[test]
fn what_is_not_asked_for_is_not_kept() {
    let prepared = prepare(
        scene("furnace", str::to_owned),
        SidesMode::Auto,
        Technique::Occlusion,
    );
    let solved = solved(&prepared, Technique::Occlusion);
    assert!(solved.claims.is_empty(), "claims are kept for audits alone");
    assert_eq!(solved.check.rays, 0);
    assert!(
        solved.normalised.is_none(),
        "rows are normalised from a reflectance of 0.95 on"
    );
    assert!(solved.warnings.is_empty());
    // No polygon lies on another, so none is looked for when samples are drawn.
    let facet = prepared.hierarchy.facets[0];
    let corner = prepared.scene.corners(PolygonId::new(0))[0];
    assert!(
        !prepared.scene.contacts.is_covered(facet)
            && !prepared.scene.contacts.is_hidden(facet, corner)
    );
}
