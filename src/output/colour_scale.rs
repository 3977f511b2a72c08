//! False colours: numbers to colours whose brightness grows with the number, so that they are read
//! right in grey and by people who do not see red and green alike.
//!
//! Colours are chosen in OKLab (Ottosson 2020), in which equal steps look equal.

use std::f64::consts::TAU;

/// How numbers become colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourScale {
    /// What is shown.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The numbers at the ends. What lies beyond has the colour of the end.
    pub range: [f64; 2],
    /// How numbers are spread between them.
    pub spread: Spread,
}

/// How numbers are spread over the colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Evenly from the least to the greatest, dark to bright.
    Linear,
    /// Evenly by their logarithms, dark to bright.
    Logarithmic,
    /// Evenly about zero: blue below, white at zero, red above.
    Signed,
}

/// Share of the numbers that may lie beyond each end of an automatic scale: a few bright spots must
/// not darken the rest.
const BEYOND: f64 = 0.005;

/// Greatest ratio of the ends of a logarithmic scale: five powers of ten are what an eye tells apart.
const DECADES: f64 = 1.0e5;

impl ColourScale {
    /// A scale that suits `values`, each with its weight, such as an area; `greatest` sets its upper end instead.
    pub fn new(
        label: &'static str,
        unit: &'static str,
        spread: Spread,
        values: impl Iterator<Item = (f64, f64)>,
        greatest: Option<f64>,
    ) -> Self {
        let mut sorted: Vec<(f64, f64)> = values
            .map(|(x, weight)| match spread {
                Spread::Signed => (x.abs(), weight),
                Spread::Linear | Spread::Logarithmic => (x, weight),
            })
            .filter(|(x, weight)| x.is_finite() && *x > 0.0 && *weight > 0.0)
            .collect();
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
        let at = |share: f64| {
            let mut sum = 0.0;
            let found = sorted.iter().find(|(_, weight)| {
                sum += weight;
                sum >= share * total
            });
            found.or(sorted.last()).map(|&(x, _)| x)
        };
        let high = greatest.or(at(1.0 - BEYOND)).unwrap_or(1.0);
        let low = match spread {
            Spread::Linear => 0.0,
            Spread::Signed => -high,
            Spread::Logarithmic => {
                let least = at(BEYOND).unwrap_or(0.1 * high);
                // A scale needs some length even where all numbers are one.
                least.max(high / DECADES).min(0.1 * high)
            }
        };
        Self {
            label,
            unit,
            range: [low, high],
            spread,
        }
    }

    /// Place of a number on the scale, in [0, 1].
    pub fn place(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let place = match self.spread {
            Spread::Logarithmic => (value.max(low) / low).ln() / (high / low).ln(),
            Spread::Linear | Spread::Signed => (value - low) / (high - low),
        };
        // Not a number has no place: it stands at the lower end.
        if place > 0.0 { place.min(1.0) } else { 0.0 }
    }

    /// The number at a place in [0, 1].
    pub fn value(&self, place: f64) -> f64 {
        let [low, high] = self.range;
        match self.spread {
            Spread::Logarithmic => low * (high / low).powf(place),
            Spread::Linear | Spread::Signed => low + (high - low) * place,
        }
    }

    /// Colour of a number, in linear light.
    pub fn colour(&self, value: f64) -> [f32; 3] {
        self.colour_at(self.place(value))
    }

    /// Colour of a place in [0, 1].
    pub fn colour_at(&self, place: f64) -> [f32; 3] {
        match self.spread {
            Spread::Signed => {
                let away = 2.0 * place - 1.0;
                let hue = if away < 0.0 { BLUE } else { RED };
                let strength = away.abs();
                oklab(1.0 - 0.5 * strength, 0.19 * strength, hue)
            }
            Spread::Linear | Spread::Logarithmic => {
                // From blue over purple and red to yellow: lightness grows all the way.
                let hue = BLUE + (YELLOW + 1.0 - BLUE) * place;
                let chroma = 0.19 * (1.0 - (2.0 * place - 1.0).powi(4));
                oklab(0.12 + 0.85 * place, chroma, hue)
            }
        }
    }

