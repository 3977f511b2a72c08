//! Irradiance at the vertices of patches, for smooth shading with creases kept.
//!
//! At every vertex the patches around it fall into groups of nearly equal normals; the group's
//! value is that of its patches ([`super::vertex_value`]). A vertex on the edge of a larger patch counts for that patch
//! too, so that both sides of the edge see the same values ([`super::mean_value`]). Irradiance is
//! averaged and not radiosity, because it goes on smoothly where the material changes; radiosity
//! follows from it by the patch's own reflectance.

use super::SolvedMesh;
use super::incidence::{Incident, IncidentTable};
use super::mean_value::{BorderValue, interpolate};
use super::panel::Panels;
use super::vertex_value::{CREASE_COSINE, VertexValues};
use glam::DVec3;

/// Patches before it at a vertex with which a patch is compared: all of them, but for the hub of a
/// fan of hundreds of triangles, whose neighbours stand close in the file anyway.
const GROUP_WINDOW: usize = 256;

/// A vertex on the edge of a patch, corners left out.
#[derive(Clone, Copy, Debug)]
struct Hanging {
    /// Index into the values.
    value: u32,
    /// Place on the edge, in (0, 1), from corner `edge` to the next.
    along: f32,
    /// Which edge.
    edge: u8,
}

/// Values at the borders of all patches.
#[derive(Clone, Debug)]
pub(crate) struct Smoothing {
    /// One a vertex and group of normals.
    values: Vec<[f32; 3]>,
    /// The values at the corners of each patch.
    corners: Vec<[u32; 3]>,
    /// Further values on the edges of the patches, ordered along the border.
    hanging: Vec<Hanging>,
    /// `hanging[first_hanging[i] .. first_hanging[i + 1]]` are those of patch `i`.
    first_hanging: Vec<u32>,
}

impl Smoothing {
    /// Fits the irradiance of `mesh` around the vertices of `panels`, which are its panels.
    pub fn new(mesh: &SolvedMesh, panels: &Panels) -> Self {
        let normals: Vec<DVec3> = panels.panels.iter().map(|p| panels.normal(p)).collect();
        let incidents = IncidentTable::new(panels);
        let vertex_values = VertexValues {
            mesh,
            panels,
            incidents: &incidents,
            normals: &normals,
        };
        let mut values = Vec::with_capacity(panels.positions.len());
        let mut corners = vec![[0u32; 3]; panels.leaves.len()];
        let mut hanging: Vec<(u32, Hanging)> = Vec::new();
        let mut groups = Vec::new();
        for vertex in 0..panels.positions.len() {
            let around = incidents.of(vertex);
            group_by_normal(around, panels, &normals, &mut groups);
            for group in 0..around.len() as u32 {
                // A group bears the number of its first patch.
                if groups[group as usize] != group {
                    continue;
                }
                let members =
                    || (around.iter().zip(&groups)).filter_map(|(i, &g)| (g == group).then_some(i));
                // An edge that only other surfaces meet at this vertex needs no value here.
                if !members().any(|i| i.slot < 3) {
                    continue;
                }
                let id = values.len() as u32;
                values.push(vertex_values.value(vertex, members()));
                for incident in members() {
                    match incident.slot {
                        slot @ 0..3 => corners[incident.leaf as usize][slot as usize] = id,
                        slot => hanging.push((
                            incident.leaf,
                            Hanging {
                                value: id,
                                along: incident.along,
                                edge: slot - 3,
                            },
                        )),
                    }
                }
            }
        }
        hanging.sort_by(|(i, a), (j, b)| {
            (i, a.edge)
                .cmp(&(j, b.edge))
                .then(a.along.total_cmp(&b.along))
        });
        let mut first_hanging = vec![0u32; panels.leaves.len() + 1];
        for (leaf, _) in &hanging {
            first_hanging[*leaf as usize + 1] += 1;
        }
        for i in 1..first_hanging.len() {
            first_hanging[i] += first_hanging[i - 1];
        }
        Self {
            values,
            corners,
            hanging: hanging.into_iter().map(|(_, h)| h).collect(),
            first_hanging,
        }
    }

