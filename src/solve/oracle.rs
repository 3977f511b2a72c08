//! The oracle: what is to become of a pair (source, receiver) (paper, section 4 and 5.3).
//!
//! A pair ends without exchange only on proof, or by lot. It is split until both ends are facets, patches or
//! clusters flat enough for one vector to stand for them; then BFA = radiosity x form factor x area,
//! the power that it carries, decides.
//!
//! Weak pairs are played for (Russian roulette; Arvo and Kirk 1990): a pair that carries a tenth of a stake goes on
//! with a chance of one in ten, and then with ten times its light. The mean is that of going on always, and the work
//! below follows the power instead of the number of pairs, which grows with the square of the scene.

use super::element::{Element, Shape};
use super::form_factor_bound::form_factor_bound;
use super::form_factor_estimate::oracle_form_factor;

/// What to do with a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decision {
    /// Nothing is exchanged: proved.
    Nothing,
    /// Go on with this chance, between 0 and 1, and then with so much more light that the mean is the same.
    Play(f64),
    /// Exchange energy at this level: the power that it carries, greatest channel.
    Exchange(f64),
    /// Replace the source by its children. The pair carries about so much power, greatest channel, estimated from
    /// above.
    SplitSource(f64),
    /// Replace the receiver by its children; likewise.
    SplitReceiver(f64),
}

/// Settings of the oracle, in the units of the pass.
#[derive(Clone, Copy, Debug)]
pub struct Oracle {
    /// Power below which a pair exchanges.
    pub threshold: f64,
    /// Irradiance of a receiver that an exchange may leave unresolved: beyond it the receiver is split.
    pub irradiance_tolerance: f64,
    /// Power that a pair which was played for may carry.
    pub played_power: f64,
    /// Irradiance that a pair which was played for may leave on its receiver.
    pub played_irradiance: f64,
    /// Least area of a patch, normalised.
    pub min_area: f32,
    /// Depth below a surface within which nothing counts, normalised.
    pub tau: f32,
}

/// Cosine of the widest cone of normals that one irradiance vector may stand for: 20 degrees. Within it
/// the vector is exact for the normals; what is lost is the spread of the positions.
const CLUSTER_CONE_COS: f32 = 0.939_692_6;
/// Gap, in radii of a cluster, from which it may stand as one: nearer, its outline matters.
const CLUSTER_GAP: f32 = 2.0;
/// Gap, in radii, from which most parts of a cluster are flat and far enough to stand as one.
const PART_GAP: f32 = 4.0;
/// Stakes over the threshold: of pairs that would have to be taken apart because an end is a volume, too near or too
/// bent, and of those that could exchange. Measured (`bench/runs/`, accuracy): an eighth for the latter leaves the
/// error of cornell, d, f, corridor and two-rooms the same within the noise for 20 to 34 % fewer exchanges; a quarter
/// takes d from 0.84 to 0.93 % for 10 % more.
const SPLIT_STAKE: f64 = 0.25;
const EXCHANGE_STAKE: f64 = 0.125;
/// Share of its area that a closed convex surface shows from afar, in the mean over directions (Cauchy 1841). A bent
/// cluster carries about so much less than its bound, and may be played for accordingly. Near its surface the bound may be
/// all that there is, so it counts from [`CLUSTER_GAP`] on. Measured (`bench/runs/`, accuracy/bent_stakes.csv): the
/// errors stay within their noise, c's later passes look at a third fewer pairs; half of it takes two-rooms from 0.59 to 0.61 %.
const BENT_SHOWS: f64 = 0.25;
/// Nothing counts for more than so many times its light, lest dark corners turn into a few bright spots.
const MOST_WEIGHT: f64 = 1.0e3;
/// Chance from which a pair is not played for: nothing would be gained, and a pair that has won must not be played
/// again because of rounding.
const SURE: f64 = 0.999;
/// Share of the threshold from which the receiver of a partly blocked pair is split: two levels below what BFA
/// asks. Measured against the path-traced reference (`bench/runs/`, accuracy): in the Cornell box a quarter leaves an RMS error
/// of 1.7 %, this 1.2 % for 1.6 times the time, a sixteenth of it 1.1 % for 5 times. With light left part by part: a quarter 1.03 %,
/// this 0.68 % (accuracy/parts.md).
const PARTIAL_SHARE: f64 = 1.0 / 16.0;
/// Share of the threshold that may ride on the light being no more than linear over its source ([`super::uneven_source`]).
/// Measured (`bench/runs/`, accuracy/linear_sources.md): a quarter of it changes no error and takes 6 to 20 % more
/// exchanges, four times it takes two-rooms at 1e-4 from 2.00 to 2.29 %.
const UNEVEN_SHARE: f64 = 1.0 / 8.0;
/// A patch is not split once its radius is this many tau: its samples would start inside the margins.
const LEAST_RADIUS_IN_TAU: f32 = 16.0;

