//! After a pass: push what was gathered down to the leaves, reflect it, pull the new radiosity up
//! (paper, section 4; Hanrahan et al. 1991).

use super::cluster_light::ClusterLight;
use super::facet_frame::FacetFrame;
use super::patch_split::PatchSplit;
use super::radiosity::{Gatherer, Light, Shooter};
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::{FacetId, NodeId};

/// What the push needs to know of the facets.
pub struct FacetProperties<'a, const C: usize> {
    /// Reflectance of each facet.
    pub reflectance: &'a [Light<C>],
    /// Where each facet lies.
    pub frames: &'a [FacetFrame],
}

/// Pushes an owner's gathered irradiance (times `scale`, the row normalisation) to its leaves, adds it to
/// their totals, and makes `shooter` the reflected light that the next pass shoots.
pub fn push_pull<const C: usize>(
    hierarchy: &Hierarchy,
    facets: &FacetProperties<C>,
    gatherer: &mut Gatherer<C>,
    shooter: &mut Shooter<C>,
    scale: f64,
) {
    shooter
        .splits
        .resize(gatherer.children.len(), PatchSplit::default());
    shooter.unshot.resize(gatherer.children.len(), [0.0; C]);
    push_nodes(hierarchy, facets, gatherer);
    for facet in 0..gatherer.facet_count {
        let reflectance = facets.reflectance[(gatherer.first_facet + facet) as usize];
        reflect(
            gatherer,
            shooter,
            facet as usize,
            [[0.0; C]; 3],
            &reflectance,
            scale,
        );
    }
}

/// Adds the light of clusters to their facets.
fn push_nodes<const C: usize>(
    hierarchy: &Hierarchy,
    facets: &FacetProperties<C>,
    gatherer: &mut Gatherer<C>,
) {
    if gatherer.clusters.is_empty() {
        return;
    }
    // (node, its place in depth-first order, sum of the light above it)
    let mut stack = vec![(gatherer.root, 0usize, [ClusterLight::ZERO; C])];
    while let Some((node, local, above)) = stack.pop() {
        let mut sum = std::mem::replace(&mut gatherer.clusters[local], [ClusterLight::ZERO; C]);
        for (sum, above) in sum.iter_mut().zip(&above) {
            sum.add(above, 1.0);
        }
        if hierarchy.node(node).kind == NodeKind::Facet {
            let facet = hierarchy.facet_of_leaf(node);
            let frame = &facets.frames[facet.index()];
            let corners = frame.corners();
            let gathered = &mut gatherer.gathered[(facet.0 - gatherer.first_facet) as usize];
            for (c, light) in sum.iter().enumerate() {
                let irradiance = light.on_facet(corners, frame.normal);
                for (corner, x) in gathered.iter_mut().zip(irradiance) {
                    corner[c] += x;
                }
            }
        } else if let Some([a, b]) = hierarchy.children(node) {
            let [la, lb] = local_children(hierarchy, a, local);
            stack.push((b, lb, sum));
            stack.push((a, la, sum));
        }
    }
}

/// Places of the two children in the owner's depth-first order: a subtree of k leaves has 2 k - 1 nodes.
pub fn local_children(hierarchy: &Hierarchy, first_child: NodeId, local: usize) -> [usize; 2] {
    let first = local + 1;
    let leaves = hierarchy.node(first_child).facet_count as usize;
    [first, first + 2 * leaves - 1]
}

/// Pushes irradiance down a facet's patches, reflects at the leaves, pulls radiosity up.
fn reflect<const C: usize>(
    gatherer: &mut Gatherer<C>,
    shooter: &mut Shooter<C>,
    at: usize,
    above: [Light<C>; 3],
    reflectance: &Light<C>,
    scale: f64,
) {
    let own = std::mem::replace(&mut gatherer.gathered[at], [[0.0; C]; 3]);
    let sum: [Light<C>; 3] =
        std::array::from_fn(|k| std::array::from_fn(|c| above[k][c] + own[k][c]));
    let first = gatherer.children[at] as usize;
    if first == 0 {
        for c in 0..C {
            // The fit may dip below zero at a corner where the truth does not; second sets of samples may too. What
            // is cut off here brightens a little.
            let irradiance = scale * ((sum[0][c] + sum[1][c] + sum[2][c]) / 3.0).max(0.0);
            gatherer.total[at][c] += irradiance;
            shooter.unshot[at][c] = (reflectance[c] * irradiance) as f32;
            let corners = sum.map(|corner| scale * corner[c] - irradiance);
            let slope = gatherer.slopes[at].map(|corner| corner[c]);
            let slope = with_slope(slope, corners, gatherer.total[at][c]);
            for (corner, x) in gatherer.slopes[at].iter_mut().zip(slope) {
                corner[c] = x;
            }
        }
        shooter.splits[at] = PatchSplit::default();
        return;
    }
    for which in 0..4 {
        let part = split_values(&sum, which);
        reflect(gatherer, shooter, first + which, part, reflectance, scale);
    }
    // The four children have equal areas.
    shooter.unshot[at] = std::array::from_fn(|c| {
        0.25 * (first..first + 4)
            .map(|k| shooter.unshot[k][c])
            .sum::<f32>()
    });
    let parts = std::array::from_fn(|k| shooter.unshot[first + k]);
    let variance = std::array::from_fn(|k| shooter.splits[first + k].variance);
    shooter.splits[at] = PatchSplit::new(first as u32, parts, variance);
}

