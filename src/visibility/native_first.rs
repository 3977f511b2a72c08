//! Sample segments answered natively where that is sure and takes nanoseconds, and by somebody else where it is not.

use super::empty_boxes::AirBetween;
use super::occluder_tree::OccluderTree;
use super::sampling::{SampleOctet, SegmentTest};
use super::shadow_cache::ShadowCache;

/// Asks the rectangles that blocked before, then boxes of air, and `otherwise` about what they leave open.
#[derive(Debug)]
pub struct NativeFirst<'a, T> {
    /// The task's rectangles.
    pub cache: &'a mut ShadowCache,
    /// Where more of them are found.
    pub occluders: &'a OccluderTree,
    /// Boxes that may hold segments of the pair.
    pub air: Option<AirBetween<'a>>,
    /// Whom to ask about the rest.
    pub otherwise: T,
    /// Segments that a rectangle blocks, so far.
    pub blocked: u32,
    /// Segments that lie in air, so far.
    pub clear: u32,
}

impl<T: SegmentTest> SegmentTest for &mut NativeFirst<'_, T> {
    #[inline(always)]
    fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8 {
        let screened = self.cache.blocked8(octet, active);
        self.blocked += screened.count_ones();
        let mut open = active & !screened;
        if open == 0 {
            return screened;
        }
        if let Some(air) = &self.air {
            let clear = open & air.hold8(&octet.segments);
            self.clear += clear.count_ones();
            open &= !clear;
            if open == 0 {
                return screened;
            }
        }
        let blocked = self.otherwise.blocked8(octet, open);
        self.cache.learn(self.occluders, octet, blocked);
        screened | blocked
    }
}
