//! Where a camera may stand: free places in front of lit surface, off the walls, at eye height.

use super::surface_points::SurfacePoint;
use super::up_axis::UpAxis;
use super::view::View;
use crate::embree::Ray;
use glam::DVec3;

/// Surface points in front of which eyes are tried, evenly taken from all.
const EYE_POINTS: usize = 128;

/// Where between a surface and what faces it an eye is tried.
const EYE_PLACES: [f64; 3] = [0.12, 0.5, 0.88];

/// How far an eye may go towards a side where nothing stands: up to the bounds.
const OPEN_PLACE: f64 = 0.99;

/// Nearest thing that an eye may have beside it, as a share of the mean distance around it.
const CLEARANCE: f64 = 0.1;

/// Height of the eye between floor and ceiling: a standing person's in a usual room.
const EYE_HEIGHT: f64 = 0.6;

/// Directions around the vertical in which an eye must be clear.
const AZIMUTHS: usize = 24;

/// The free way from a point in a direction.
#[derive(Clone, Copy)]
struct Free {
    length: f64,
    /// Nothing stands at its end: the scene's bounds do.
    open: bool,
}

impl View<'_> {
    /// Free places in front of lit surface: off the walls, and at the height of a person where
    /// there is a floor.
    pub(super) fn eyes(&self, points: &[SurfacePoint], up: UpAxis) -> Vec<DVec3> {
        let bounds = self.bounds();
        let stride = points.len().div_ceil(EYE_POINTS).max(1);
        let mut eyes = Vec::new();
        for point in points.iter().step_by(stride) {
            let start = point.position + 1e-4 * point.normal;
            let Some(free) = self.free_length(start, point.normal, bounds) else {
                continue;
            };
            for place in EYE_PLACES {
                let place = if free.open && place == EYE_PLACES[2] {
                    OPEN_PLACE
                } else {
                    place
                };
                let eye = start + point.normal * (free.length * place);
                eyes.extend(
                    self.off_walls(eye, up, bounds)
                        .and_then(|eye| self.at_height(eye, up, bounds))
                        .filter(|&eye| self.clear_around(eye, up, bounds)),
                );
            }
        }
        eyes
    }

    /// The eye moved along both horizontal axes so far that neither side is much nearer.
    fn off_walls(&self, mut eye: DVec3, up: UpAxis, bounds: (DVec3, DVec3)) -> Option<DVec3> {
        for axis in up.level() {
            let ahead = self.free_length(eye, axis, bounds)?;
            let behind = self.free_length(eye, -axis, bounds)?;
            let limit = |free: Free| if free.open { OPEN_PLACE } else { EYE_PLACES[2] };
            let whole = ahead.length + behind.length;
            let place = behind.length / whole;
            let wanted = place.clamp(1.0 - limit(behind), limit(ahead));
            eye += axis * ((wanted - place) * whole);
        }
        Some(eye)
    }

    /// The eye moved up or down to [`EYE_HEIGHT`].
    fn at_height(&self, eye: DVec3, up: UpAxis, bounds: (DVec3, DVec3)) -> Option<DVec3> {
        let up = up.direction();
        let above = self.free_length(eye, up, bounds)?.length;
        let below = self.free_length(eye, -up, bounds)?.length;
        Some(eye + up * (EYE_HEIGHT * (above + below) - below))
    }

    /// True when nothing stands close to the eye at its own height.
    fn clear_around(&self, eye: DVec3, up: UpAxis, bounds: (DVec3, DVec3)) -> bool {
        let [first, second] = up.level();
        let around: Vec<Free> = (0..AZIMUTHS)
            .filter_map(|azimuth| {
                let angle = std::f64::consts::TAU * azimuth as f64 / AZIMUTHS as f64;
                let direction = first * angle.cos() + second * angle.sin();
                self.free_length(eye, direction, bounds)
            })
            .collect();
        let mean = around.iter().map(|free| free.length).sum::<f64>() / AZIMUTHS as f64;
        around.len() == AZIMUTHS
            && (around.iter()).all(|free| free.open || free.length >= CLEARANCE * mean)
    }

    /// How far a ray goes before it meets something, or leaves the scene's bounds; `None` where
    /// that is nowhere.
    fn free_length(
        &self,
        from: DVec3,
        direction: DVec3,
        (least, greatest): (DVec3, DVec3),
    ) -> Option<Free> {
        let leaves = (0..3)
            .map(|axis| match direction[axis] {
                d if d > 0.0 => (greatest[axis] - from[axis]) / d,
                d if d < 0.0 => (least[axis] - from[axis]) / d,
                _ => f64::INFINITY,
            })
            .fold(f64::INFINITY, f64::min);
        let mut hits = Vec::with_capacity(1);
        self.embree.closest_hits(&[ray(from, direction)], &mut hits);
        let free = hits[0].map_or(
            Free {
                length: leaves,
                open: true,
            },
            |hit| Free {
                length: f64::from(hit.t).min(leaves),
                open: false,
            },
        );
        (free.length.is_finite() && free.length > 1e-3).then_some(free)
    }
}

/// A ray in the direction's own lengths.
fn ray(from: DVec3, direction: DVec3) -> Ray {
    Ray::half_line(from.as_vec3(), direction.as_vec3(), 0.0)
}
