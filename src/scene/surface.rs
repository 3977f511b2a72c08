//! From materials and textures to the surfaces of polygons.

use super::assets::Assets;
use super::config::{CLAMPED_REFLECTANCE, LoadConfig};
use super::error::{Defect, DefectLog, Reason};
use super::material::{DEFAULT_REFLECTANCE, describe};
use super::model::{SceneWarning, Surface};
use super::mtl_scan::RawMaterial;
use super::obj_parse::RawMesh;
use super::polygons::Piece;
use super::texture::Texture;
use super::texture_map::TextureMap;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// Surfaces of a scene.
pub(super) struct Surfaces {
    /// One per material in use, or per material and texture colour, in order of first use.
    pub list: Vec<Surface>,
    /// Index into `list` of each piece.
    pub of_piece: Vec<u32>,
}

/// The two textures that a material may have.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Slot {
    Reflectance,
    Emission,
}

impl Slot {
    fn map(self, material: &RawMaterial) -> Option<&TextureMap> {
        match self {
            Self::Reflectance => material.map_kd.as_ref(),
            Self::Emission => material.map_ke.as_ref(),
        }
    }
}

/// What is to be coloured.
pub(super) struct Canvas<'a> {
    pub pieces: &'a [Piece],
    pub mesh: &'a RawMesh,
    /// Whether each face has texture coordinates.
    pub textured: &'a [bool],
    /// Material of each piece.
    pub material_of: &'a [u32],
    pub materials: &'a [RawMaterial],
}

/// Gives every piece its surface.
pub(super) fn assign_surfaces(
    canvas: &Canvas,
    assets: Assets,
    config: &LoadConfig,
    defects: &mut Vec<Defect>,
    warnings: &mut Vec<SceneWarning>,
) -> Surfaces {
    let Canvas {
        material_of,
        materials,
        ..
    } = *canvas;
    let mut pieces_of_textured: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (piece, &material) in material_of.iter().enumerate() {
        let raw = &materials[material as usize];
        if raw.map_kd.is_some() || raw.map_ke.is_some() {
            pieces_of_textured
                .entry(material)
                .or_default()
                .push(piece as u32);
        }
    }
    // One image at a time, so that memory holds the largest and not all of them.
    let mut users: BTreeMap<String, Vec<(u32, Slot)>> = BTreeMap::new();
    for &material in pieces_of_textured.keys() {
        for slot in [Slot::Reflectance, Slot::Emission] {
            if let Some(map) = slot.map(&materials[material as usize]) {
                users
                    .entry(map.file.clone())
                    .or_default()
                    .push((material, slot));
            }
        }
    }
    let mut colours: BTreeMap<(u32, Slot), Vec<[f64; 3]>> = BTreeMap::new();
    for (file, users) in users {
        let decoded = assets
            .read(&file)
            .map_err(|e| describe(&e))
            .and_then(|(name, bytes)| Texture::decode(&bytes, &name));
        match decoded {
            Ok(texture) => {
                for (material, slot) in users {
                    let Some(map) = slot.map(&materials[material as usize]) else {
                        continue;
                    };
                    let of_pieces = pieces_of_textured[&material]
                        .par_iter()
                        .map(|&p| canvas.colour_of(p, map, &texture))
                        .collect();
                    colours.insert((material, slot), of_pieces);
                }
            }
            Err(why) => {
                let (material, slot) = users[0];
                let material = &materials[material as usize];
                let line = slot.map(material).map_or(material.line, |m| m.line);
                warnings.push(SceneWarning(format!(
                    "{}:{line}: texture `{file}` could not be read ({why}); the plain colour of the material is taken",
                    material.file
                )));
            }
        }
    }
    collect(material_of, materials, &colours, config, defects, warnings)
}

impl Canvas<'_> {
    /// Mean colour of a texture over a piece; over the whole image for faces that say nothing.
    fn colour_of(&self, piece: u32, map: &TextureMap, texture: &Texture) -> [f64; 3] {
        let piece = &self.pieces[piece as usize];
        if !self.textured[piece.face as usize] {
            return texture.mean();
        }
        let corners: [DVec2; 3] = piece.corners.map(|corner| {
            let at = self.mesh.corner_textures[corner as usize];
            self.mesh.texture_coordinates[at as usize] * map.scale + map.offset
        });
        texture.mean_over(corners, map.clamp)
    }
}

fn collect(
    material_of: &[u32],
    materials: &[RawMaterial],
    colours: &BTreeMap<(u32, Slot), Vec<[f64; 3]>>,
    config: &LoadConfig,
    defects: &mut Vec<Defect>,
    warnings: &mut Vec<SceneWarning>,
) -> Surfaces {
    let mut surfaces = Surfaces {
        list: Vec::new(),
        of_piece: Vec::with_capacity(material_of.len()),
    };
    let mut known: HashMap<(u32, [u64; 6]), u32> = HashMap::new();
    // The highest reflectance of each material that has one too high.
    let mut too_high: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    let mut seen = vec![0usize; materials.len()];
    for &material in material_of {
        let raw = &materials[material as usize];
        let nth = seen[material as usize];
        seen[material as usize] += 1;
        let texel = |slot| colours.get(&(material, slot)).map(|c| c[nth]);
        let mut reflectance = combine(raw.kd, texel(Slot::Reflectance), DEFAULT_REFLECTANCE);
        let emission = combine(raw.ke, texel(Slot::Emission), 0.0);
        if reflectance.iter().any(|&c| c >= 1.0) {
            let worst = too_high.entry(material).or_insert(reflectance);
            if greatest(reflectance) > greatest(*worst) {
                *worst = reflectance;
            }
            reflectance = reflectance.map(|c| c.min(CLAMPED_REFLECTANCE));
        }
        let key = |c: [f64; 3]| c.map(f64::to_bits);
        let ([a, b, c], [d, e, f]) = (key(reflectance), key(emission));
        let next = surfaces.list.len() as u32;
        let index = *known.entry((material, [a, b, c, d, e, f])).or_insert(next);
        if index == next {
            surfaces.list.push(Surface {
                material: raw.name.clone(),
                reflectance,
                emission,
            });
        }
        surfaces.of_piece.push(index);
    }
    for (material, value) in too_high {
        let raw = &materials[material as usize];
        if config.clamp_reflectance {
            warnings.push(SceneWarning(format!(
                "{}:{}: material `{}`: Kd {} {} {} is clamped to {CLAMPED_REFLECTANCE}",
                raw.file, raw.kd_line, raw.name, value[0], value[1], value[2]
            )));
        } else {
            let textured = colours.contains_key(&(material, Slot::Reflectance));
            let texture = raw.map_kd.as_ref().filter(|_| textured);
            let reason = Reason::ReflectanceTooHigh {
                material: raw.name.clone(),
                value,
                texture: texture.map(|t| t.file.clone()),
            };
            DefectLog::new(&raw.file, defects).add(Some(raw.kd_line), reason);
        }
    }
    surfaces
}

/// A colour times its texture. A factor that is absent, or black as some exporters write beside a
/// texture, leaves the texture as it is.
fn combine(factor: Option<[f64; 3]>, texel: Option<[f64; 3]>, default: f64) -> [f64; 3] {
    match (factor, texel) {
        (None, None) => [default; 3],
        (Some(factor), None) => factor,
        (None | Some([0.0, 0.0, 0.0]), Some(texel)) => texel,
        (Some(factor), Some(texel)) => std::array::from_fn(|i| factor[i] * texel[i]),
    }
}

fn greatest(colour: [f64; 3]) -> f64 {
    colour.into_iter().fold(0.0, f64::max)
}
