//! Lamps: panels under the ceiling, lanterns, floor lamps, table lamps.

use super::super::blocks::Blocks;
use super::super::lathe::{Turn, lathe, outline};
use super::super::material::Material;
use super::super::mesh::Mesh;

/// A panel of `width` by `depth`, 4 cm thick, whose underside (at z = 0) emits.
pub fn lamp_panel(width: f64, depth: f64, cell: f64, frame: Material, glow: Material) -> Mesh {
    let (x, y) = (width / 2.0, depth / 2.0);
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -y, 0.0], [x, y, 0.04], 0);
    blocks.mesh(|face| if face.faces_down() { glow } else { frame })
}

/// A hanging lantern of `width` by `width` by `height` whose sides glow; its base is at z = 0.
pub fn lantern(width: f64, height: f64, cell: f64, frame: Material, glow: Material) -> Mesh {
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -x, 0.0], [x, x, height], 0);
    blocks.mesh(|face| {
        if face.faces_up() || face.faces_down() {
            frame
        } else {
            glow
        }
    })
}

/// A floor lamp 1.6 m high: foot, pole and a drum shade.
pub fn floor_lamp(segments: usize, metal: Material, shade: Material) -> Mesh {
    lamp_on_pole(0.16, 1.25, 1.60, 0.22, segments, metal, shade)
}

/// A table lamp 0.5 m high.
pub fn table_lamp(segments: usize, metal: Material, shade: Material) -> Mesh {
    lamp_on_pole(0.09, 0.28, 0.50, 0.14, segments, metal, shade)
}

fn lamp_on_pole(
    foot: f64,
    neck: f64,
    top: f64,
    shade_radius: f64,
    segments: usize,
    metal: Material,
    shade: Material,
) -> Mesh {
    let mut points = outline(
        metal,
        &[
            (0.0, 0.0),
            (foot, 0.0),
            (foot, 0.02),
            (0.02, 0.04),
            (0.02, neck),
        ],
    );
    let ring = |radius: f64, height: f64| Turn {
        radius,
        height,
        material: shade,
    };
    points.extend([
        ring(shade_radius, neck),
        ring(shade_radius * 0.7, top),
        ring(0.0, top),
    ]);
    lathe(&points, segments)
}
