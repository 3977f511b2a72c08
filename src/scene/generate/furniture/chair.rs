//! Chairs and stools.

use super::super::blocks::Blocks;
use super::super::lathe::{lathe, outline};
use super::super::material::Material;
use super::super::mesh::Mesh;

/// Half the width and depth of a chair in metres.
const HALF: f64 = 0.22;
/// Width of a leg in metres.
const LEG: f64 = 0.04;
/// Underside and top of the seat in metres.
const SEAT: [f64; 2] = [0.42, 0.46];
/// Tag of the upholstered parts.
const CLOTH: u16 = 1;

/// A chair with four legs and a backrest on two posts.
pub fn chair(cell: f64, wood: Material, cloth: Material) -> Mesh {
    let mut blocks = Blocks::empty().with_cell_size(cell);
    let inner = HALF - LEG;
    for x in [-HALF, inner] {
        blocks.add([x, -HALF, 0.0], [x + LEG, -inner, SEAT[0]], 0);
        blocks.add([x, inner, 0.0], [x + LEG, HALF, 0.90], 0);
    }
    blocks.add([-HALF, -HALF, SEAT[0]], [HALF, inner, SEAT[1]], CLOTH);
    blocks.add([-inner, inner, SEAT[0]], [inner, HALF, SEAT[1]], CLOTH);
    blocks.add([-inner, inner, 0.62], [inner, HALF, 0.90], CLOTH);
    blocks.mesh(|face| if face.solid == CLOTH { cloth } else { wood })
}

/// A plain chair of few polygons: a seat and a back on two side panels.
pub fn panel_chair(wood: Material, cloth: Material) -> Mesh {
    let mut blocks = Blocks::empty();
    blocks.add([-HALF, -HALF, 0.0], [-HALF + LEG, HALF, SEAT[0]], 0);
    blocks.add([HALF - LEG, -HALF, 0.0], [HALF, HALF, SEAT[0]], 0);
    blocks.add([-HALF, -HALF, SEAT[0]], [HALF, HALF, SEAT[1]], CLOTH);
    blocks.add([-HALF, HALF - LEG, SEAT[1]], [HALF, HALF, 0.90], CLOTH);
    blocks.mesh(|face| if face.solid == CLOTH { cloth } else { wood })
}

/// An office chair: a round seat with a low back rim on a pillar and a round foot.
pub fn stool(segments: usize, metal: Material, cloth: Material) -> Mesh {
    let mut points = outline(
        metal,
        &[(0.0, 0.0), (0.24, 0.0), (0.24, 0.03), (0.03, 0.06)],
    );
    points.extend(outline(metal, &[(0.03, 0.40)]));
    points.extend(outline(
        cloth,
        &[(0.20, 0.42), (0.22, 0.47), (0.17, 0.50), (0.0, 0.50)],
    ));
    lathe(&points, segments)
}
