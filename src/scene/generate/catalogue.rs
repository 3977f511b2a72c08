//! The catalogue of built-in scenes, and the way from a name to a scene.

use super::analytic::*;
use super::mesh::Mesh;
use super::obj_text::{mtl_text, obj_text};
use super::places::*;
use super::unknown_scene::UnknownScene;

/// A scene as the text of its two files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GeneratedScene {
    /// The name it was asked for by, which is also the stem of its files.
    pub name: String,
    /// The OBJ file, y up, in metres; it names `NAME.mtl` as its material library.
    pub obj: String,
    /// The MTL file.
    pub mtl: String,
}

/// One line of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct CatalogueEntry {
    /// The name that [`generate`] takes.
    pub name: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
    build: Builder,
}

/// How an entry is built.
#[derive(Clone, Copy, Debug)]
enum Builder {
    /// One scene.
    Fixed(fn() -> Mesh),
    /// A family over the reflectance: `NAME-RHO` with RHO in [0, 1), `NAME` alone for 0.5.
    OverReflectance(fn(f64) -> Mesh),
}

/// Reflectance of a family's scene when its name gives none.
const DEFAULT_REFLECTANCE: f64 = 0.5;

const fn fixed(
    name: &'static str,
    description: &'static str,
    build: fn() -> Mesh,
) -> CatalogueEntry {
    CatalogueEntry {
        name,
        description,
        build: Builder::Fixed(build),
    }
}

const fn family(
    name: &'static str,
    description: &'static str,
    build: fn(f64) -> Mesh,
) -> CatalogueEntry {
    CatalogueEntry {
        name,
        description,
        build: Builder::OverReflectance(build),
    }
}

static CATALOGUE: &[CatalogueEntry] = &[
    fixed(
        "a",
        "a guest house: rooms along a corridor, little exchange",
        guest_house,
    ),
    fixed(
        "b",
        "a furniture house of 10 x 10 showrooms with wide openings",
        showrooms,
    ),
    fixed(
        "c",
        "a warehouse: an open hall of racks, stacks and screens",
        warehouse,
    ),
    fixed(
        "d",
        "a living room with few pieces and two screens, little occlusion",
        living_room,
    ),
    fixed(
        "e",
        "a flat of eight rooms along a hall, lit from a veranda at its end",
        flat,
    ),
    fixed("f", "an exhibition hall of few large polygons", gallery),
    fixed(
        "two-rooms",
        "two furnished rooms joined by a door, a lamp in one (the demo)",
        two_rooms,
    ),
    fixed("cornell", "the Cornell box with its two blocks", cornell),
    fixed(
        "cornell-spheres",
        "the Cornell box with two spheres",
        cornell_spheres,
    ),
    fixed(
        "corridor",
        "a corridor with four turns, a light at one end",
        corridor,
    ),
    fixed(
        "offices",
        "4 x 4 furnished offices joined by doors",
        offices,
    ),
    family(
        "furnace",
        "white furnace: an empty closed box (furnace-RHO, RHO in [0, 1))",
        |rho| furnace(FurnaceContent::Empty, rho),
    ),
    family(
        "furnace-blocks",
        "white furnace with pillars and hovering blocks (furnace-blocks-RHO)",
        |rho| furnace(FurnaceContent::Blocks, rho),
    ),
    family(
        "furnace-partitions",
        "white furnace with thin partitions (furnace-partitions-RHO)",
        |rho| furnace(FurnaceContent::Partitions, rho),
    ),
    family(
        "furnace-tjunctions",
        "white furnace whose walls are meshed differently (furnace-tjunctions-RHO)",
        |rho| furnace(FurnaceContent::TJunctions, rho),
    ),
    family(
        "furnace-sphere",
        "white furnace around a sphere (furnace-sphere-RHO)",
        |rho| furnace(FurnaceContent::Sphere, rho),
    ),
    fixed(
        "sealed",
        "a lit room, and two rooms shut off from it that must stay black",
        sealed,
    ),
    fixed(
        "sealed-slab",
        "a lit and a dark room over one floor, parted by a slab",
        sealed_slab,
    ),
    fixed(
        "cie171-5.4",
        "CIE 171:2006 case 5.4, conservation of flux",
        cie171_flux,
    ),
    fixed(
        "cie171-5.6",
        "CIE 171:2006 case 5.6, diffuse reflection onto a black wall and ceiling",
        cie171_diffuse_reflection,
    ),
    family(
        "cie171-5.8",
        "CIE 171:2006 case 5.8, interreflection in a cube (cie171-5.8-RHO)",
        cie171_interreflection,
    ),
    fixed(
        "parallel-plates",
        "two unit squares facing each other at distance 1",
        parallel_plates,
    ),
    fixed(
        "perpendicular-plates",
        "two unit squares at a right angle with a common edge",
        perpendicular_plates,
    ),
    fixed(
        "infinite-plates",
        "two plates 200 times as wide as they are apart",
        infinite_plates,
    ),
    fixed(
        "concentric-spheres",
        "a sphere that emits inside a black one",
        concentric_spheres,
    ),
    fixed(
        "coaxial-discs",
        "two unit discs on one axis at distance 1",
        coaxial_discs,
    ),
];

/// All built-in scenes; families are listed by the name of their default member.
pub fn catalogue() -> &'static [CatalogueEntry] {
    CATALOGUE
}

/// Writes the built-in scene `name` as text: the same bytes every time.
///
/// # Errors
/// [`UnknownScene`], with the names that come nearest, when there is no such scene or when the
/// reflectance of a family is not a plain decimal number in [0, 1).
pub fn generate(name: &str) -> Result<GeneratedScene, UnknownScene> {
    let mesh =
        build(name).ok_or_else(|| UnknownScene::new(name, CATALOGUE.iter().map(|e| e.name)))?;
    Ok(GeneratedScene {
        name: name.to_owned(),
        obj: obj_text(&mesh, &format!("{name}.mtl")),
        mtl: mtl_text(&mesh.materials),
    })
}

fn build(name: &str) -> Option<Mesh> {
    CATALOGUE.iter().find_map(|entry| {
        let rest = name.strip_prefix(entry.name)?;
        match entry.build {
            Builder::Fixed(build) => rest.is_empty().then(build),
            Builder::OverReflectance(build) if rest.is_empty() => Some(build(DEFAULT_REFLECTANCE)),
            Builder::OverReflectance(build) => Some(build(reflectance(rest.strip_prefix('-')?)?)),
        }
    })
}

/// A plain decimal number in [0, 1): digits and at most one point, so that names stay file names.
fn reflectance(text: &str) -> Option<f64> {
    let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let value: f64 = text.parse().ok()?;
    (plain && value < 1.0).then_some(value)
}
