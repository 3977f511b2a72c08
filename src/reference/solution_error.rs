//! The error of a solution against a reference: relative RMS and bias of *reflected* radiosity, mean of the
//! channels, weighted by area, over the faces that reflect anything.

use crate::scene::Side;
use std::collections::BTreeMap;

/// What the reference says of one side of a face, mean of the channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueFace {
    /// 0-based index of the `f` statement.
    pub face: u32,
    /// Which side.
    pub side: Side,
    /// Area, positive.
    pub area: f64,
    /// Reflected radiosity in W/m2.
    pub reflected: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Emitted radiosity, taken off what a solution says.
    pub emitted: f64,
}

/// What a solution says of one side of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolvedLight {
    /// Area of its patches.
    pub area: f64,
    /// Sum of area times radiosity, emission included, mean of the channels.
    pub power: f64,
}

/// A solution, by face and side.
pub type SolvedLights = BTreeMap<(u32, Side), SolvedLight>;

/// One face's part in the error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceError {
    /// 0-based index of the `f` statement.
    pub face: u32,
    /// Which side.
    pub side: Side,
    /// Area.
    pub area: f64,
    /// Reflected radiosity of the solution.
    pub solution: f64,
    /// Reflected radiosity of the reference.
    pub reference: f64,
    /// Standard error of the reference.
    pub standard_error: f64,
    /// Share of the sum of squared errors, in [0, 1].
    pub share: f64,
}

/// How far a solution is off.
#[derive(Clone, Debug, PartialEq)]
pub struct SolutionError {
    /// sqrt(sum A (x - y)^2 / sum A) over the mean of y.
    pub relative_rms: f64,
    /// sum A (x - y) / sum A y.
    pub bias: f64,
    /// The reference's standard errors in the metric of `relative_rms`: what a perfect solution would show.
    pub noise: f64,
    /// The reference's standard errors in the metric of `bias`.
    pub bias_noise: f64,
    /// Area-weighted mean of the reference's reflected radiosity.
    pub mean: f64,
    /// Every compared face, the greatest share first, ties by face and side.
    pub faces: Vec<FaceError>,
    /// Compared faces that the solution lacks and that count as black, ascending.
    pub missing: Vec<(u32, Side)>,
}

/// There is nothing to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NothingToCompare {
    /// No face reflects.
    #[error("no face of the reference has a reflectance above 0")]
    NoFace,
    /// The mean is zero.
    #[error("no face of the reference reflects any light, so there is no relative error")]
    AllBlack,
}

/// What a reference itself is good for: the error that a perfect solution would show against it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceNoise {
    /// Its standard errors in the metric of [`SolutionError::relative_rms`].
    pub relative_rms: f64,
    /// Its standard errors in the metric of [`SolutionError::bias`].
    pub bias: f64,
    /// Area-weighted mean of its reflected radiosity, in W/m2; positive.
    pub mean: f64,
}

/// The noise of a reference, of its faces that reflect.
///
/// # Errors
/// Where the mean that it is relative to is not positive.
pub fn reference_noise(truth: &[TrueFace]) -> Result<ReferenceNoise, NothingToCompare> {
    if truth.is_empty() {
        return Err(NothingToCompare::NoFace);
    }
    let (mut area, mut light, mut squares, mut bias_squares) = (0.0, 0.0, 0.0, 0.0);
    for face in truth {
        area += face.area;
        light += face.area * face.reflected;
        squares += face.area * face.standard_error * face.standard_error;
        bias_squares += (face.area * face.standard_error).powi(2);
    }
    if light <= 0.0 {
        return Err(NothingToCompare::AllBlack);
    }
    let mean = light / area;
    Ok(ReferenceNoise {
        relative_rms: (squares / area).sqrt() / mean,
        bias: bias_squares.sqrt() / light,
        mean,
    })
}

