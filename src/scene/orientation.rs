//! The scene's own axes: the three perpendicular directions that most of its area faces (a Manhattan frame; Straub et al.
//! 2014, "A Mixture of Manhattan Frames: Beyond the Manhattan World").
//!
//! Bounding boxes fit walls that run along the axes. A building whose walls do not, as it is placed on a site, is turned until they
//! do: its light then costs what it costs any other building, and depends on which way the file turns it by no more than
//! rounding. Where a scene is so symmetric that rounding or the file's order decides between two frames (two equal wings, a cube), another
//! turn may pick the other one: as much light, by other samples.

use super::file_box::FileBox;
use super::obj_parse::RawMesh;
use glam::{DMat3, DVec3};
use std::cmp::Reverse;
use std::collections::HashMap;

/// Sine of the angle within which faces look the same way at first.
const NEAR: f64 = 1.0 / 1024.0;

/// By how much that angle is narrowed in each step of [`refined`].
const NARROWER: f64 = 0.25;

/// How often it is narrowed at most: to about 1e-9.
const STEPS: usize = 10;

/// Sine within which faces count for the frame in the end: about what six digits leave of the direction of a wall.
const CLOSE: f64 = NEAR / 64.0;

/// Directions that are tried, those of the most area.
const CANDIDATES: usize = 16;

/// Pairs of them that are made into frames.
const FRAMES: usize = 8;

/// Least share of the area that has to face along a frame's axes.
const LEAST_SHARE: f64 = 0.25;

/// The file's axes are kept where what faces along them exactly is this share of what faces closely along those found.
const AS_GOOD: f64 = 0.999;

/// Sine of the angle that counts as exact.
const EXACT: f64 = 1.0e-8;

/// Differences below this share do not decide between axes or their senses.
const TIE: f64 = 1.0e-6;

/// A face: its unit normal, its area and its middle, about the middle of the file's bounding box and in units of its extent.
struct Facing {
    normal: DVec3,
    area: f64,
    middle: DVec3,
}

/// The rotation from the file's axes to the scene's own. Axes are ordered by the area that faces along them, each towards the side where more area lies:
/// but for ties, neither depends on how the file turns the scene. The identity where no three directions hold a quarter of the area.
///
/// Where the own axes are the file's in another order, the rotation is exact (entries 0, 1 and -1).
pub(super) fn own_axes(mesh: &RawMesh, file: FileBox) -> DMat3 {
    let facings = facings(mesh, file);
    let total: f64 = facings.iter().map(|f| f.area).sum();
    let Some((axes, score)) = best_frame(&facings) else {
        return DMat3::IDENTITY;
    };
    if score < LEAST_SHARE * total {
        return DMat3::IDENTITY;
    }
    let along = |axes: &[DVec3; 3], sine| -> f64 {
        axes.iter()
            .map(|&axis| area_along(&facings, axis, sine))
            .sum()
    };
    let found = perpendicular(best_first(
        axes.map(|axis| refined(&facings, axis)),
        &facings,
    ));
    let as_read = [DVec3::X, DVec3::Y, DVec3::Z];
    let axes = match along(&as_read, EXACT) >= AS_GOOD * along(&found, CLOSE) {
        true => as_read,
        false => nearest_first(found),
    };
    let [x, y, z] = ordered(axes, &facings, total);
    DMat3::from_cols(x, y, z).transpose()
}

fn facings(mesh: &RawMesh, FileBox { centre, span }: FileBox) -> Vec<Facing> {
    let at = |corner: usize| (mesh.positions[mesh.corners[corner] as usize] - centre) / span;
    let of_face = |face| {
        let corners = mesh.corner_range(face);
        let first = at(corners.start);
        let doubled: DVec3 = (corners.start + 1..corners.end.saturating_sub(1))
            .map(|c| (at(c) - first).cross(at(c + 1) - first))
            .sum();
        let middle = corners.clone().map(at).sum::<DVec3>() / corners.len() as f64;
        let normal = doubled.try_normalize()?;
        Some(Facing {
            normal,
            area: 0.5 * doubled.length(),
            middle,
        })
    };
    (0..mesh.face_count()).filter_map(of_face).collect()
}

/// Area of what faces along an axis, either way, within an angle of the given sine.
fn area_along(facings: &[Facing], axis: DVec3, sine: f64) -> f64 {
    let along = |f: &&Facing| f.normal.cross(axis).length_squared() <= sine * sine;
    facings.iter().filter(along).map(|f| f.area).sum()
}

