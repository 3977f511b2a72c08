//! A camera chosen from the solution alone: inside the lit space, level, and seeing much of it.
//!
//! Lit surface is represented by sample points, spread by area and, up to the mean, by brightness. Candidate eyes stand in
//! the free space in front of lit surface. An eye and a direction score by the points that they see
//! in the frame, less what spoils a picture: things too near, unlit backs, background. Nothing is
//! random and ties go to the earlier candidate, so the same solution gives the same camera.

use super::camera::Camera;
use super::level_frame::{ANGLE_OF_VIEW, AZIMUTHS, LevelFrame};
use super::surface_points::SurfacePoint;
use super::up_axis::UpAxis;
use super::view::View;
use crate::embree::{Hit, Ray};
use crate::math::SampleSequence;
use glam::DVec3;
use rayon::prelude::*;

/// Slopes of the view: level, and a little downwards, because floors hold more of a scene than ceilings do.
const SLOPES: [f64; 3] = [0.0, -0.12, -0.25];

/// Best pairs of eye and direction, a picture's worth of rays each, that are looked at closely.
const FINALISTS: usize = 96;

/// Directions around an eye that tell indoors from outdoors.
const AROUND: u32 = 64;

/// What is nearer than this share of the seen space's size (the root of its area) stands in the way.
const TOO_NEAR: f64 = 0.18;

/// An eye, a direction (horizontal part of length 1) and the share of the points seen in the frame.
#[derive(Clone, Copy)]
struct Shot {
    eye: DVec3,
    forward: DVec3,
    seen: f64,
    /// Share of the points seen around the eye, framed or not.
    around: f64,
    /// Share of all directions from the eye that end on a surface: 1 indoors.
    enclosed: f64,
}

