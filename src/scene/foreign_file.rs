//! Files that are often given for an OBJ and are none.

/// Beginnings of files that are often mistaken for OBJ.
const FOREIGN: [(&[u8], &str); 12] = [
    (b"\x89PNG", "it is a PNG image"),
    (b"\xff\xd8\xff", "it is a JPEG image"),
    (b"ply\n", "it is a PLY mesh"),
    (b"ply\r", "it is a PLY mesh"),
    (b"glTF", "it is a binary glTF scene"),
    (b"solid", "it is an STL mesh"),
    (b"Kaydara FBX", "it is an FBX scene"),
    (b"BLENDER", "it is a Blender file"),
    (b"PK\x03\x04", "it is a ZIP archive"),
    (b"\x1f\x8b", "it is compressed with gzip"),
    (b"\xff\xfe", "it is UTF-16 text; save it as UTF-8"),
    (b"\xfe\xff", "it is UTF-16 text; save it as UTF-8"),
];

/// What `bytes` are, if they cannot be OBJ text.
pub(super) fn foreign_kind(bytes: &[u8]) -> Option<&'static str> {
    FOREIGN
        .iter()
        .find(|(magic, _)| bytes.starts_with(magic))
        .map(|&(_, what)| what)
        .or_else(|| {
            bytes
                .contains(&0)
                .then_some("it has binary content (a NUL byte)")
        })
}
