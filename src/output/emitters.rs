//! The parts of a solved mesh that shine by themselves, for sampling them.

use super::panel::Panels;
use super::view::Frame;
use super::{SolvedFace, SolvedMesh};
use glam::Vec3;

/// Share of a panel's radiosity below which what its irradiance does not explain is rounding: the
/// reflectance read off a mesh is good to some 1e-5 ([`super::smoothing`]).
const TELLING: f64 = 1.0e-3;

/// Share of the light samples that go to emitters by power alone. So none is ever forgotten, though
/// the rest are chosen for the middle of a pixel and used all over it.
const BY_POWER: f64 = 0.1;

/// Most emitters that are weighed anew for each pixel; of more, all are chosen by power. The cost of
/// weighing 4,096 is that of some forty rays.
const MOST_WEIGHED: usize = 4096;

/// A triangle that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Emitter {
    /// Corners in the units of the rays, counter-clockwise seen from the shining side.
    pub corners: [Vec3; 3],
    /// Unit normal of the shining side.
    pub normal: Vec3,
    /// Area in the square of the units of the rays.
    pub area: f64,
    /// Emitted radiosity in W/m2.
    pub emitted: [f64; 3],
    /// Sum of `emitted` times `area`.
    power: f64,
    centre: Vec3,
    /// Square of the greatest distance of a corner to the centre.
    radius2: f32,
}

/// All emitters of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    pub emitters: Vec<Emitter>,
    /// By panel; `u32::MAX` for those that do not shine.
    of_panel: Vec<u32>,
    power: f64,
}

/// With what chance each emitter is chosen.
#[derive(Clone, Debug, Default)]
pub(super) struct Choice {
    /// Chances summed up to and including each emitter.
    sums: Vec<f64>,
}

impl Emitters {
    /// Finds them: what a panel's irradiance and `reflectance` do not explain, it emits.
    pub fn new(
        mesh: &SolvedMesh,
        panels: &Panels,
        reflectance: &[[f32; 3]],
        frame: &Frame,
    ) -> Self {
        let mut found = Self {
            of_panel: vec![u32::MAX; panels.panels.len()],
            ..Self::default()
        };
        for (p, panel) in panels.panels.iter().enumerate() {
            let faces = &mesh.faces[panels.leaf_range(panel)];
            let emitted = unexplained(faces, reflectance[p]);
            if emitted == [0.0; 3] {
                continue;
            }
            let corners = panel
                .corners
                .map(|v| frame.point(panels.positions[v as usize]));
            let [a, b, c] = corners;
            let cross = (b - a).as_dvec3().cross((c - a).as_dvec3());
            let area = 0.5 * cross.length();
            let power = area * emitted.iter().sum::<f64>();
            if !(power > 0.0 && power.is_finite()) {
                continue;
            }
            let centre = (a + b + c) / 3.0;
            found.of_panel[p] = found.emitters.len() as u32;
            found.power += power;
            found.emitters.push(Emitter {
                corners,
                normal: cross.normalize_or_zero().as_vec3(),
                area,
                emitted,
                power,
                centre,
                radius2: corners
                    .iter()
                    .fold(0.0, |r, v| r.max(v.distance_squared(centre))),
            });
        }
        found
    }

    /// The emitter of a panel.
    pub fn of_panel(&self, panel: usize) -> Option<usize> {
        let emitter = self.of_panel[panel];
        (emitter != u32::MAX).then_some(emitter as usize)
    }

    /// Weighs the emitters for places near `at`, whose normal is `normal`: by power over squared
    /// distance, those that face it.
    pub fn choose_for(&self, at: Vec3, normal: Vec3, choice: &mut Choice) {
        choice.sums.clear();
        let local = |e: &Emitter| {
            let faces = e.normal.dot(at - e.centre) > 0.0
                && e.corners
                    .iter()
                    .any(|&corner| normal.dot(corner - at) > 0.0);
            let distance2 = e.centre.distance_squared(at) + e.radius2;
            match faces {
                true => e.power / f64::from(distance2).max(f64::MIN_POSITIVE),
                false => 0.0,
            }
        };
        if self.emitters.len() <= MOST_WEIGHED {
            choice.sums.extend(self.emitters.iter().map(local));
        } else {
            choice.sums.resize(self.emitters.len(), 0.0);
        }
        let all: f64 = choice.sums.iter().sum();
        let by_power = if all > 0.0 { BY_POWER } else { 1.0 };
        let scale = if all > 0.0 {
            (1.0 - BY_POWER) / all
        } else {
            0.0
        };
        let mut sum = 0.0;
        for (chance, emitter) in choice.sums.iter_mut().zip(&self.emitters) {
            sum += *chance * scale + by_power * emitter.power / self.power;
            *chance = sum;
        }
    }
}

impl Choice {
    /// The emitter that `u` in [0, 1) chooses, and what is left of `u`, again even in [0, 1]: so points stay evenly
    /// spread over each emitter. `None` without any.
    pub fn choose(&self, u: f64) -> Option<(usize, f64)> {
        let at = u * self.sums.last()?;
        let chosen = self.sums.partition_point(|&sum| sum <= at);
        let chosen = chosen.min(self.sums.len() - 1);
        let before = self.before(chosen);
        let rest = (at - before) / (self.sums[chosen] - before);
        Some((chosen, if rest > 0.0 { rest.min(1.0) } else { 0.0 }))
    }

    fn before(&self, emitter: usize) -> f64 {
        match emitter.checked_sub(1) {
            Some(last) => self.sums[last],
            None => 0.0,
        }
    }

    /// With what chance it is chosen.
    pub fn chance(&self, emitter: usize) -> f64 {
        let total = self.sums.last().copied().unwrap_or(1.0);
        (self.sums[emitter] - self.before(emitter)) / total
    }
}

/// Mean radiosity of `faces` that `reflectance` times irradiance leaves over; zero where that is no
/// more than rounding.
fn unexplained(faces: &[SolvedFace], reflectance: [f32; 3]) -> [f64; 3] {
    let (mut over, mut whole) = ([0.0f64; 3], 0.0f64);
    for face in faces {
        for c in 0..3 {
            let b = f64::from(face.radiosity[c]);
            over[c] += b - f64::from(reflectance[c]) * f64::from(face.irradiance[c]);
            whole += b;
        }
    }
    let count = faces.len() as f64;
    if over.iter().sum::<f64>() <= TELLING * whole {
        return [0.0; 3];
    }
    over.map(|x| x.max(0.0) / count)
}