/// A channel of a leaf's slope with what it has gathered at its `corners` beyond its mean, lessened where the leaf's
/// `total` would be below zero at a corner.
fn with_slope(slope: [f32; 3], corners: [f64; 3], total: f64) -> [f32; 3] {
    let sum: [f64; 3] = std::array::from_fn(|k| f64::from(slope[k]) + corners[k]);
    // Where a mean below zero was cut off the corners have a mean of their own.
    let mean = (sum[0] + sum[1] + sum[2]) / 3.0;
    let least = sum
        .iter()
        .fold(f64::INFINITY, |least, &x| least.min(x - mean));
    let share = if -least > total { total / -least } else { 1.0 };
    sum.map(|x| (share * (x - mean)) as f32)
}

/// Corner values of child `which` of a linear function, numbered as `split_triangle` does.
pub fn split_values<const C: usize>(values: &[Light<C>; 3], which: usize) -> [Light<C>; 3] {
    let mid = |i: usize, j: usize| -> Light<C> {
        std::array::from_fn(|c| 0.5 * (values[i][c] + values[j][c]))
    };
    let (ab, bc, ca) = (mid(0, 1), mid(1, 2), mid(2, 0));
    match which {
        0 => [values[0], ab, ca],
        1 => [ab, values[1], bc],
        2 => [ca, bc, values[2]],
        _ => [bc, ca, ab],
    }
}

/// Area-weighted sums over an owner's leaves of a function of (leaf index, its area): used by the ledger.
pub fn sum_leaves<const C: usize>(
    gatherer: &Gatherer<C>,
    facet_area: impl Fn(FacetId) -> f64,
    mut add: impl FnMut(FacetId, usize, f64),
) {
    let mut stack = Vec::new();
    for local in 0..gatherer.facet_count {
        let facet = FacetId(gatherer.first_facet + local);
        stack.push((local as usize, facet_area(facet)));
        while let Some((at, area)) = stack.pop() {
            match gatherer.children[at] as usize {
                0 => add(facet, at, area),
                first => stack.extend((first..first + 4).rev().map(|k| (k, area * 0.25))),
            }
        }
    }
}

/// Power that an owner's receivers gathered in this pass at all levels, before it is pushed.
pub fn gathered_power<const C: usize>(
    hierarchy: &Hierarchy,
    gatherer: &Gatherer<C>,
    facet_area: impl Fn(FacetId) -> f64,
) -> Light<C> {
    let mut sum = [0.0; C];
    let mut add = |light: &Light<C>, area: f64| {
        for c in 0..C {
            sum[c] += light[c] * area;
        }
    };
    let mut stack = Vec::new();
    for local in 0..gatherer.facet_count {
        stack.push((
            local as usize,
            facet_area(FacetId(gatherer.first_facet + local)),
        ));
        while let Some((at, area)) = stack.pop() {
            for corner in &gatherer.gathered[at] {
                add(corner, area / 3.0);
            }
            match gatherer.children[at] as usize {
                0 => {}
                first => stack.extend((first..first + 4).map(|k| (k, area * 0.25))),
            }
        }
    }
    let mut nodes = vec![(gatherer.root, 0usize)];
    while let Some((node, local)) = nodes.pop() {
        let Some(light) = gatherer.clusters.get(local) else {
            break;
        };
        let area_vector = hierarchy.shape(node).area_vector.as_dvec3();
        add(
            &std::array::from_fn(|c| light[c].vector.dot(area_vector)),
            1.0,
        );
        if let Some([a, b]) = hierarchy.children(node) {
            let [la, lb] = local_children(hierarchy, a, local);
            nodes.extend([(a, la), (b, lb)]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::radiosity::{Slope, inherited};
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A child made later holds what it would hold had it been there when the light came.
        #[test]
        fn children_inherit_the_linear_function_of_their_parent(
            corners in prop::array::uniform3(0.0..8.0f64),
            which in 0..4usize,
        ) {
            let mean = (corners[0] + corners[1] + corners[2]) / 3.0;
            let slope = with_slope([0.0; 3], corners.map(|x| x - mean), mean);
            let slope: Slope<1> = slope.map(|x| [x]);
            let ([mean], slope) = inherited(&[mean], &slope, which);
            let expected = split_values(&corners.map(|x| [x]), which);
            for (slope, [expected]) in slope.into_iter().zip(expected) {
                prop_assert!((mean + f64::from(slope[0]) - expected).abs() < 1.0e-5);
            }
        }

        #[test]
        fn a_slope_leaves_no_corner_below_zero_and_adds_no_light(
            before in prop::array::uniform2(-4.0..4.0f32),
            corners in prop::array::uniform3(-8.0..8.0f64),
            total in 0.0..8.0f64,
        ) {
            let slope = with_slope([before[0], before[1], -before[0] - before[1]], corners, total);
            let slope = slope.map(f64::from);
            prop_assert!(slope.iter().sum::<f64>().abs() < 1.0e-5);
            prop_assert!(slope.iter().all(|x| total + x > -1.0e-5));
            // All of it is kept where it fits.
            let wanted = (0..3).map(|k| f64::from([before[0], before[1], -before[0] - before[1]][k]) + corners[k]);
            let wanted: Vec<f64> = wanted.collect();
            let mean = wanted.iter().sum::<f64>() / 3.0;
            if wanted.iter().all(|x| total + x - mean > 1.0e-5) {
                for (slope, wanted) in slope.iter().zip(&wanted) {
                    prop_assert!((slope - (wanted - mean)).abs() < 1.0e-5);
                }
            }
        }
    }
}