/// The frame that most area faces along, and that area.
fn best_frame(facings: &[Facing]) -> Option<([DVec3; 3], f64)> {
    let found: Vec<(DVec3, f64)> = (candidates(facings).into_iter())
        .map(|axis| (axis, area_along(facings, axis, NEAR)))
        .collect();
    let mut pairs: Vec<(f64, DVec3, DVec3)> = Vec::new();
    for (k, &(a, area)) in found.iter().enumerate() {
        for &(b, other) in &found[..k] {
            if a.dot(b).abs() <= 2.0 * NEAR {
                pairs.push((area + other, a, b));
            }
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs.truncate(FRAMES);
    let mut best: Option<([DVec3; 3], f64)> = None;
    for (area, a, b) in pairs {
        let third = a.cross(b).normalize();
        let score = area + area_along(facings, third, NEAR);
        if best.is_none_or(|(_, found)| score > found) {
            best = Some(([a, b, third], score));
        }
    }
    best
}

/// Directions that much area faces, a mean for each cell of a cube around the origin; opposite ones count as one.
fn candidates(facings: &[Facing]) -> Vec<DVec3> {
    let mut cells: HashMap<[i32; 3], (f64, DVec3)> = HashMap::new();
    for facing in facings {
        let n = facing.normal;
        let on_cube = n / n.abs().max_element();
        let leading = on_cube.to_array().into_iter().find(|c| c.abs() == 1.0);
        let folded = on_cube * leading.unwrap_or(1.0);
        let cell = (folded / NEAR).round().as_ivec3().to_array();
        let (area, sum) = cells.entry(cell).or_insert((0.0, DVec3::ZERO));
        *area += facing.area;
        *sum += n * leading.unwrap_or(1.0) * facing.area;
    }
    let mut cells: Vec<_> = cells.into_iter().collect();
    cells.sort_by(|(a, (x, _)), (b, (y, _))| y.total_cmp(x).then(a.cmp(b)));
    (cells.into_iter().take(CANDIDATES))
        .filter_map(|(_, (_, sum))| sum.try_normalize())
        .collect()
}

/// The mean direction of what faces along `axis`, of ever closer faces as long as they hold half the area.
fn refined(facings: &[Facing], mut axis: DVec3) -> DVec3 {
    let mut sine = NEAR;
    let least = 0.5 * area_along(facings, axis, sine);
    for _ in 0..=STEPS {
        let along = |f: &&Facing| f.normal.cross(axis).length_squared() <= sine * sine;
        let (mut area, mut sum) = (0.0, DVec3::ZERO);
        for facing in facings.iter().filter(along) {
            area += facing.area;
            sum += facing.normal * (facing.area * facing.normal.dot(axis).signum());
        }
        if area < least {
            break;
        }
        axis = sum.try_normalize().unwrap_or(axis);
        sine *= NARROWER;
    }
    axis
}

/// Axes by the area that faces closely along them, the greatest first: that one is kept exactly.
fn best_first(mut axes: [DVec3; 3], facings: &[Facing]) -> [DVec3; 3] {
    axes.sort_by_cached_key(|&axis| Reverse(area_along(facings, axis, CLOSE).to_bits()));
    axes
}

/// Makes nearly perpendicular axes perpendicular; the first is kept.
fn perpendicular([a, b, _]: [DVec3; 3]) -> [DVec3; 3] {
    let b = (b - a * a.dot(b)).normalize();
    [a, b, a.cross(b)]
}

/// Axes in the order and the senses of the file's axes that they are nearest to.
fn nearest_first(axes: [DVec3; 3]) -> [DVec3; 3] {
    const ORDERS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    let nearness = |order: &[usize; 3]| -> f64 { (0..3).map(|k| axes[order[k]][k].abs()).sum() };
    let mut best = ORDERS[0];
    for order in ORDERS {
        if nearness(&order) > nearness(&best) {
            best = order;
        }
    }
    std::array::from_fn(|k| axes[best[k]] * axes[best[k]][k].signum())
}

/// Angle in degrees by which the nearest axes of the file have to be turned, about one line, to those of `turn`: 0 to 63.
pub(super) fn degrees_askew(turn: DMat3) -> f64 {
    let axes = turn.transpose();
    let [x, y, z] = nearest_first([axes.x_axis, axes.y_axis, axes.z_axis]);
    let cosine = 0.5 * (x.x + y.y + z.z - 1.0);
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

/// The axes, most area first, each towards the side where more area lies, right-handed.
fn ordered(axes: [DVec3; 3], facings: &[Facing], total: f64) -> [DVec3; 3] {
    let areas = axes.map(|axis| area_along(facings, axis, NEAR));
    let mut order = [0, 1, 2];
    // Three elements: each compared with each.
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if areas[order[j]] > areas[order[i]] + TIE * total {
            order.swap(i, j);
        }
    }
    let axes = order.map(|k| axes[k]);
    let leans = axes.map(|axis| lean(axis, facings) / total);
    let mut turned = axes;
    for (axis, lean) in turned.iter_mut().zip(leans) {
        if lean < -TIE {
            *axis = -*axis;
        }
    }
    if turned[0].cross(turned[1]).dot(turned[2]) < 0.0 {
        let least = (0..3).fold(0, |k, j| {
            if leans[j].abs() < leans[k].abs() {
                j
            } else {
                k
            }
        });
        turned[least] = -turned[least];
    }
    turned
}

/// How far the area lies towards `axis` from the middle of its extent, times the area.
fn lean(axis: DVec3, facings: &[Facing]) -> f64 {
    let (mut least, mut greatest, mut sum, mut area) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
    for facing in facings {
        let at = facing.middle.dot(axis);
        (least, greatest) = (least.min(at), greatest.max(at));
        sum += at * facing.area;
        area += facing.area;
    }
    sum - 0.5 * (least + greatest) * area
}