/// About how many parts of an element exchange over a gap: those small enough to stand as one.
fn parts_at(element: &Element, gap: f32) -> f32 {
    if element.is_triangle() {
        return 1.0;
    }
    let radii = PART_GAP * element.radius / gap.max(f32::MIN_POSITIVE);
    (radii * radii).clamp(1.0, element.facet_count as f32)
}

/// What an element that bends beyond a hemisphere shows of itself over a gap.
fn share_shown(element: &Element, gap: f32) -> f64 {
    let is_bent = element.shape == Shape::Cluster && element.cone_cos <= 0.0;
    if is_bent && gap > CLUSTER_GAP * element.radius {
        BENT_SHOWS
    } else {
        1.0
    }
}

impl Oracle {
    /// Decides a pair whose source has the unshot radiosity `radiosity` (greatest channel, positive), `weight` times
    /// its own since it was played for.
    pub fn decide(
        &self,
        source: &Element,
        receiver: &Element,
        radiosity: f64,
        weight: f64,
    ) -> Decision {
        if source.overlaps(receiver) {
            return self.decide_overlapping(source, receiver);
        }
        if source.faces_away(receiver, self.tau) || receiver.faces_away(source, self.tau) {
            return Decision::Nothing;
        }
        let power = radiosity * f64::from(source.area);
        let source_exchanges = self.exchanges(source, receiver);
        let receiver_exchanges = self.exchanges(receiver, source);
        if !(source_exchanges && receiver_exchanges) {
            let gap = source.bounds.distance(receiver.bounds);
            let bound = power * f64::from(form_factor_bound(source, receiver, gap));
            let likely = bound * share_shown(source, gap) * share_shown(receiver, gap);
            if let Some(chance) = self.chance(SPLIT_STAKE, receiver, likely, weight) {
                return Decision::Play(chance);
            }
            return match (source_exchanges, receiver_exchanges) {
                (true, false) => Decision::SplitReceiver(bound),
                (false, true) => Decision::SplitSource(bound),
                _ if source.radius >= receiver.radius => Decision::SplitSource(bound),
                _ => Decision::SplitReceiver(bound),
            };
        }
        let carried = power * f64::from(oracle_form_factor(source, receiver));
        if let Some(chance) = self.chance(EXCHANGE_STAKE, receiver, carried, weight) {
            return Decision::Play(chance);
        }
        if carried < self.threshold {
            return Decision::Exchange(carried);
        }
        self.split_larger(source, receiver, carried)
    }

    /// The chance of a pair that carries about `power`, `weight` times its own, if it is played for. The stake is a share
    /// of the threshold, but no more than may fall on the receiver at once: small receivers would become speckled.
    fn chance(&self, share: f64, receiver: &Element, power: f64, weight: f64) -> Option<f64> {
        let chance = (power / self.stake(share, receiver.area)).max(weight / MOST_WEIGHT);
        (chance < SURE).then_some(chance)
    }

    /// The power from which pairs with a receiver of this area are not played for.
    fn stake(&self, share: f64, area: f32) -> f64 {
        let most = self.played_irradiance * f64::from(area);
        (share * self.threshold).min(self.played_power).min(most)
    }

