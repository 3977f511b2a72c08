//! From radiance to pixels: exposure, a filmic curve, sRGB encoding.

/// Luminance of linear Rec. 709 red, green and blue (ITU-R BT.709-6, item 3.2).
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Where the scene's log-average luminance lands before the curve: the photographer's middle grey
/// (Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 2).
const MIDDLE_GREY: f64 = 0.18;

/// Samples darker than this fraction of the mean count as if they were that bright: a corner that
/// no light reaches must not brighten the rest of the picture without limit.
const DARKEST: f64 = 1.0e-3;

/// Maps linear colours to 8-bit sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    scale: f64,
}

impl ToneMap {
    /// Multiplies by `scale` (not negative, finite) before the curve.
    pub fn with_scale(scale: f64) -> Self {
        Self { scale }
    }

    /// Exposes so that the log-average luminance of the lit samples becomes middle grey. A sample
    /// is a colour and its weight (pixels, or an area); black samples say nothing and are left out.
    /// Without any lit sample the scale is 1.
    pub fn automatic<I>(samples: I) -> Self
    where
        I: Iterator<Item = ([f32; 3], f64)> + Clone,
    {
        let lit = samples
            .map(|(colour, weight)| (luminance(colour), weight))
            .filter(|&(y, weight)| y > 0.0 && y.is_finite() && weight > 0.0);
        let (sum, total) = lit
            .clone()
            .fold((0.0, 0.0), |(s, t), (y, w)| (s + w * y, t + w));
        if total == 0.0 {
            return Self { scale: 1.0 };
        }
        let floor = DARKEST * sum / total;
        let log_average = (lit.fold(0.0, |s, (y, w)| s + w * y.max(floor).ln()) / total).exp();
        Self {
            scale: MIDDLE_GREY / log_average,
        }
    }

    /// This exposure, `stops` stops brighter (darker where negative).
    #[must_use]
    pub fn brighter(self, stops: f64) -> Self {
        Self {
            scale: self.scale * stops.exp2(),
        }
    }

    /// The factor before the curve.
    pub fn scale(self) -> f64 {
        self.scale
    }

    /// A linear colour as the linear light of a display, in [0, 1].
    pub fn display(self, colour: [f32; 3]) -> [f32; 3] {
        colour.map(|c| filmic(self.scale * f64::from(c).max(0.0)) as f32)
    }

    /// A linear colour as 8-bit sRGB.
    pub fn encode(self, colour: [f32; 3]) -> [u8; 3] {
        colour.map(|c| {
            let display = srgb(filmic(self.scale * f64::from(c).max(0.0)));
            // Rounds to nearest; the curve keeps it in [0, 255].
            (255.0 * display + 0.5) as u8
        })
    }
}

/// Luminance of a linear colour.
fn luminance(colour: [f32; 3]) -> f64 {
    (0..3).map(|i| LUMINANCE[i] * f64::from(colour[i])).sum()
}

/// The filmic curve: Narkowicz's rational fit of the ACES reference transform (2015), clamped to
/// [0, 1]. It rises from 0 with a soft toe and reaches 1 at about 16 times middle grey's reciprocal.
fn filmic(x: f64) -> f64 {
    // Beyond this the quotient is above 1, and the squares could overflow.
    let x = x.min(1.0e6);
    ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

/// The sRGB transfer function (IEC 61966-2-1) of a linear value in [0, 1].
pub(super) fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_from_black_to_white() {
        let map = ToneMap::with_scale(1.0);
        assert_eq!(map.encode([0.0; 3]), [0; 3]);
        assert_eq!(map.encode([-1.0, f32::NAN, f32::INFINITY]), [0, 0, 255]);
        let greys: Vec<u8> = (0..=1000)
            .map(|i| map.encode([i as f32 * 0.02; 3])[0])
            .collect();
        assert!(greys.is_sorted());
        assert_eq!(greys[1000], 255);
    }

    #[test]
    fn srgb_agrees_with_the_standard_at_its_joint_and_end() {
        assert!((srgb(0.003_130_8) - 0.040_449_936).abs() < 1e-6);
        assert!((srgb(1.0) - 1.0).abs() < 1e-12);
        assert!((srgb(0.214_041_14) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn exposure_does_not_depend_on_units_or_weights() {
        let colours = [
            [1.0, 2.0, 3.0],
            [0.5, 0.5, 0.5],
            [0.0; 3],
            [40.0, 30.0, 20.0f32],
        ];
        let map = |factor: f32, weight: f64| {
            ToneMap::automatic(colours.iter().map(move |c| (c.map(|x| x * factor), weight)))
        };
        let (a, b) = (map(1.0, 1.0), map(1024.0, 7.0));
        assert!((a.scale() / (b.scale() * 1024.0) - 1.0).abs() < 1e-12);
        assert_eq!(a.brighter(3.0).scale(), 8.0 * a.scale());
    }

    #[test]
    fn a_uniform_picture_becomes_middle_grey() {
        let map = ToneMap::automatic([([5.0f32; 3], 2.0); 4].into_iter());
        assert!((map.scale() * 5.0 - MIDDLE_GREY).abs() < 1e-12);
    }

    #[test]
    fn a_black_picture_stays_black() {
        let map = ToneMap::automatic([([0.0f32; 3], 1.0)].into_iter());
        assert_eq!(map.scale(), 1.0);
    }
}
