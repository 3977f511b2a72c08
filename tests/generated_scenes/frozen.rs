//! The six scenes of the table stay as they are: figures measured on them can be compared.

use certilux::scene::generate::generate;

/// FNV-1a of the OBJ file followed by the MTL file. A change here makes every committed figure of
/// the table obsolete, so it has to come with new ones.
const FROZEN: [(&str, u64); 6] = [
    ("a", 0x9bfd_d5dc_260e_c030),
    ("b", 0xdde3_d36e_40c0_4850),
    ("c", 0x4686_2895_7109_2860),
    ("d", 0xb17f_bca6_1385_67d8),
    ("e", 0x5e0c_f7af_f9a2_c0f4),
    ("f", 0xa2a0_04b4_98a6_8d34),
];

#[test]
fn the_scenes_of_the_table_are_frozen() {
    for (name, frozen) in FROZEN {
        let scene = generate(name).unwrap();
        let bytes = scene.obj.bytes().chain(scene.mtl.bytes());
        let hash = fnv_1a(bytes);
        assert_eq!(hash, frozen, "{name} is another scene: {hash:#018x}");
    }
}

/// The 64-bit hash of Fowler, Noll and Vo, variant 1a.
fn fnv_1a(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The vectors that the hash's authors publish.
#[test]
fn the_hash_is_fnv_1a() {
    assert_eq!(fnv_1a(b"".iter().copied()), 0xcbf2_9ce4_8422_2325);
    assert_eq!(fnv_1a(b"a".iter().copied()), 0xaf63_dc4c_8601_ec8c);
    assert_eq!(fnv_1a(b"foobar".iter().copied()), 0x8594_4171_f739_67e8);
}
