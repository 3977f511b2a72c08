//! Writes a picture as OpenEXR with all its layers.
//!
//! One part with dotted channel names, which tev, Blender, Nuke and OpenEXR's own tools group into
//! layers: `R G B A` (radiance), `irradiance.R .G .B`, `normal.X .Y .Z`, `depth.Z`, `face.ID`.

use super::{OutputError, Picture, Pixel, write_atomically};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, Error, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    WritableImage,
};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A channel's name and where it comes from.
type Channel = (&'static str, fn(&Pixel) -> f32);

/// Every channel.
const CHANNELS: [Channel; 12] = [
    ("R", |p| p.radiance[0]),
    ("G", |p| p.radiance[1]),
    ("B", |p| p.radiance[2]),
    ("A", |p| p.alpha),
    ("irradiance.R", |p| p.irradiance[0]),
    ("irradiance.G", |p| p.irradiance[1]),
    ("irradiance.B", |p| p.irradiance[2]),
    ("normal.X", |p| p.normal[0]),
    ("normal.Y", |p| p.normal[1]),
    ("normal.Z", |p| p.normal[2]),
    ("depth.Z", |p| p.depth),
    ("face.ID", |p| p.face),
];

/// Writes `picture` to `path`, whole or not at all.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::Encoding`].
pub fn write_exr(
    path: &Path,
    picture: &Picture,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let channels: SmallVec<[_; 4]> = CHANNELS
        .iter()
        .map(|&(name, of)| {
            AnyChannel::new(
                name,
                FlatSamples::F32(picture.pixels.iter().map(of).collect()),
            )
        })
        .collect();
    let image = Image::from_layer(Layer::new(
        (picture.size[0] as usize, picture.size[1] as usize),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    ));
    write_atomically(path, interrupted, |file| {
        image.write().to_buffered(file).map_err(|e| match e {
            Error::Io(e) => OutputError::io("write", path, e),
            other => OutputError::Encoding {
                path: path.to_path_buf(),
                reason: other.to_string(),
            },
        })
    })
}