impl View<'_> {
    /// A camera for a picture of `size` pixels; `None` guesses what is up. A scene without light is seen from one
    /// corner of its bounds.
    pub fn automatic_camera(&self, size: [u32; 2], up: Option<UpAxis>) -> Camera {
        let up = up.unwrap_or_else(|| self.vertical());
        let (points, lit_area) = self.surface_points();
        let aspect = f64::from(size[0].max(1)) / f64::from(size[1].max(1));
        let frame = LevelFrame::new(up, aspect);
        let eyes = self.eyes(&points, up);
        let shots: Vec<Shot> = eyes
            .into_par_iter()
            .map(|eye| self.best_shots(eye, &points, &frame))
            .flatten_iter()
            .collect();
        let mut order: Vec<usize> = (0..shots.len()).collect();
        let promise = |i: usize| shots[i].seen * shots[i].enclosed.powi(2);
        order.sort_by(|&i, &j| promise(j).total_cmp(&promise(i)).then(i.cmp(&j)));
        order.truncate(FINALISTS);
        let scores: Vec<f64> = order
            .par_iter()
            .map(|&i| shots[i].seen * self.quality(&shots[i], &frame, lit_area))
            .collect();
        let best = (0..order.len()).fold(None, |best: Option<usize>, i| match best {
            Some(b) if scores[b] >= scores[i] => best,
            _ => Some(i),
        });
        let (eye, forward) = best.map_or_else(
            || self.overview(up),
            |i| (shots[order[i]].eye, shots[order[i]].forward),
        );
        Camera {
            eye: self.frame.to_file(eye),
            target: self.frame.to_file(eye + forward),
            up: up.direction(),
            fov: ANGLE_OF_VIEW,
            size,
        }
    }

    /// A view of everything from one corner, for scenes without light.
    fn overview(&self, up: UpAxis) -> (DVec3, DVec3) {
        let (least, greatest) = self.bounds();
        if !least.is_finite() {
            return (DVec3::ZERO, DVec3::X);
        }
        let centre = 0.5 * (least + greatest);
        let [first, second] = up.level();
        let away = (first + second.abs() + 0.7 * up.direction()).normalize()
            * (greatest - least).length()
            * 1.2;
        (centre + away, -away)
    }

    /// The best direction of each slope from an eye.
    fn best_shots(&self, eye: DVec3, points: &[SurfacePoint], frame: &LevelFrame) -> Vec<Shot> {
        let facing: Vec<&SurfacePoint> = points
            .iter()
            .filter(|p| (eye - p.position).dot(p.normal) > 0.0)
            .collect();
        let rays: Vec<Ray> = facing
            .iter()
            .map(|p| Ray {
                // The point's own surface is no obstacle.
                tfar: 1.0 - 1e-3,
                ..Ray::segment(eye.as_vec3(), p.position.as_vec3())
            })
            .collect();
        let mut hits = Vec::new();
        self.embree.closest_hits(&rays, &mut hits);
        let visible: Vec<DVec3> = (facing.iter().zip(&hits))
            .filter_map(|(p, hit)| hit.is_none().then_some(p.position - eye))
            .collect();
        let around = visible.len() as f64 / points.len() as f64;
        let enclosed = self.enclosed(eye);
        SLOPES
            .into_iter()
            .filter_map(|slope| {
                (0..AZIMUTHS)
                    .map(|azimuth| {
                        let forward = frame.forward(azimuth, slope);
                        let seen = frame.count(forward, &visible);
                        (forward, seen)
                    })
                    .reduce(|best, other| if other.1 > best.1 { other } else { best })
                    .map(|(forward, seen)| Shot {
                        eye,
                        forward,
                        seen: seen as f64 / points.len() as f64,
                        around,
                        enclosed,
                    })
            })
            .collect()
    }

    /// 1 for a picture full of lit surface at a distance, less for what spoils it.
    fn quality(&self, shot: &Shot, frame: &LevelFrame, lit_area: f64) -> f64 {
        let near = TOO_NEAR * (shot.around * lit_area).sqrt();
        let rays = frame.look(shot.eye, shot.forward);
        let mut hits = Vec::new();
        self.embree.closest_hits(&rays, &mut hits);
        let eye = self.frame.to_file(shot.eye);
        let good = |hit: &Hit| {
            let far = (f64::from(hit.t) / near).min(1.0);
            match self.panel_seen(hit, eye) {
                Some(_) => far,
                None => 0.0,
            }
        };
        let share = hits.iter().flatten().map(good).sum::<f64>() / hits.len() as f64;
        // Squared: a quarter of the frame spoiled costs nearly half of the points, as does a quarter of the sky.
        (share * shot.enclosed).powi(2)
    }

    /// Share of all directions from an eye that end on a surface.
    fn enclosed(&self, eye: DVec3) -> f64 {
        let sequence = SampleSequence::new(1);
        let rays: Vec<Ray> = (0..AROUND)
            .map(|i| {
                let [s, t, ..] = sequence.point(i).map(f64::from);
                let (height, angle) = (2.0 * s - 1.0, std::f64::consts::TAU * t);
                let level = (1.0 - height * height).sqrt();
                let direction = DVec3::new(level * angle.cos(), level * angle.sin(), height);
                Ray::half_line(eye.as_vec3(), direction.as_vec3(), 0.0)
            })
            .collect();
        let mut hits = Vec::new();
        self.embree.closest_hits(&rays, &mut hits);
        hits.iter().flatten().count() as f64 / f64::from(AROUND)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{SolvedMesh, fixture};
    use super::*;
    use crate::embree::{Device, DeviceConfig};
    use crate::scene::Side;

    const SIZE: [u32; 2] = [160, 90];

    /// Two closed rooms side by side, 4 x 5 x 2.5 each (`axes` orders the coordinates), of which
    /// only the second has light: from `lamp`, one of its sides.
    fn two_rooms(axes: [usize; 3], lamp: u32) -> SolvedMesh {
        let turn = |p: DVec3| DVec3::from_array(axes.map(|a| p[a]));
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for room in 0..2u32 {
            let least = DVec3::new(100.0 + 4.5 * f64::from(room), 7.0, -3.0);
            let corners = fixture::box_corners(least, least + DVec3::new(4.0, 5.0, 2.5));
            positions.extend(corners.into_iter().map(turn));
            triangles.extend(
                (fixture::box_triangles(8 * room).into_iter())
                    .map(|(v, face, surface)| (v, face + 6 * room, surface)),
            );
        }
        let scene = fixture::scene(positions, &triangles, vec![fixture::grey(0.5, 0.0)]);
        let solution = fixture::solve(&scene, fixture::fronts(&scene), 2, |facet, _| {
            match scene.polygons[facet.polygon.index()].source_face {
                face if face < 6 => (0.0, 0.0),
                face if face == 6 + lamp => (50.0, 1.0),
                _ => (0.5, 1.0),
            }
        });
        SolvedMesh::new(&scene, &solution)
    }

    fn camera(mesh: &SolvedMesh) -> Camera {
        let device = Device::new(&DeviceConfig::default()).unwrap();
        View::new(mesh, &device)
            .unwrap()
            .automatic_camera(SIZE, None)
    }

    #[test]
    fn the_camera_stands_in_the_lit_room_and_sees_it() {
        let mesh = two_rooms([0, 1, 2], 5);
        let camera = camera(&mesh);
        assert_eq!(camera.up, DVec3::Z, "the lamp is the side +z");
        let (least, greatest) = (DVec3::new(104.5, 7.0, -3.0), DVec3::new(108.5, 12.0, -0.5));
        let wall = (camera.eye - least).min(greatest - camera.eye);
        assert!(wall.min_element() > 0.1, "{}", camera.eye);
        // Level up to the slopes tried, and upright.
        let forward = (camera.target - camera.eye).normalize();
        assert!(forward.dot(camera.up).abs() < 0.3);
        // Across the room rather than into a wall nearby.
        let device = Device::new(&DeviceConfig::default()).unwrap();
        let picture = View::new(&mesh, &device)
            .unwrap()
            .render(
                &camera.pin_hole().unwrap(),
                &super::super::ViewConfig::default(),
                &std::sync::atomic::AtomicBool::new(false),
            )
            .unwrap();
        let mut depths: Vec<f32> = picture.pixels.iter().map(|p| p.depth).collect();
        depths.sort_by(f32::total_cmp);
        assert!(
            depths[depths.len() / 2] > 2.5,
            "{}",
            depths[depths.len() / 2]
        );
        assert!(picture.pixels.iter().all(|p| p.radiance[0] > 0.0));
    }

    #[test]
    fn the_vertical_is_where_the_lamps_shine_from() {
        // File coordinates (x, z, y): the lamp's side +z of the fixture is +y of the file. Turning
        // axes by one swap mirrors the scene, so sides are seen from outside; flip them back.
        let mut mesh = two_rooms([0, 2, 1], 5);
        for face in &mut mesh.faces {
            face.vertices.swap(1, 2);
            assert_eq!(face.side, Side::Front);
        }
        assert_eq!(camera(&mesh).up, DVec3::Y);
    }

    #[test]
    fn an_up_that_is_given_is_kept() {
        let mesh = two_rooms([0, 1, 2], 5);
        let device = Device::new(&DeviceConfig::default()).unwrap();
        let view = View::new(&mesh, &device).unwrap();
        for up in [UpAxis::X, UpAxis::Y, UpAxis::Z] {
            let camera = view.automatic_camera(SIZE, Some(up));
            assert_eq!(camera.up, up.direction());
            let forward = (camera.target - camera.eye).normalize();
            assert!(forward.dot(camera.up).abs() < 0.3, "{up:?}");
        }
    }

    #[test]
    fn the_camera_stands_indoors_though_more_is_lit_outdoors() {
        // The lit room of the fixture, and around it a lit ground that is seen from above only.
        let least = DVec3::new(0.0, 0.0, 0.0);
        let mut positions: Vec<DVec3> =
            fixture::box_corners(least, least + DVec3::new(4.0, 5.0, 2.5)).to_vec();
        let mut triangles = fixture::box_triangles(0).to_vec();
        let first = positions.len() as u32;
        let (a, b) = (-6.0, 12.0);
        positions.extend([(a, a), (b, a), (b, b), (a, b)].map(|(x, y)| DVec3::new(x, y, -0.5)));
        triangles.push(([first, first + 1, first + 2], 6, 0));
        triangles.push(([first, first + 2, first + 3], 6, 0));
        let scene = fixture::scene(positions, &triangles, vec![fixture::grey(0.5, 0.0)]);
        let solution = fixture::solve(&scene, fixture::fronts(&scene), 2, |facet, _| {
            match scene.polygons[facet.polygon.index()].source_face {
                5 => (5.0, 1.0),
                _ => (1.0, 1.0),
            }
        });
        let eye = camera(&SolvedMesh::new(&scene, &solution)).eye;
        let inside = eye.cmpgt(DVec3::ZERO) & eye.cmplt(DVec3::new(4.0, 5.0, 2.5));
        assert!(inside.all(), "{eye}");
    }

    #[test]
    fn a_scene_without_light_is_seen_from_outside() {
        let mut mesh = two_rooms([0, 1, 2], 5);
        for face in &mut mesh.faces {
            face.radiosity = [0.0; 3];
            face.irradiance = [0.0; 3];
        }
        let camera = camera(&mesh);
        assert!(camera.pin_hole().is_ok());
        assert!(camera.eye.x > 108.5, "{}", camera.eye);
    }

    #[test]
    fn any_number_of_threads_chooses_the_same_camera() {
        let mesh = two_rooms([0, 1, 2], 5);
        let cameras = [1, 3].map(|threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| camera(&mesh))
        });
        assert_eq!(cameras[0], cameras[1]);
    }
}
