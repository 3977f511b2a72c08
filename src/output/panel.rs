//! The triangles that the patches of a mesh were split from.
//!
//! A mesh as read holds leaf patches only. They stand in the depth-first order of their splits, so
//! four in a row that are the children of one triangle are found by their shared vertices, and
//! joining them again and again leads back to the input's triangles: few panels for a ray tracer,
//! and a tree in which the patch under a point is found by its barycentric coordinates. Where the
//! input itself happens to be split like that, the join is as good: the point set is the same.

use super::{SolvedFace, SolvedMesh};
use crate::scene::Side;
use crate::solve::PatchPath;
use glam::DVec3;
use std::collections::HashMap;

/// One side of a triangle that was split into patches, or was not split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Panel {
    /// Welded vertices, counter-clockwise seen from the side.
    pub corners: [u32; 3],
    /// First of its patches.
    pub first_leaf: u32,
    /// Number of its patches.
    pub leaf_count: u32,
    /// Levels of splits down to the deepest of them.
    pub depth: u32,
    /// The statement that it came from.
    pub source_face: u32,
    /// Which side.
    pub side: Side,
}

/// A leaf patch, parallel to the mesh's faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leaf {
    /// Welded vertices.
    pub corners: [u32; 3],
    /// Its panel.
    pub panel: u32,
    /// Where it lies in its panel.
    pub path: PatchPath,
}

/// The panels of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Panels {
    /// Distinct positions, in the mesh's units.
    pub positions: Vec<DVec3>,
    /// In the order of their first patches.
    pub panels: Vec<Panel>,
    /// Parallel to the mesh's faces.
    pub leaves: Vec<Leaf>,
}

/// Patches joined so far.
struct Joined {
    corners: [u32; 3],
    first_leaf: u32,
    /// Levels of splits below.
    depth: u32,
}

impl Panels {
    /// Joins the patches of `mesh`.
    pub fn new(mesh: &SolvedMesh) -> Self {
        let (positions, welded) = weld(&mesh.vertices);
        let mut leaves: Vec<Leaf> = mesh
            .faces
            .iter()
            .map(|face| Leaf {
                corners: face.vertices.map(|v| welded[v as usize]),
                panel: 0,
                path: PatchPath::ROOT,
            })
            .collect();
        let mut stack: Vec<Joined> = Vec::new();
        let same_facet =
            |a: &SolvedFace, b: &SolvedFace| (a.source_face, a.side) == (b.source_face, b.side);
        for i in 0..leaves.len() {
            stack.push(Joined {
                corners: leaves[i].corners,
                first_leaf: i as u32,
                depth: 0,
            });
            while let Some(children) = stack.last_chunk::<4>() {
                let first = children[0].first_leaf;
                let depth = 1 + children.iter().map(|c| c.depth).max().unwrap_or(0);
                if depth > PatchPath::MAX_LEVEL
                    || !same_facet(&mesh.faces[first as usize], &mesh.faces[i])
                {
                    break;
                }
                let Some(corners) = parent(children, &positions) else {
                    break;
                };
                let starts = [0, 1, 2, 3].map(|c| children[c].first_leaf as usize);
                let ends = [starts[1], starts[2], starts[3], i + 1];
                for which in 0..4 {
                    for leaf in &mut leaves[starts[which]..ends[which]] {
                        leaf.path = below(leaf.path, which as u32);
                    }
                }
                stack.truncate(stack.len() - 4);
                stack.push(Joined {
                    corners,
                    first_leaf: first,
                    depth,
                });
            }
        }
        let mut panels: Vec<Panel> = Vec::with_capacity(stack.len());
        for (p, joined) in stack.iter().enumerate() {
            let end = stack
                .get(p + 1)
                .map_or(leaves.len(), |next| next.first_leaf as usize);
            let first = joined.first_leaf as usize;
            for leaf in &mut leaves[first..end] {
                leaf.panel = p as u32;
            }
            panels.push(Panel {
                corners: joined.corners,
                first_leaf: joined.first_leaf,
                leaf_count: (end - first) as u32,
                depth: joined.depth,
                source_face: mesh.faces[first].source_face,
                side: mesh.faces[first].side,
            });
        }
        Self {
            positions,
            panels,
            leaves,
        }
    }

    /// The patches of a panel.
    pub fn leaf_range(&self, panel: &Panel) -> std::ops::Range<usize> {
        let first = panel.first_leaf as usize;
        first..first + panel.leaf_count as usize
    }

    /// The patch of `panel` that holds the point of barycentric `weights`, and the point's weights
    /// in the patch.
    pub fn leaf_at(&self, panel: &Panel, weights: [f64; 3]) -> (usize, [f64; 3]) {
        let range = self.leaf_range(panel);
        let leaves = &self.leaves[range.clone()];
        // The walk to the point, as deep as the deepest leaf; leaves ascend along it.
        let mut place = 0u64;
        let mut local = weights;
        for _ in 0..panel.depth {
            let which = child_at(local);
            place = (place << 2) | u64::from(which);
            local = child_weights(local, which);
        }
        place <<= 2 * (PatchPath::MAX_LEVEL - panel.depth);
        let leaf = leaves.partition_point(|l| first_place(l.path) <= place) - 1;
        let local = leaves[leaf].path.steps().fold(weights, child_weights);
        (range.start + leaf, local)
    }

