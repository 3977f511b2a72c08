//! Packets of occlusion rays, laid out as Embree wants them so that they pass without a copy.

use glam::Vec3;

macro_rules! ray_packet {
    ($(#[$doc:meta])* $name:ident, $width:literal, $align:literal, $mask:ty) => {
        $(#[$doc])*
        #[repr(C, align($align))]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            /// Origins, x.
            pub org_x: [f32; $width],
            /// Origins, y.
            pub org_y: [f32; $width],
            /// Origins, z.
            pub org_z: [f32; $width],
            /// Where each segment starts, in lengths of its direction, at least 0.
            pub tnear: [f32; $width],
            /// Directions, x; of any length but 0.
            pub dir_x: [f32; $width],
            /// Directions, y.
            pub dir_y: [f32; $width],
            /// Directions, z.
            pub dir_z: [f32; $width],
            /// Unused: nothing moves.
            pub time: [f32; $width],
            /// Where each segment ends; Embree writes minus infinity where it is blocked.
            pub tfar: [f32; $width],
            /// Geometry mask; all ones.
            pub mask: [u32; $width],
            /// Unused.
            pub id: [u32; $width],
            /// Reserved; zero.
            pub flags: [u32; $width],
        }

        impl $name {
            /// Rays in a packet.
            pub const WIDTH: usize = $width;
            /// The active mask of a full packet.
            pub const ALL: $mask = <$mask>::MAX;
            /// A packet whose lanes are empty intervals.
            pub const EMPTY: Self = Self {
                org_x: [0.0; $width],
                org_y: [0.0; $width],
                org_z: [0.0; $width],
                tnear: [0.0; $width],
                dir_x: [0.0; $width],
                dir_y: [0.0; $width],
                dir_z: [0.0; $width],
                time: [0.0; $width],
                tfar: [-1.0; $width],
                mask: [u32::MAX; $width],
                id: [0; $width],
                flags: [0; $width],
            };

            /// Puts a ray into `lane`. A query consumes `tfar`, so every lane is set again before
            /// the next.
            #[inline]
            pub fn set(&mut self, lane: usize, origin: Vec3, direction: Vec3, tnear: f32, tfar: f32) {
                self.org_x[lane] = origin.x;
                self.org_y[lane] = origin.y;
                self.org_z[lane] = origin.z;
                self.tnear[lane] = tnear;
                self.dir_x[lane] = direction.x;
                self.dir_y[lane] = direction.y;
                self.dir_z[lane] = direction.z;
                self.tfar[lane] = tfar;
            }

            /// The active mask of the first `count` lanes.
            #[inline]
            pub fn first(count: usize) -> $mask {
                debug_assert!(count <= $width);
                match count {
                    0 => 0,
                    _ => Self::ALL >> ($width - count),
                }
            }

            /// The lanes that a query found blocked.
            #[inline]
            pub(super) fn blocked(&self) -> $mask {
                let mut bits = 0;
                for lane in 0..$width {
                    bits |= <$mask>::from(self.tfar[lane] == f32::NEG_INFINITY) << lane;
                }
                bits
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::EMPTY
            }
        }
    };
}

/// Embree's form of an active mask: -1 where active, else 0; read with aligned instructions of up to
/// 64 bytes.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub(super) struct Valid<const WIDTH: usize>(pub(super) [i32; WIDTH]);

impl<const WIDTH: usize> Valid<WIDTH> {
    const fn new(active: u32) -> Self {
        let mut lanes = [0; WIDTH];
        let mut lane = 0;
        while lane < WIDTH {
            lanes[lane] = -((active >> lane & 1) as i32);
            lane += 1;
        }
        Self(lanes)
    }
}

/// All masks of 8 lanes, made beforehand: computing the mask in front of the call cost up to 40 ns a
/// query (measured; a wide load of what was just stored in halves cannot be forwarded).
static MASKS_OF_8: [Valid<8>; 256] = {
    let mut masks = [Valid::new(0); 256];
    let mut active = 0;
    while active < masks.len() {
        masks[active] = Valid::new(active as u32);
        active += 1;
    }
    masks
};

/// The full mask of 16 lanes, the usual one.
static FULL_MASK_OF_16: Valid<16> = Valid::new(0xffff);

impl RayPacket8 {
    /// Embree's form of an active mask.
    #[inline]
    pub(super) fn valid(active: u8) -> &'static Valid<8> {
        &MASKS_OF_8[usize::from(active)]
    }
}

impl RayPacket16 {
    /// Calls `ask` with Embree's form of an active mask.
    #[inline]
    pub(super) fn with_valid(active: u16, ask: impl FnOnce(&Valid<16>)) {
        if active == Self::ALL {
            ask(&FULL_MASK_OF_16);
        } else {
            ask(&Valid::new(active.into()));
        }
    }
}

ray_packet!(
    /// Eight rays, as Embree's `RTCRay8`.
    RayPacket8, 8, 32, u8
);
ray_packet!(
    /// Sixteen rays, as Embree's `RTCRay16`.
    RayPacket16, 16, 64, u16
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_convert_lane_by_lane() {
        assert_eq!(
            RayPacket8::valid(0b1000_0101).0,
            [-1, 0, -1, 0, 0, 0, 0, -1]
        );
        for active in [0, 1, 0x8001, 0x7fff, u16::MAX] {
            let mut asked = 0;
            RayPacket16::with_valid(active, |valid| {
                for (lane, value) in valid.0.iter().enumerate() {
                    assert_eq!(*value, -i32::from(active >> lane & 1 == 1));
                    asked += 1;
                }
            });
            assert_eq!(asked, 16);
        }
        assert_eq!(
            [0, 1, 7, 8].map(RayPacket8::first),
            [0, 1, 0b0111_1111, 0b1111_1111]
        );
        assert_eq!([0, 9, 16].map(RayPacket16::first), [0, 0x1ff, 0xffff]);
        let mut packet = RayPacket8::EMPTY;
        packet.tfar[1] = f32::NEG_INFINITY;
        packet.tfar[7] = f32::NEG_INFINITY;
        assert_eq!(packet.blocked(), 0b1000_0010);
    }
}
