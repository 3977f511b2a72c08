//! Counts and times of a solve; the keys are those of `stats.json`.

use serde::Serialize;

/// One pass. Counts are exact and the same at any number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PassStatistics {
    /// 1 is direct light.
    pub pass: u32,
    /// Wall time.
    pub seconds: f64,
    /// Transfers evaluated, whatever their visibility.
    pub exchanges: u64,
    /// Those whose rays were all blocked.
    pub exchanges_blocked: u64,
    /// Those whose rays were all clear.
    pub exchanges_sampled_clear: u64,
    /// Rays cast through Embree.
    pub rays: u64,
    /// Those that were blocked.
    pub rays_blocked: u64,
    /// Sample segments tested natively.
    pub native_rays: u64,
    /// Those that were blocked.
    pub native_rays_blocked: u64,
    /// Pairs queried for a guarantee, counted once a pair whichever of the two queries ran.
    pub shafts: u64,
    /// Pairs proved fully occluded.
    pub occluded_claims: u64,
    /// Pairs proved fully visible.
    pub visible_claims: u64,
    /// Exchanges that needed no ray because visibility was proved.
    pub exchanges_visible: u64,
    /// Power still to be shot at the pass's end, in W, mean of the channels.
    pub unshot: f64,
}

impl PassStatistics {
    /// Adds the counts of a part of the pass.
    pub fn add_counts(&mut self, part: &Self) {
        self.exchanges += part.exchanges;
        self.exchanges_blocked += part.exchanges_blocked;
        self.exchanges_sampled_clear += part.exchanges_sampled_clear;
        self.rays += part.rays;
        #[cfg(feature = "plant-regressions")]
        {
            self.rays += super::planted::rays_too_many();
        }
        self.rays_blocked += part.rays_blocked;
        self.native_rays += part.native_rays;
        self.native_rays_blocked += part.native_rays_blocked;
        self.shafts += part.shafts;
        self.occluded_claims += part.occluded_claims;
        self.visible_claims += part.visible_claims;
        self.exchanges_visible += part.exchanges_visible;
    }
}

/// Where the emitted power went, in W, mean of the channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PowerLedger {
    /// Emitted by the scene.
    pub emitted: f64,
    /// Absorbed by surfaces, what arrives at backs that have no side included.
    pub absorbed: f64,
    /// Left the scene, measured by rays.
    pub escaped: f64,
    /// Standard error of `escaped`.
    pub escaped_stderr: f64,
    /// Left out of the solution: still to be shot where passes were counted.
    pub unshot: f64,
    /// `(emitted - absorbed - escaped - unshot) / emitted`.
    pub imbalance: f64,
    /// What arrives on surfaces in the passes that were not made, from the last one as a geometric series; a part of
    /// what is absorbed and escaped. 0 where passes were counted.
    pub extrapolated: f64,
    /// The part of `absorbed` that is in no face's irradiance: it ends on backs that have no side, or within surfaces that
    /// others cover. Measured by the rays that measure `escaped`.
    pub swallowed: f64,
}
