//! What `certilux view --show` shows beside radiance: each a picture with its marks.

use super::camera::PinHole;
use super::canvas::Canvas;
use super::cluster_colours::cluster_colour;
use super::colour_scale::{ColourScale, Spread};
use super::legend::draw_legend;
use super::occluder_sheets::OccluderSheets;
use super::overlay::{Lines, Mark, Sight};
use super::panel::position_key;
use super::view::View;
use super::{OutputError, Picture, ToneMap};
use crate::cluster::Hierarchy;
use crate::embree::{Device, EmbreeError};
use crate::occluder::OccluderSet;
use crate::scene::{Scene, Side};
use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Where nothing is known: a grey that no scale holds at that brightness.
const UNKNOWN: [f32; 3] = [0.12, 0.12, 0.12];

/// Brightness of a surface seen edge-on, beside one seen squarely.
const EDGE_ON: f32 = 0.35;

/// A picture being made of a view.
pub struct Exhibit<'a> {
    /// The scene.
    pub view: &'a View<'a>,
    /// From where.
    pub camera: &'a PinHole,
    /// Raised when it shall stop.
    pub interrupted: &'a AtomicBool,
}

/// A picture and the scale of its false colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The picture.
    pub canvas: Canvas,
    /// How numbers became colours, where they did.
    pub scale: Option<ColourScale>,
}

impl Shown {
    /// Draws the legend, if there is a scale, and writes the picture.
    ///
    /// # Errors
    /// As [`super::write_png`].
    pub fn write_png(mut self, path: &Path, interrupted: &AtomicBool) -> Result<(), OutputError> {
        if let Some(scale) = &self.scale {
            draw_legend(&mut self.canvas, scale, path)?;
        }
        self.canvas.write_png(path, interrupted)
    }
}

