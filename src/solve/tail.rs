//! The light of the passes that are not made: the last pass's, as a geometric series.
//!
//! Shooting the unshot light again and again is a power iteration on the transport (Golub and Van Loan, section 7.3):
//! after some passes each brings what the one before brought, r times as strong, with r the greatest eigenvalue. All that are
//! left out bring together the last one's irradiance times r + r^2 + ... = r / (1 - r). That sum is in
//! proportion to the power left unshot, so an error of its spread is one of a small part.

use super::push_pull::sum_leaves;
use super::radiosity::{Gatherer, Light, Shooter};
use super::solver::{Solver, mean};
use crate::math::FacetId;
use rayon::prelude::*;

/// Greatest ratio of two passes that is summed: beyond it rounding decides what the sum is.
const GREATEST_RATIO: f64 = 1.0 - 1.0e-6;

/// Irradiance times area over an owner's leaves that reflect: of all passes made, and of those left out.
type Arrived<const C: usize> = [Light<C>; 2];

impl<const C: usize> Solver<'_, C> {
    /// Adds what the passes left out would bring, where the last one shot the power `shot`: the power
    /// that arrives with them, mean of the channels. A channel that does not fall off stays as it is; in all
    /// others nothing is left unshot.
    pub(super) fn add_tail(&mut self, shot: &Light<C>) -> f64 {
        let unshot = self.unshot_power();
        let factors: Light<C> = std::array::from_fn(|c| tail_factor(shot[c], unshot[c]));
        let table = &self.table;
        let area = |facet: FacetId| table.areas[facet.index()];
        let parts: Vec<Arrived<C>> = (self.light.gatherers.par_iter_mut())
            .zip(&mut self.light.shooters)
            .map(|(gatherer, shooter)| {
                let mut arrived = [[0.0; C]; 2];
                change_leaves(gatherer, area, |facet, at, area, total| {
                    let reflectance = table.reflectance[facet.index()];
                    for c in (0..C).filter(|&c| reflectance[c] > 0.0) {
                        let more = irradiance(shooter, at, c, reflectance[c], factors[c]);
                        arrived[0][c] += area * total[c];
                        arrived[1][c] += area * more;
                        total[c] += more;
                    }
                });
                arrived
            })
            .collect();
        let [made, more]: Arrived<C> =
            std::array::from_fn(|k| std::array::from_fn(|c| parts.iter().map(|p| p[k][c]).sum()));
        // What reflects nothing keeps no memory of the last pass: it gets the mean share.
        let shares: Light<C> = std::array::from_fn(|c| match made[c] > 0.0 {
            true => more[c] / made[c],
            false => 0.0,
        });
        let black: Vec<f64> = (self.light.gatherers.par_iter_mut())
            .map(|gatherer| {
                let mut sum = 0.0;
                change_leaves(gatherer, area, |facet, _, area, total| {
                    let reflectance = table.reflectance[facet.index()];
                    for c in (0..C).filter(|&c| reflectance[c] <= 0.0) {
                        let more = shares[c] * total[c];
                        sum += area * more;
                        total[c] += more;
                    }
                });
                sum / C as f64
            })
            .collect();
        mean(&more) + black.iter().sum::<f64>()
    }
}

/// Irradiance of a leaf in the passes left out; nothing is left unshot then.
fn irradiance<const C: usize>(
    shooter: &mut Shooter<C>,
    at: usize,
    channel: usize,
    reflectance: f64,
    factor: f64,
) -> f64 {
    if factor == 0.0 {
        return 0.0;
    }
    let last = std::mem::take(&mut shooter.unshot[at][channel]);
    factor * f64::from(last) / reflectance
}

/// Calls `change` with every leaf of an owner: its facet, its place, its area and its irradiance of all passes.
fn change_leaves<const C: usize>(
    gatherer: &mut Gatherer<C>,
    facet_area: impl Fn(FacetId) -> f64,
    mut change: impl FnMut(FacetId, usize, f64, &mut Light<C>),
) {
    let mut total = std::mem::take(&mut gatherer.total);
    sum_leaves(gatherer, facet_area, |facet, at, area| {
        change(facet, at, area, &mut total[at]);
    });
    gatherer.total = total;
}

/// Sum of the powers of the ratio of two passes; 0 where they do not fall off.
fn tail_factor(shot: f64, unshot: f64) -> f64 {
    let ratio = unshot / shot;
    match ratio <= GREATEST_RATIO {
        true => ratio / (1.0 - ratio),
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tail_is_a_geometric_series() {
        // 1/2 + 1/4 + 1/8 + ... = 1, and no sum where nothing was shot or nothing falls off.
        assert_eq!(tail_factor(2.0, 1.0), 1.0);
        assert_eq!(tail_factor(4.0, 1.0), 1.0 / 3.0);
        for (shot, unshot) in [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 1.5)] {
            assert_eq!(tail_factor(shot, unshot), 0.0);
        }
    }
}