    /// About how many exchanges lie below a pair that carries `power` over `gap`: each carries up to the threshold, and clusters
    /// that are too near or too bent to exchange have to be taken apart, whatever they carry; but of weak parts only
    /// those exchange that win their lots.
    pub fn expected_exchanges(
        &self,
        source: &Element,
        receiver: &Element,
        gap: f32,
        power: f64,
    ) -> f32 {
        let receivers = parts_at(receiver, gap);
        let parts = parts_at(source, gap) * receivers;
        let won = power / self.stake(EXCHANGE_STAKE, receiver.area / receivers);
        (power / self.threshold).max(won.min(f64::from(parts))) as f32
    }

    /// True when an exchange would leave too coarse a light on its receiver: `residual` is how far the
    /// irradiance per unit radiosity strays from the linear function that would be deposited.
    pub fn refines_receiver(&self, receiver: &Element, radiosity: f64, residual: f32) -> bool {
        radiosity * f64::from(residual) > self.irradiance_tolerance && self.can_split(receiver)
    }

    /// True when the receiver of a pair whose samples were partly blocked is to be split further than BFA asks: a
    /// shadow's edge runs through it, and it `carried` enough; a weaker shadow falls on its parts as the samples say
    /// (`deposit.rs`). The source is not: over it visibility is averaged, by the samples of one exchange as well as by
    /// an exchange a part.
    pub fn refines_shadow(&self, receiver: &Element, carried: f64) -> bool {
        carried >= PARTIAL_SHARE * self.threshold && self.can_split(receiver)
    }

    /// True when a source's light is spread so unevenly over it that it may not shoot as one: the form factor is that
    /// of an even light, and the light that hides behind a wall would be missed by both sides of it. `variance` is
    /// the relative variance of its radiosity, `carried` what the exchange would carry.
    pub fn refines_source(
        &self,
        source: &Element,
        receiver: &Element,
        carried: f64,
        variance: f32,
    ) -> bool {
        if variance <= 0.0 {
            return false;
        }
        let gap = source.bounds.distance(receiver.bounds);
        let change = (source.radius / gap.max(f32::MIN_POSITIVE)).min(1.0);
        carried * f64::from(variance.sqrt() * change) > UNEVEN_SHARE * self.threshold
    }

    fn split_larger(&self, source: &Element, receiver: &Element, carried: f64) -> Decision {
        match (self.can_split(source), self.can_split(receiver)) {
            (false, false) => Decision::Exchange(carried),
            (true, false) => Decision::SplitSource(carried),
            (false, true) => Decision::SplitReceiver(carried),
            (true, true) if source.area >= receiver.area => Decision::SplitSource(carried),
            (true, true) => Decision::SplitReceiver(carried),
        }
    }

    /// One end holds the other, or both are the same.
    fn decide_overlapping(&self, source: &Element, receiver: &Element) -> Decision {
        let larger = if source.facet_count >= receiver.facet_count {
            source
        } else {
            receiver
        };
        // Planar within tau, every facet in front of every other's plane by tau at most: no exchange.
        if larger.is_triangle() || (larger.cone_cos > 0.0 && larger.faces_away(larger, self.tau)) {
            Decision::Nothing
        } else if source.facet_count >= receiver.facet_count {
            Decision::SplitSource(f64::INFINITY)
        } else {
            Decision::SplitReceiver(f64::INFINITY)
        }
    }

    /// True when energy may be exchanged at `element` with `other` as the other end: any triangle, and a cluster that is
    /// far enough for its outline not to matter and for whose normals one vector stands: a narrow cone, and all of `other` in front.
    /// What is bent hides parts of itself, and one visibility says of none which (`bench/runs/`, accuracy/clusters.md).
    fn exchanges(&self, element: &Element, other: &Element) -> bool {
        match element.shape {
            Shape::Triangle(_) => true,
            Shape::Volume => false,
            Shape::Cluster => {
                element.bounds.distance(other.bounds) > CLUSTER_GAP * element.radius
                    && element.cone_cos >= CLUSTER_CONE_COS
                    && element.faces_fully(other, self.tau)
            }
        }
    }

    fn can_split(&self, element: &Element) -> bool {
        match element.shape {
            Shape::Triangle(_) => {
                element.area >= 4.0 * self.min_area
                    && element.radius > LEAST_RADIUS_IN_TAU * self.tau
            }
            _ => true,
        }
    }
}