    /// The irradiance at barycentric `weights` in patch `leaf`.
    pub fn irradiance(&self, leaf: usize, weights: [f64; 3]) -> [f64; 3] {
        let value = |id: u32| self.values[id as usize].map(f64::from);
        let corners = self.corners[leaf].map(value);
        let extra =
            &self.hanging[self.first_hanging[leaf] as usize..self.first_hanging[leaf + 1] as usize];
        if extra.is_empty() {
            return std::array::from_fn(|c| (0..3).map(|i| weights[i] * corners[i][c]).sum());
        }
        let mut border = Vec::with_capacity(3 + extra.len());
        let mut rest = extra.iter().peekable();
        for edge in 0..3u8 {
            let corner = usize::from(edge);
            let mut at = [0.0; 3];
            at[corner] = 1.0;
            border.push(BorderValue {
                weights: at,
                value: corners[corner],
            });
            while let Some(h) = rest.next_if(|h| h.edge == edge) {
                let along = f64::from(h.along);
                let mut at = [0.0; 3];
                at[corner] = 1.0 - along;
                at[(corner + 1) % 3] = along;
                border.push(BorderValue {
                    weights: at,
                    value: value(h.value),
                });
            }
        }
        interpolate(&border, weights)
    }
}

/// Numbers the groups of patches whose normals are close, or joined by a chain of close ones.
fn group_by_normal(around: &[Incident], panels: &Panels, normals: &[DVec3], groups: &mut Vec<u32>) {
    let normal = |i: usize| normals[panels.leaves[around[i].leaf as usize].panel as usize];
    groups.clear();
    groups.extend(0..around.len() as u32);
    for i in 1..around.len() {
        for j in i.saturating_sub(GROUP_WINDOW)..i {
            let (old, new) = (groups[i].max(groups[j]), groups[i].min(groups[j]));
            if old != new && normal(i).dot(normal(j)) >= CREASE_COSINE {
                for group in &mut groups[..=i] {
                    if *group == old {
                        *group = new;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::floor_and_wall;
    use super::*;

    /// Smooth irradiance of the floor at (x, y).
    fn on_floor(panels: &Panels, smoothing: &Smoothing, x: f64, y: f64) -> f64 {
        let (panel, weights) = if x >= y {
            (&panels.panels[0], [1.0 - x, x - y, y])
        } else {
            (&panels.panels[1], [1.0 - y, x, y - x])
        };
        let (leaf, local) = panels.leaf_at(panel, weights);
        smoothing.irradiance(leaf, local.map(|w| w.clamp(0.0, 1.0)))[0]
    }

    #[test]
    fn neighbours_agree_on_their_edges_whatever_their_sizes() {
        let mesh = floor_and_wall();
        let panels = Panels::new(&mesh);
        assert_eq!(panels.panels.len(), 4);
        let smoothing = Smoothing::new(&mesh, &panels);
        assert!(smoothing.hanging.len() > 100);
        let (mut tried, mut varied) = (0, 0);
        for leaf in (panels.leaves.iter()).filter(|l| l.panel < 2) {
            for edge in 0..3 {
                let at = |v: u32| panels.positions[v as usize];
                let (a, b) = (at(leaf.corners[edge]), at(leaf.corners[(edge + 1) % 3]));
                let across = DVec3::Z.cross(b - a).normalize() * 1e-9;
                for t in [0.11, 0.37, 0.52, 0.83] {
                    let (p, q) = (a.lerp(b, t) + across, a.lerp(b, t) - across);
                    if [p.x, p.y, q.x, q.y]
                        .iter()
                        .any(|x| !(0.0..=1.0).contains(x))
                    {
                        continue;
                    }
                    let (here, there) = (
                        on_floor(&panels, &smoothing, p.x, p.y),
                        on_floor(&panels, &smoothing, q.x, q.y),
                    );
                    assert!((here - there).abs() < 1e-5, "{p} {here} {q} {there}");
                    tried += 1;
                    // Agreement would mean nothing if the field were flat.
                    varied += usize::from((here - 1.5).abs() > 1e-3);
                }
            }
        }
        assert!(tried > 1000 && varied > 500, "{tried} {varied}");
    }

    #[test]
    fn creases_keep_surfaces_apart() {
        let mesh = floor_and_wall();
        let panels = Panels::new(&mesh);
        let smoothing = Smoothing::new(&mesh, &panels);
        for (i, leaf) in panels.leaves.iter().enumerate() {
            let range = if leaf.panel < 2 { 1.0..=2.0 } else { 5.0..=6.0 };
            for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.3, 0.5]] {
                let [e, ..] = smoothing.irradiance(i, weights);
                assert!(range.contains(&e), "{i}: {e}");
            }
        }
    }

    /// A black patch is one behind furniture: its neighbours must not darken towards it.
    #[test]
    fn hidden_patches_do_not_seep() {
        let mut mesh = floor_and_wall();
        let panels = Panels::new(&mesh);
        let mut hidden = 0;
        for (i, face) in mesh.faces.iter_mut().enumerate() {
            let black = i % 5 == 0;
            hidden += usize::from(black);
            face.irradiance = [if black { 0.0 } else { 1.0 }; 3];
        }
        assert!(hidden > 100);
        let smoothing = Smoothing::new(&mesh, &panels);
        for (i, face) in mesh.faces.iter().enumerate() {
            let [e, ..] = smoothing.irradiance(i, [0.3, 0.3, 0.4]);
            // A black patch may stand alone at a corner; lit ones are lit throughout.
            assert!(face.irradiance[0] == 0.0 || (e - 1.0).abs() < 1e-6, "{e}");
        }
        // Dim, but far from black: an open shadow, which does count.
        for face in &mut mesh.faces {
            face.irradiance = face.irradiance.map(|e| e.max(0.2));
        }
        let smoothing = Smoothing::new(&mesh, &panels);
        let darkened = (mesh.faces.iter().enumerate())
            .filter(|(i, face)| {
                face.irradiance[0] == 1.0 && smoothing.irradiance(*i, [0.3, 0.3, 0.4])[0] < 0.99
            })
            .count();
        assert!(darkened > 100, "{darkened}");
    }

    /// Whatever the sizes of the patches: a mean of them alone errs by up to half the slope over a patch.
    #[test]
    fn an_even_slope_is_kept() {
        let mut mesh = floor_and_wall();
        let panels = Panels::new(&mesh);
        let slope = |p: DVec3| 3.0 + 2.0 * p.x - p.y;
        for (face, leaf) in mesh.faces.iter_mut().zip(&panels.leaves) {
            let [a, b, c] = leaf.corners.map(|v| panels.positions[v as usize]);
            face.irradiance = [slope((a + b + c) / 3.0) as f32; 3];
        }
        let smoothing = Smoothing::new(&mesh, &panels);
        let incidents = IncidentTable::new(&panels);
        let inside = |x: f64| x > 0.0 && x < 1.0;
        let (mut tried, mut uneven) = (0, 0);
        for (i, leaf) in panels
            .leaves
            .iter()
            .enumerate()
            .filter(|(_, l)| l.panel < 2)
        {
            for (k, &vertex) in leaf.corners.iter().enumerate() {
                let p = panels.positions[vertex as usize];
                if !inside(p.x) || !inside(p.y) {
                    continue;
                }
                let mut weights = [0.0; 3];
                weights[k] = 1.0;
                let [e, ..] = smoothing.irradiance(i, weights);
                let around = incidents.of(vertex as usize);
                let size = |l: u32| {
                    let [a, b, c] =
                        (panels.leaves[l as usize].corners).map(|v| panels.positions[v as usize]);
                    (b - a).length().max((c - b).length()).max((a - c).length())
                };
                let sizes = around.iter().map(|i| size(i.leaf));
                let (least, most) =
                    sizes.fold((f64::INFINITY, 0.0f64), |(a, b), s| (a.min(s), b.max(s)));
                let error = (e - slope(p)).abs() / most;
                assert!(
                    error < 1.0e-2,
                    "{p}: {e} for {}, patches of {least} to {most}",
                    slope(p)
                );
                tried += 1;
                uneven += usize::from(most > 1.5 * least);
            }
        }
        assert!(tried > 1000 && uneven > 500, "{tried} {uneven}");
    }

    #[test]
    fn a_uniform_field_stays_uniform() {
        let mut mesh = floor_and_wall();
        for face in &mut mesh.faces {
            face.irradiance = [0.25; 3];
        }
        let panels = Panels::new(&mesh);
        let smoothing = Smoothing::new(&mesh, &panels);
        for i in 0..panels.leaves.len() {
            let [e, ..] = smoothing.irradiance(i, [0.3, 0.3, 0.4]);
            assert!((e - 0.25).abs() < 1e-6);
        }
    }
}
