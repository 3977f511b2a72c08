//! The clusters of a hierarchy as a coloured mesh, for a person to look at (paper, Fig. 1).

use super::{OutputError, write_atomically};
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::scene::{Scene, Side};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Fraction of a turn between the hues of successive clusters: the golden ratio's, which keeps any
/// few successive ones apart.
const HUE_STEP: f64 = 0.618_033_988_749_895;

/// Writes the facets of `scene` as a binary PLY in the file's units, one colour for each of the
/// `count` clusters of [`Hierarchy::cut`], and returns how many there are. Facets share no vertices,
/// so that vertex colours stay within a cluster; faces carry the cluster's number and node too.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::TooLarge`].
pub fn write_cluster_ply(
    path: &Path,
    scene: &Scene,
    hierarchy: &Hierarchy,
    count: usize,
    interrupted: &AtomicBool,
) -> Result<usize, OutputError> {
    let vertices = 3 * hierarchy.facets.len();
    // Readers take indices and counts as signed 32-bit.
    if i32::try_from(vertices).is_err() {
        return Err(OutputError::TooLarge {
            path: path.to_path_buf(),
            what: "vertices",
            count: vertices,
        });
    }
    let clusters = hierarchy.cut(count);
    write_atomically(path, interrupted, |w| {
        encode(scene, hierarchy, &clusters, w).map_err(|e| OutputError::io("write", path, e))
    })?;
    Ok(clusters.len())
}

fn encode(
    scene: &Scene,
    hierarchy: &Hierarchy,
    clusters: &[NodeId],
    w: &mut impl Write,
) -> io::Result<()> {
    let facets = hierarchy.facets.len();
    write!(
        w,
        "ply\nformat binary_little_endian 1.0\n\
         comment certilux clusters: one colour a cluster\n\
         element vertex {}\n\
         property double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n\
         element face {facets}\n\
         property list uchar int vertex_indices\n\
         property int source_face\nproperty uchar side\nproperty int cluster\nproperty int node\n\
         end_header\n",
        3 * facets
    )?;
    for (index, &cluster) in clusters.iter().enumerate() {
        let colour = cluster_colour(index);
        for facet in &hierarchy.facets[hierarchy.facet_range(cluster)] {
            let mut corners = scene.source_corners(facet.polygon);
            if facet.side == Side::Back {
                corners.swap(1, 2);
            }
            for corner in corners {
                for coordinate in corner.to_array() {
                    w.write_all(&coordinate.to_le_bytes())?;
                }
                w.write_all(&colour)?;
            }
        }
    }
    let mut vertex = 0_i32;
    for (index, &cluster) in clusters.iter().enumerate() {
        for facet in &hierarchy.facets[hierarchy.facet_range(cluster)] {
            w.write_all(&[3])?;
            for corner in 0..3 {
                w.write_all(&(vertex + corner).to_le_bytes())?;
            }
            vertex += 3;
            let source_face = scene.polygons[facet.polygon.index()].source_face;
            w.write_all(&source_face.to_le_bytes())?;
            w.write_all(&[facet.side as u8])?;
            w.write_all(&(index as i32).to_le_bytes())?;
            w.write_all(&cluster.0.to_le_bytes())?;
        }
    }
    Ok(())
}

/// A colour for cluster number `index`: hues by the golden ratio, in three alternating shades.
pub(super) fn cluster_colour(index: usize) -> [u8; 3] {
    let hue = (index as f64 * HUE_STEP).fract() * 6.0;
    let value = [0.95, 0.75, 0.55][index % 3];
    let channel = |offset: f64| {
        let away = ((hue + offset) % 6.0 - 3.0).abs() - 1.0;
        // Saturation 0.7 leaves every colour distinct from black and from its shaded neighbours.
        let pure = away.clamp(0.0, 1.0);
        (255.0 * value * (0.3 + 0.7 * pure)) as u8
    };
    [channel(0.0), channel(4.0), channel(2.0)]
}
