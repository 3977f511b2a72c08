//! Plates and discs with known form factors.

use super::super::lathe::{lathe, outline};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::plate::{plate, plate_cut_at};
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Emits a radiosity of 1 W/m2 and reflects nothing.
const SOURCE: Material = Material::grey("source", 0.0, FRAC_1_PI);
const RECEIVER: Material = Material::grey("receiver", 0.0, 0.0);
/// Cells along each side of a unit plate.
const CELLS: [usize; 2] = [4, 4];
/// Sides of the polygons that stand for discs.
const DISC_SIDES: usize = 96;
/// Half the side of the "infinite" plates in their distances: what misses at the centre is 1e-5.
const HALF_SIDE: f64 = 100.0;
/// Half the side of the middle pieces whose radiosity is compared, in distances.
const HALF_MIDDLE: f64 = 5.0;

/// Two unit squares facing each other at distance 1; the lower emits.
pub fn parallel_plates() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object(
        "source",
        &plate(DVec3::ZERO, DVec3::X, DVec3::Y, CELLS, SOURCE),
    );
    mesh.object(
        "receiver",
        &plate(DVec3::Z, DVec3::Y, DVec3::X, CELLS, RECEIVER),
    );
    mesh
}

/// Two unit squares at a right angle with a common edge; the level one emits.
pub fn perpendicular_plates() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object(
        "source",
        &plate(DVec3::ZERO, DVec3::X, DVec3::Y, CELLS, SOURCE),
    );
    mesh.object(
        "receiver",
        &plate(DVec3::X, DVec3::Z, DVec3::Y, CELLS, RECEIVER),
    );
    mesh
}

/// Two plates of 200 x 200 at distance 1, emitting radiosities 1 and 0.25 and reflecting 0.5 and
/// 0.7. Their middles (10 x 10) are materials of their own: `lower_middle` and `upper_middle`.
pub fn infinite_plates() -> Mesh {
    let side = 2.0 * HALF_SIDE;
    let near = 0.5 - HALF_MIDDLE / side;
    let cuts: Vec<f64> = vec![0.0, 0.25, near, 1.0 - near, 0.75, 1.0];
    let dress = |rim: Material, middle: Material| {
        move |i: usize, j: usize| if (i, j) == (2, 2) { middle } else { rim }
    };
    let corner = dvec3(-HALF_SIDE, -HALF_SIDE, 0.0);
    let (x, y) = (DVec3::X * side, DVec3::Y * side);
    let lower = dress(
        Material::grey("lower_rim", 0.5, FRAC_1_PI),
        Material::grey("lower_middle", 0.5, FRAC_1_PI),
    );
    let upper = dress(
        Material::grey("upper_rim", 0.7, 0.25 * FRAC_1_PI),
        Material::grey("upper_middle", 0.7, 0.25 * FRAC_1_PI),
    );
    let mut mesh = Mesh::default();
    mesh.object("lower", &plate_cut_at(corner, x, y, [&cuts, &cuts], lower));
    mesh.object(
        "upper",
        &plate_cut_at(corner + DVec3::Z, y, x, [&cuts, &cuts], upper),
    );
    mesh
}

/// Two discs of radius 1 at distance 1 on one axis; the lower emits. Each is a regular polygon of
/// 96 sides with the area of the disc.
pub fn coaxial_discs() -> Mesh {
    let step = TAU / DISC_SIDES as f64;
    let radius = (step / step.sin()).sqrt();
    let disc = |material, height: f64| {
        let rings = [
            (radius, height),
            (0.6 * radius, height),
            (0.25 * radius, height),
            (0.0, height),
        ];
        lathe(&outline(material, &rings), DISC_SIDES)
    };
    let mut mesh = Mesh::default();
    mesh.object("source", &disc(SOURCE, 0.0));
    mesh.object("receiver", &disc(RECEIVER, 1.0).turned_inside_out());
    mesh
}
