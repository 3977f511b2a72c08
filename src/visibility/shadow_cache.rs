//! Rectangles that blocked segments of a task's earlier exchanges, tried on those of the next before Embree is asked:
//! technique `blockers` (design, section 7, point 4).
//!
//! Neighbours in the walk have their shadows from the same few rectangles (Haines and Greenberg's light buffer, 1986, keeps
//! the last blocker of each light for the same reason). Partly blocked pairs profit too, of which nothing can be proved as a whole.

use super::account::Account;
use super::occluder_tree::OccluderTree;
use super::sampling::SampleOctet;
use super::screen::Screen;
use pulp::{Arch, Simd, WithSimd};

/// How many rectangles are kept: of the blocked rays of c, d and e, eight answer 2 % more and cost as much more; two answer 3 to 5 %
/// fewer.
const KEPT: usize = 4;
/// Octets in a row of which a rectangle blocked nothing, and then is dropped.
const MOST_IDLE: u8 = 64;
/// Rays that Embree has to find blocked in an octet for their blocker to be looked for.
const LEAST_BLOCKED: u32 = 2;
/// How many occasions to look for a blocker may be passed over at most, after as many vain ones in a row.
const MOST_REST: u32 = 63;

/// Costs in packets of eight rays: an octet against one rectangle, and a walk for the rectangle that a ray crosses.
const SCREEN_COST: f64 = 0.02;
const WALK_COST: f64 = 0.25;
/// And of a packet through Embree, by its rays: up to three go one by one, at half to nine tenths of the price of a packet,
/// which costs little less for being half empty (`bench/runs/`, embree_packets).
const PACKET_COST: [f64; 9] = [0.0, 0.23, 0.46, 0.65, 0.8, 0.85, 0.9, 0.95, 1.0];

/// The rectangles that blocked last, the latest first.
#[derive(Clone, Debug)]
pub struct ShadowCache {
    kept: Vec<Kept>,
    stack: Vec<u32>,
    /// Searches in vain since the last one that found something.
    vain: u32,
    /// How many occasions to search are to be passed over.
    rest: u32,
    account: Account,
    arch: Arch,
}

#[derive(Clone, Copy, Debug)]
struct Kept {
    id: u32,
    screen: Screen,
    idle: u8,
}

impl Default for ShadowCache {
    fn default() -> Self {
        Self {
            kept: Vec::with_capacity(KEPT),
            stack: Vec::new(),
            vain: 0,
            rest: 0,
            account: Account::default(),
            arch: Arch::new(),
        }
    }
}

impl ShadowCache {
    /// What it cost and saved so far.
    pub fn account(&self) -> Account {
        self.account
    }

    /// Bit per lane of `active`: a kept rectangle surely blocks the segment.
    #[inline(always)]
    pub(super) fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8 {
        if self.kept.is_empty() {
            return 0;
        }
        let blocked = self.arch.dispatch(CacheKernel {
            cache: self,
            octet,
            active,
        });
        let cost = |rays: u8| PACKET_COST[rays.count_ones() as usize];
        self.account.saved += cost(active) - cost(active & !blocked);
        blocked
    }

    /// Takes note of segments that something else was found to block; keeps a rectangle that one of them crosses.
    pub(super) fn learn(&mut self, tree: &OccluderTree, octet: &SampleOctet, blocked: u8) {
        if blocked.count_ones() < LEAST_BLOCKED {
            return;
        }
        if self.rest > 0 {
            self.rest -= 1;
            return;
        }
        let lane = blocked.trailing_zeros() as usize;
        self.account.spent += WALK_COST;
        let found = tree.screen_across(octet.from(lane), octet.to(lane), &mut self.stack);
        // One that is kept already did not block the segment surely.
        let found = found.filter(|(id, _)| self.kept.iter().all(|kept| kept.id != *id));
        let Some((id, screen)) = found else {
            self.vain += 1;
            self.rest = self.vain.min(MOST_REST);
            return;
        };
        self.vain = 0;
        self.kept.truncate(KEPT - 1);
        let latest = Kept {
            id,
            screen,
            idle: 0,
        };
        self.kept.insert(0, latest);
    }
}

/// The kept rectangles against an octet, for one instruction set.
struct CacheKernel<'a> {
    cache: &'a mut ShadowCache,
    octet: &'a SampleOctet,
    active: u8,
}

impl WithSimd for CacheKernel<'_> {
    type Output = u8;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> u8 {
        let kept = &mut self.cache.kept;
        let mut blocked = 0;
        let mut at = 0;
        while at < kept.len() && blocked != self.active {
            self.cache.account.spent += SCREEN_COST;
            let more = kept[at].screen.blocks(self.octet) & self.active & !blocked;
            if more == 0 {
                kept[at].idle += 1;
                if kept[at].idle == MOST_IDLE {
                    kept.remove(at);
                    continue;
                }
            } else {
                kept[at].idle = 0;
                // Whoever blocks half of them is tried first next time.
                if 2 * more.count_ones() >= self.active.count_ones() {
                    kept[..=at].rotate_right(1);
                }
                blocked |= more;
            }
            at += 1;
        }
        blocked
    }
}