    /// Unit normal of a panel, on its side.
    pub fn normal(&self, panel: &Panel) -> DVec3 {
        let [a, b, c] = panel.corners.map(|v| self.positions[v as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }
}

/// Gives positions that compare equal (zeros of either sign) one index.
fn weld(vertices: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    let mut index: HashMap<[u64; 3], u32> = HashMap::with_capacity(vertices.len());
    let mut positions = Vec::with_capacity(vertices.len());
    let welded = vertices
        .iter()
        .map(|&vertex| {
            *index.entry(position_key(vertex)).or_insert_with(|| {
                positions.push(vertex);
                positions.len() as u32 - 1
            })
        })
        .collect();
    (positions, welded)
}

/// Equal for positions that compare equal.
pub(crate) fn position_key(position: DVec3) -> [u64; 3] {
    // Adding zero turns the negative zero into the positive one.
    position.to_array().map(|x| (x + 0.0).to_bits())
}

/// The triangle whose four children, numbered as in [`PatchPath`], these are.
fn parent(children: &[Joined; 4], positions: &[DVec3]) -> Option<[u32; 3]> {
    let [zero, one, two, middle] = children.each_ref().map(|c| c.corners);
    let [a, ab, ca] = zero;
    let [b, c, bc] = [one[1], two[2], one[2]];
    if one != [ab, b, bc] || two != [ca, bc, c] || middle != [bc, ca, ab] {
        return None;
    }
    let at = |v: u32| positions[v as usize];
    let halfway = |m: u32, v: u32, w: u32| at(m) == 0.5 * (at(v) + at(w));
    (halfway(ab, a, b) && halfway(bc, b, c) && halfway(ca, c, a)).then_some([a, b, c])
}

/// `path` seen from a triangle of which its root is the child `which`.
fn below(path: PatchPath, which: u32) -> PatchPath {
    let level = path.level();
    let digits = path.0 ^ (1 << (2 * level));
    PatchPath(digits | (u64::from(which) << (2 * level)) | (1 << (2 * level + 2)))
}

/// The first of the deepest places inside a patch.
fn first_place(path: PatchPath) -> u64 {
    let level = path.level();
    (path.0 ^ (1 << (2 * level))) << (2 * (PatchPath::MAX_LEVEL - level))
}

/// The child that holds the point of barycentric `weights`.
fn child_at(weights: [f64; 3]) -> u32 {
    weights.iter().position(|&w| w > 0.5).unwrap_or(3) as u32
}

/// Barycentric weights in child `which` of a point given in its parent.
fn child_weights(weights: [f64; 3], which: u32) -> [f64; 3] {
    match which {
        3 => weights.map(|w| 1.0 - 2.0 * w),
        _ => std::array::from_fn(|i| 2.0 * weights[i] - f64::from(u8::from(i == which as usize))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;

    fn split_room() -> SolvedMesh {
        let room = fixture::room(
            DVec3::new(-0.7, 0.1, 3.0),
            DVec3::new(0.7, 1.2, 4.3),
            fixture::grey(0.5, 0.0),
        );
        let solution = fixture::solve(&room, fixture::fronts(&room), 6, |_, _| (1.0, 1.0));
        SolvedMesh::new(&room, &solution)
    }

    #[test]
    fn joining_undoes_the_splits() {
        let mesh = split_room();
        let panels = Panels::new(&mesh);
        assert!(mesh.faces.len() > 1000);
        assert_eq!(panels.panels.len(), 12);
        assert_eq!(panels.leaves.len(), mesh.faces.len());
        for leaf in &panels.leaves {
            let panel = panels.panels[leaf.panel as usize];
            let corners = leaf
                .path
                .corners(panel.corners.map(|v| panels.positions[v as usize]));
            assert_eq!(corners, leaf.corners.map(|v| panels.positions[v as usize]));
        }
    }

    #[test]
    fn the_patch_under_a_point_holds_it() {
        let mesh = split_room();
        let panels = Panels::new(&mesh);
        let mut found = vec![false; mesh.faces.len()];
        for panel in &panels.panels {
            for i in 0..128 {
                for j in 0..128 - i {
                    // A third of a step off the corners, so that every small patch has some inside.
                    let [v, w] = [i, j].map(|k| (f64::from(k) + 1.0 / 3.0) / 128.0);
                    let (leaf, local) = panels.leaf_at(panel, [1.0 - v - w, v, w]);
                    found[leaf] = true;
                    assert!(panels.leaf_range(panel).contains(&leaf));
                    assert!(local.iter().all(|&x| (0.0..=1.0).contains(&x)), "{local:?}");
                    let mix = |corners: [u32; 3], weights: [f64; 3]| -> DVec3 {
                        (0..3)
                            .map(|k| panels.positions[corners[k] as usize] * weights[k])
                            .sum()
                    };
                    let here = mix(panels.leaves[leaf].corners, local);
                    let there = mix(panel.corners, [1.0 - v - w, v, w]);
                    assert!((here - there).length() < 1e-13);
                }
            }
        }
        assert!(
            found.iter().all(|&f| f),
            "a grid of 1/128 meets every patch of level 6"
        );
    }

    #[test]
    fn a_mesh_without_splits_is_left_as_it_is() {
        let mut mesh = split_room();
        // Every other patch gone: nothing can be joined.
        let mut keep = false;
        mesh.faces.retain(|_| {
            keep = !keep;
            keep
        });
        let panels = Panels::new(&mesh);
        let leaves: u32 = panels.panels.iter().map(|p| p.leaf_count).sum();
        assert_eq!(leaves as usize, mesh.faces.len());
    }
}