/// Compares a solution with the faces of a reference that reflect. What a solution lacks of a face's area
/// counts as black.
///
/// # Errors
/// Where the mean to compare with is not positive.
pub fn solution_error(
    truth: &[TrueFace],
    solved: &SolvedLights,
) -> Result<SolutionError, NothingToCompare> {
    let noise = reference_noise(truth)?;
    let mut missing = Vec::new();
    let (mut area, mut light, mut squares, mut differences) = (0.0, 0.0, 0.0, 0.0);
    let mut faces = Vec::with_capacity(truth.len());
    for face in truth {
        let x = match solved.get(&(face.face, face.side)) {
            Some(light) => light.power / light.area.max(face.area) - face.emitted,
            None => {
                missing.push((face.face, face.side));
                0.0
            }
        };
        let difference = x - face.reflected;
        area += face.area;
        light += face.area * face.reflected;
        squares += face.area * difference * difference;
        differences += face.area * difference;
        faces.push(FaceError {
            face: face.face,
            side: face.side,
            area: face.area,
            solution: x,
            reference: face.reflected,
            standard_error: face.standard_error,
            share: face.area * difference * difference,
        });
    }
    for face in &mut faces {
        face.share = if squares > 0.0 {
            face.share / squares
        } else {
            0.0
        };
    }
    let place = |f: &FaceError| (f.face, f.side);
    faces.sort_by(|a, b| b.share.total_cmp(&a.share).then(place(a).cmp(&place(b))));
    missing.sort_unstable();
    Ok(SolutionError {
        relative_rms: (squares / area).sqrt() / noise.mean,
        bias: differences / light,
        noise: noise.relative_rms,
        bias_noise: noise.bias,
        mean: noise.mean,
        faces,
        missing,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(face: u32, area: f64, reflected: f64, standard_error: f64) -> TrueFace {
        TrueFace {
            face,
            side: Side::Front,
            area,
            reflected,
            standard_error,
            emitted: 0.0,
        }
    }

    fn solved(faces: &[(u32, f64, f64)]) -> SolvedLights {
        faces
            .iter()
            .map(|&(face, area, radiosity)| {
                let power = area * radiosity;
                ((face, Side::Front), SolvedLight { area, power })
            })
            .collect()
    }

    #[track_caller]
    fn close(got: f64, want: f64) {
        assert!(
            (got - want).abs() <= 1e-12 * want.abs().max(1.0),
            "{got} is not {want}"
        );
    }

    #[test]
    fn three_faces_by_hand() {
        let truth = [
            truth(0, 1.0, 2.0, 0.1),
            truth(1, 3.0, 1.0, 0.2),
            TrueFace {
                emitted: 5.0,
                ..truth(2, 4.0, 0.5, 0.0)
            },
        ];
        let error = solution_error(
            &truth,
            &solved(&[(0, 1.0, 2.4), (1, 3.0, 0.9), (2, 4.0, 5.5)]),
        )
        .unwrap();
        // Mean (2 + 3 + 2) / 8; squares 0.16 + 0.03 + 0; differences 0.4 - 0.3.
        close(error.mean, 0.875);
        close(error.relative_rms, (0.19f64 / 8.0).sqrt() / 0.875);
        close(error.bias, 0.1 / 7.0);
        close(error.noise, (0.13f64 / 8.0).sqrt() / 0.875);
        close(error.bias_noise, (0.01f64 + 0.36).sqrt() / 7.0);
        assert!(error.missing.is_empty());
        let order: Vec<u32> = error.faces.iter().map(|f| f.face).collect();
        assert_eq!(order, [0, 1, 2]);
        close(error.faces[0].share, 0.16 / 0.19);
    }

    #[test]
    fn what_is_missing_is_black() {
        let truth = [
            truth(7, 1.0, 1.0, 0.0),
            truth(8, 1.0, 1.0, 0.0),
            TrueFace {
                emitted: 9.0,
                ..truth(9, 2.0, 1.0, 0.0)
            },
        ];
        // Half of face 7 is there; 9 is missing, and is not charged with its emission.
        let error = solution_error(&truth, &solved(&[(7, 0.5, 1.0), (8, 1.0, 1.0)])).unwrap();
        assert_eq!(error.missing, [(9, Side::Front)]);
        close(error.bias, -(0.5 + 2.0) / 4.0);
        close(error.relative_rms, ((0.25f64 + 2.0) / 4.0).sqrt());
    }

    #[test]
    fn the_same_is_no_error() {
        let truth = [truth(0, 2.0, 3.0, 0.0)];
        let error = solution_error(&truth, &solved(&[(0, 2.0, 3.0)])).unwrap();
        assert_eq!((error.relative_rms, error.bias), (0.0, 0.0));
        assert_eq!(error.faces[0].share, 0.0);
    }

    #[test]
    fn nothing_to_compare_with() {
        let black = [truth(0, 1.0, 0.0, 0.0)];
        let lights = SolvedLights::new();
        assert_eq!(
            solution_error(&black, &lights),
            Err(NothingToCompare::AllBlack)
        );
        assert_eq!(solution_error(&[], &lights), Err(NothingToCompare::NoFace));
    }
}
