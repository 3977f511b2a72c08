//! The paints, woods, cloths and metals that the furnished scenes share.
//!
//! Reflectances are ordinary indoor values: ceilings 0.8, painted walls 0.5 to 0.7, wood 0.15 to
//! 0.45, textiles 0.1 to 0.5, metal and stone 0.3 to 0.5 (the ranges that lighting handbooks give).

use super::material::Material;

pub const CEILING_WHITE: Material = Material::matte("ceiling_white", [0.80, 0.80, 0.78]);
pub const WARM_WHITE: Material = Material::matte("warm_white", [0.72, 0.68, 0.60]);
pub const COOL_WHITE: Material = Material::matte("cool_white", [0.66, 0.69, 0.70]);
pub const TERRACOTTA: Material = Material::matte("terracotta", [0.66, 0.34, 0.22]);
pub const OCHRE: Material = Material::matte("ochre", [0.70, 0.54, 0.26]);
pub const SAGE: Material = Material::matte("sage", [0.46, 0.55, 0.40]);
pub const DUSTY_BLUE: Material = Material::matte("dusty_blue", [0.38, 0.48, 0.60]);
pub const OAK: Material = Material::matte("oak", [0.46, 0.32, 0.18]);
pub const PINE: Material = Material::matte("pine", [0.60, 0.46, 0.28]);
pub const WALNUT: Material = Material::matte("walnut", [0.24, 0.15, 0.09]);
pub const PARQUET: Material = Material::matte("parquet", [0.42, 0.30, 0.19]);
pub const STONE_FLOOR: Material = Material::matte("stone_floor", [0.40, 0.38, 0.35]);
pub const CARPET_GREY: Material = Material::matte("carpet_grey", [0.27, 0.28, 0.30]);
pub const CONCRETE: Material = Material::matte("concrete", [0.44, 0.43, 0.41]);
pub const RUG_RED: Material = Material::matte("rug_red", [0.48, 0.12, 0.10]);
pub const CLOTH_BLUE: Material = Material::matte("cloth_blue", [0.14, 0.22, 0.40]);
pub const CLOTH_GREEN: Material = Material::matte("cloth_green", [0.18, 0.32, 0.20]);
pub const CLOTH_RUST: Material = Material::matte("cloth_rust", [0.50, 0.22, 0.12]);
pub const LINEN: Material = Material::matte("linen", [0.74, 0.71, 0.64]);
pub const STEEL: Material = Material::matte("steel", [0.42, 0.44, 0.46]);
pub const DARK_METAL: Material = Material::matte("dark_metal", [0.16, 0.16, 0.17]);
pub const CARDBOARD: Material = Material::matte("cardboard", [0.52, 0.38, 0.24]);
pub const LEAF: Material = Material::matte("leaf", [0.12, 0.30, 0.10]);
pub const CLAY: Material = Material::matte("clay", [0.56, 0.30, 0.20]);
pub const LAMPSHADE: Material = Material::matte("lampshade", [0.76, 0.68, 0.52]);
pub const GLASS_DARK: Material = Material::matte("glass_dark", [0.10, 0.12, 0.14]);

/// Backs of books and boxes, taken in turn.
pub const BOOKS: [Material; 5] = [
    Material::matte("book_red", [0.48, 0.14, 0.12]),
    Material::matte("book_blue", [0.14, 0.22, 0.42]),
    Material::matte("book_green", [0.16, 0.34, 0.20]),
    Material::matte("book_cream", [0.70, 0.64, 0.50]),
    Material::matte("book_brown", [0.34, 0.20, 0.12]),
];
