//! What the cache answers, what it learns, and that it gives up where there is nothing to learn.

use super::native_first::NativeFirst;
use super::near_segments::SegmentOctet;
use super::sampling::{SampleOctet, SegmentTest};
use super::shadow_cache::ShadowCache;
use super::{EmptyBoxes, OccluderTree, Tolerance};
use crate::math::Aabb;
use crate::occluder::SlabRectangle;
use glam::Vec3;

const SCENE: Aabb = Aabb {
    min: Vec3::splat(-0.5),
    max: Vec3::splat(0.5),
};

/// Upright sheets at x = 0, each behind a place of its own.
fn sheets(count: usize) -> OccluderTree {
    let slabs: Vec<SlabRectangle> = (0..count)
        .map(|i| {
            let centre = Vec3::new(0.0, place(i), 0.0);
            SlabRectangle::new(centre, Vec3::Y * 0.01, Vec3::Z * 0.01, Vec3::X, 1.0e-6)
        })
        .collect();
    OccluderTree::build(&slabs, &[], Tolerance::of_scene(SCENE))
}

fn place(sheet: usize) -> f32 {
    -0.4 + 0.1 * sheet as f32
}

/// Eight segments through sheet number `sheet`, those of `beside` passing it.
fn octet(sheet: usize, beside: u8) -> SampleOctet {
    let end = |x: f32| {
        let y = |lane: usize| place(sheet) + 1.0e-3 * lane as f32 - 4.0e-3;
        let z = |lane: usize| f32::from(beside >> lane & 1) * 0.05;
        [[x; 8], std::array::from_fn(y), std::array::from_fn(z)]
    };
    SampleOctet {
        segments: SegmentOctet {
            from: end(-0.3),
            to: end(0.3),
        },
        near: [1.0e-5; 8],
        far: [0.999_99; 8],
    }
}

/// Says of the same lanes each time that they are blocked, and counts how often it is asked about how many.
struct Other {
    blocked: u8,
    asked: Vec<u32>,
}

impl SegmentTest for &mut Other {
    fn blocked8(&mut self, _: &SampleOctet, active: u8) -> u8 {
        self.asked.push(active.count_ones());
        self.blocked & active
    }
}

fn ask(
    cache: &mut ShadowCache,
    tree: &OccluderTree,
    octet: &SampleOctet,
    other: &mut Other,
) -> (u8, u32) {
    let mut test = NativeFirst {
        cache,
        occluders: tree,
        air: None,
        otherwise: other,
        blocked: 0,
        clear: 0,
    };
    let blocked = (&mut test).blocked8(octet, 0xff);
    (blocked, test.blocked)
}

#[test]
fn what_blocked_before_is_asked_first_and_the_rest_goes_on() {
    let (tree, mut cache) = (sheets(1), ShadowCache::default());
    let octet = octet(0, 0b0000_1111);
    let mut embree = Other {
        blocked: 0b1111_0000,
        asked: Vec::new(),
    };
    assert_eq!(
        ask(&mut cache, &tree, &octet, &mut embree),
        (0b1111_0000, 0)
    );
    assert_eq!(
        ask(&mut cache, &tree, &octet, &mut embree),
        (0b1111_0000, 4)
    );
    assert_eq!(embree.asked, [8, 4]);
}

#[test]
fn as_many_sheets_are_kept_as_fit_and_the_oldest_goes() {
    let (tree, mut cache) = (sheets(5), ShadowCache::default());
    let mut embree = Other {
        blocked: 0xff,
        asked: Vec::new(),
    };
    for sheet in 0..5 {
        assert_eq!(ask(&mut cache, &tree, &octet(sheet, 0), &mut embree).1, 0);
    }
    // Four are kept, so the first is not.
    for sheet in 1..5 {
        assert_eq!(ask(&mut cache, &tree, &octet(sheet, 0), &mut embree).1, 8);
    }
    assert_eq!(ask(&mut cache, &tree, &octet(0, 0), &mut embree).1, 0);
    let account = cache.account();
    assert!(account.saved > 0.0 && account.spent > 0.0, "{account:?}");
}

/// Blockers that are no occluders are looked for ever less often, and a sheet that blocks nothing any more is dropped.
#[test]
fn where_nothing_is_learned_next_to_nothing_is_spent() {
    let (tree, mut cache) = (sheets(1), ShadowCache::default());
    let mut embree = Other {
        blocked: 0xff,
        asked: Vec::new(),
    };
    ask(&mut cache, &tree, &octet(0, 0), &mut embree);
    // All pass beside the sheet, and something else blocks them.
    let beside = octet(0, 0xff);
    let spent = |cache: &ShadowCache| cache.account().spent;
    let mut before = spent(&cache);
    for packet in 0..4_000 {
        assert_eq!(ask(&mut cache, &tree, &beside, &mut embree), (0xff, 0));
        if packet == 2_999 {
            before = spent(&cache);
        }
    }
    // In packets of eight rays, for a thousand of them.
    assert!(spent(&cache) - before < 5.0, "{}", spent(&cache) - before);
    // The sheet was dropped: it has to be found again.
    while ask(&mut cache, &tree, &octet(0, 0), &mut embree).1 == 0 {
        assert!(embree.asked.len() < 5_000, "never found again");
    }
}

#[test]
fn what_lies_in_air_is_not_asked_about() {
    let (tree, mut cache) = (sheets(1), ShadowCache::default());
    let octet = octet(0, 0b0000_0011);
    // Around the two lanes that pass above the sheet.
    let air = EmptyBoxes::planted(vec![Aabb {
        min: Vec3::new(-0.4, -0.5, 0.02),
        max: Vec3::new(0.4, 0.5, 0.1),
    }]);
    let near = air.near(SCENE);
    let mut embree = Other {
        blocked: 0b1111_1100,
        asked: Vec::new(),
    };
    let mut test = NativeFirst {
        cache: &mut cache,
        occluders: &tree,
        air: near.between(SCENE, SCENE),
        otherwise: &mut embree,
        blocked: 0,
        clear: 0,
    };
    assert_eq!((&mut test).blocked8(&octet, 0xff), 0b1111_1100);
    assert_eq!((test.blocked, test.clear), (0, 2));
    // Nobody is asked about the rest once the sheet is known.
    assert_eq!((&mut test).blocked8(&octet, 0xff), 0b1111_1100);
    assert_eq!((test.blocked, test.clear), (6, 4));
    assert_eq!(embree.asked, [6]);
}