impl Exhibit<'_> {
    /// Irradiance, mean of the channels, in false colours; `greatest` is the upper end of the scale.
    pub fn irradiance(&self, picture: &Picture, greatest: Option<f64>) -> Shown {
        let value = |p: &super::Pixel| {
            f64::from(p.irradiance.iter().sum::<f32>()) / (3.0 * f64::from(p.alpha))
        };
        let seen = picture.pixels.iter().filter(|p| p.alpha > 0.0);
        let scale = ColourScale::new(
            "irradiance",
            "W/m2",
            Spread::Linear,
            seen.map(|p| (value(p), f64::from(p.alpha))),
            greatest,
        );
        Shown {
            canvas: Canvas::from_pixels(picture, |pixel| scale.colour(value(pixel))),
            scale: Some(scale),
        }
    }

    /// The edges of the patches over the picture.
    pub fn mesh(&self, picture: &Picture, tone_map: ToneMap) -> Option<Shown> {
        let mut canvas = Canvas::tone_mapped(picture, tone_map);
        let mark = |sight: &Sight| Mark {
            colour: [0.0; 3],
            opacity: 0.0,
            // Sides without light are not split, but their polygons end somewhere too.
            id: (sight.landing).map_or_else(|| !(sight.hit.polygon.0 + 1), |l| l.leaf as u32),
        };
        self.lay_over(&mut canvas, Lines(0.6), &mark)?;
        Some(Shown {
            canvas,
            scale: None,
        })
    }

    /// A number a patch in false colours; patches without one are grey. `values` is parallel to the
    /// mesh's faces.
    pub fn values(&self, values: &[Option<f64>], scale: ColourScale) -> Option<Shown> {
        let mut canvas = self.nothing();
        let faces = &self.view.mesh.faces;
        let mark = |sight: &Sight| {
            let Some(landing) = sight.landing else {
                return opaque(UNKNOWN, u32::MAX - 1);
            };
            let colour = values[landing.leaf].map_or(UNKNOWN, |v| scale.colour(v));
            opaque(colour, faces[landing.leaf].source_face)
        };
        self.lay_over(&mut canvas, Lines(0.25), &mark)?;
        Some(Shown {
            canvas,
            scale: Some(scale),
        })
    }

    /// Face clusters in distinct colours: the `count` nodes of the hierarchy's cut (paper, Fig. 1).
    /// With how many there are.
    pub fn clusters(
        &self,
        scene: &Scene,
        hierarchy: &Hierarchy,
        count: usize,
    ) -> Option<(Shown, usize)> {
        let cut = hierarchy.cut(count);
        let mut of_facet = HashMap::new();
        for (index, &node) in (0u32..).zip(&cut) {
            for facet in &hierarchy.facets[hierarchy.facet_range(node)] {
                of_facet.insert((facet.polygon, facet.side), index);
            }
        }
        let of_panel = self.by_panel(scene, |polygon, side| {
            of_facet.get(&(polygon, side)).copied()
        });
        let mut canvas = self.nothing();
        let mark = |sight: &Sight| {
            let cluster = sight.landing.and_then(|l| of_panel[l.panel]);
            let colour = cluster.map_or(UNKNOWN, |c| {
                cluster_colour(c as usize).map(|x| (f32::from(x) / 255.0).powi(2))
            });
            let light = EDGE_ON + (1.0 - EDGE_ON) * sight.cosine;
            opaque(colour.map(|x| x * light), cluster.unwrap_or(u32::MAX - 1))
        };
        self.lay_over(&mut canvas, Lines(0.5), &mark)?;
        Some((
            Shown {
                canvas,
                scale: None,
            },
            cut.len(),
        ))
    }

    /// Occluders, semi-transparent over the picture (paper, Figs. 3 and 4).
    ///
    /// # Errors
    /// [`EmbreeError`], for want of memory for example.
    pub fn occluders(
        &self,
        picture: &Picture,
        tone_map: ToneMap,
        scene: &Scene,
        set: &OccluderSet,
        device: &Device,
    ) -> Result<Option<Shown>, EmbreeError> {
        let sheets = OccluderSheets::new(scene, set, &self.view.frame, device)?;
        let mut canvas = Canvas::tone_mapped(picture, tone_map);
        canvas.fade(0.6);
        let mark = |sight: &Sight| sheets.mark(sight);
        let done = self.lay_over(&mut canvas, Lines(0.8), &mark);
        Ok(done.map(|()| Shown {
            canvas,
            scale: None,
        }))
    }

    fn lay_over(
        &self,
        canvas: &mut Canvas,
        lines: Lines,
        mark: &(dyn Fn(&Sight) -> Mark + Sync),
    ) -> Option<()> {
        (self.view).lay_over(canvas, self.camera, lines, mark, self.interrupted)
    }

    fn nothing(&self) -> Canvas {
        let size = self.camera.size();
        Canvas {
            size,
            pixels: vec![[0.0; 4]; size[0] as usize * size[1] as usize],
        }
    }

    /// What `of` says of the polygon and side behind each panel. A panel is known by its corners, which
    /// stand in a solution as they were read; one that joins several polygons of its face, by its face.
    fn by_panel<T: Copy>(
        &self,
        scene: &Scene,
        of: impl Fn(crate::math::PolygonId, Side) -> Option<T>,
    ) -> Vec<Option<T>> {
        let mut by_corners = HashMap::with_capacity(scene.polygons.len());
        let mut by_face = HashMap::with_capacity(scene.polygons.len());
        for (p, polygon) in scene.polygons.iter().enumerate() {
            let id = crate::math::PolygonId::new(p);
            let mut corners = scene.source_corners(id).map(position_key);
            corners.sort_unstable();
            by_corners
                .entry((polygon.source_face, corners))
                .or_insert(id);
            by_face.entry(polygon.source_face).or_insert(id);
        }
        let panels = &self.view.panels;
        (panels.panels.iter())
            .map(|panel| {
                let mut corners =
                    (panel.corners).map(|v| position_key(panels.positions[v as usize]));
                corners.sort_unstable();
                let polygon = (by_corners.get(&(panel.source_face, corners)))
                    .or_else(|| by_face.get(&panel.source_face));
                of(*polygon?, panel.side)
            })
            .collect()
    }
}

fn opaque(colour: [f32; 3], id: u32) -> Mark {
    Mark {
        colour,
        opacity: 1.0,
        id,
    }
}