    /// The scale in words.
    pub fn describe(&self) -> String {
        let [low, high] = self.range;
        let spread = match self.spread {
            Spread::Linear => "linear, dark to bright",
            Spread::Logarithmic => "logarithmic, dark to bright",
            Spread::Signed => "blue is too dark, red too bright",
        };
        format!(
            "{}: {} to {} {} ({spread})",
            self.label,
            short(low),
            short(high),
            self.unit
        )
    }
}

/// Hues of OKLab in turns.
const BLUE: f64 = 0.74;
const RED: f64 = 0.08;
const YELLOW: f64 = 0.29;

/// A colour by lightness, chroma and hue (in turns), as linear Rec. 709, brought into [0, 1].
pub(super) fn oklab(lightness: f64, chroma: f64, hue: f64) -> [f32; 3] {
    let (sine, cosine) = (TAU * hue).sin_cos();
    let (a, b) = (chroma * cosine, chroma * sine);
    // The two matrices of Ottosson's definition.
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
    .map(|x| x.clamp(0.0, 1.0) as f32)
}

/// A number in as few characters as a legend has room for.
pub(super) fn short(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1.0e-3..1.0e4).contains(&size) {
        format!("{x:.1e}")
    } else {
        let digits = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        let text = format!("{x:.digits$}");
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(spread: Spread, values: &[f64]) -> ColourScale {
        ColourScale::new("x", "W/m2", spread, values.iter().map(|&x| (x, 1.0)), None)
    }

    fn luminance(colour: [f32; 3]) -> f32 {
        0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
    }

    #[test]
    fn greater_is_brighter_all_along() {
        for spread in [Spread::Linear, Spread::Logarithmic] {
            let scale = scale(spread, &[0.5, 1.0, 40.0, 100.0]);
            let brightness: Vec<f32> = (0..=100)
                .map(|i| luminance(scale.colour_at(f64::from(i) / 100.0)))
                .collect();
            assert!(brightness.windows(2).all(|w| w[0] < w[1]), "{brightness:?}");
            assert!(brightness[0] < 0.01 && brightness[100] > 0.8);
        }
    }

    #[test]
    fn signed_colours_are_white_at_zero_and_blue_and_red_beside_it() {
        let scale = scale(Spread::Signed, &[-0.2, 0.1]);
        assert_eq!(scale.range, [-0.2, 0.2]);
        assert!(scale.colour(0.0).iter().all(|&c| c > 0.99));
        let [r, _, b] = scale.colour(-0.2);
        assert!(b > 2.0 * r);
        let [r, _, b] = scale.colour(0.2);
        assert!(r > 2.0 * b);
    }

    #[test]
    fn places_and_values_are_inverse_and_ends_hold() {
        for spread in [Spread::Linear, Spread::Logarithmic, Spread::Signed] {
            let scale = scale(spread, &[0.5, 1.0, 40.0, 100.0]);
            for i in 0..=10 {
                let place = f64::from(i) / 10.0;
                assert!((scale.place(scale.value(place)) - place).abs() < 1e-12);
            }
            for (value, place) in [
                (1e9, 1.0),
                (f64::INFINITY, 1.0),
                (-1e9, 0.0),
                (f64::NAN, 0.0),
            ] {
                assert_eq!(scale.place(value), place, "{spread:?} {value}");
            }
        }
    }

    #[test]
    fn numbers_that_say_nothing_still_give_a_scale() {
        for spread in [Spread::Linear, Spread::Logarithmic, Spread::Signed] {
            for values in [&[][..], &[0.0, 0.0], &[f64::NAN], &[3.0, 3.0]] {
                let [low, high] = scale(spread, values).range;
                assert!(low < high && low.is_finite() && high.is_finite());
            }
        }
        let given = ColourScale::new("x", "", Spread::Linear, [(1.0, 1.0)].into_iter(), Some(7.0));
        assert_eq!(given.range, [0.0, 7.0]);
    }

    #[test]
    fn the_ends_are_chosen_by_weight() {
        let values = [(1.0, 1.0), (10.0, 998.0), (1000.0, 1.0)];
        let scale = ColourScale::new("x", "", Spread::Linear, values.into_iter(), None);
        assert_eq!(scale.range, [0.0, 10.0]);
    }

    #[test]
    fn short_numbers() {
        for (x, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (123.456, "123"),
            (0.25, "0.25"),
            (-12.5, "-12.5"),
            (100.0, "100"),
            (1234.0, "1234"),
            (1.0e7, "1.0e7"),
            (2.0e-4, "2.0e-4"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}
