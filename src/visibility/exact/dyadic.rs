//! Exact numbers `mantissa * 2^exponent`: closed under addition and multiplication, which is all
//! that the judges need (they compare `numerator > threshold * denominator` and never divide), and
//! without the greatest common divisors of rationals.

use glam::DVec3;
use num_bigint::{BigInt, Sign};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// An exact number.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

impl Dyadic {
    pub(super) fn zero() -> Self {
        Self {
            mantissa: BigInt::ZERO,
            exponent: 0,
        }
    }

    pub(super) fn square(&self) -> Self {
        self * self
    }

    pub(super) fn signum(&self) -> i32 {
        match self.mantissa.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }

    pub(super) fn abs(&self) -> Self {
        if self.signum() < 0 {
            -self
        } else {
            self.clone()
        }
    }
}

impl From<f64> for Dyadic {
    /// Exact for every finite number; infinities and NaN are taken for zero, which validated scenes
    /// never hold.
    fn from(value: f64) -> Self {
        if value == 0.0 || !value.is_finite() {
            return Self::zero();
        }
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i64;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (magnitude, exponent) = if biased == 0 {
            (fraction, -1074)
        } else {
            (fraction | (1 << 52), biased - 1075)
        };
        let signed = if value < 0.0 { -magnitude } else { magnitude };
        Self {
            mantissa: BigInt::from(signed),
            exponent,
        }
    }
}

impl From<f32> for Dyadic {
    fn from(value: f32) -> Self {
        Self::from(f64::from(value))
    }
}

impl Add for &Dyadic {
    type Output = Dyadic;

    fn add(self, other: &Dyadic) -> Dyadic {
        if self.signum() == 0 {
            return other.clone();
        }
        if other.signum() == 0 {
            return self.clone();
        }
        let (low, high) = if self.exponent <= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        Dyadic {
            mantissa: &low.mantissa + (&high.mantissa << (high.exponent - low.exponent)),
            exponent: low.exponent,
        }
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;

    fn neg(self) -> Dyadic {
        Dyadic {
            mantissa: -&self.mantissa,
            exponent: self.exponent,
        }
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;

    fn sub(self, other: &Dyadic) -> Dyadic {
        self + &-other
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;

    fn mul(self, other: &Dyadic) -> Dyadic {
        Dyadic {
            mantissa: &self.mantissa * &other.mantissa,
            exponent: self.exponent + other.exponent,
        }
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        (self - other).signum().cmp(&0)
    }
}

/// A vector of exact numbers.
#[derive(Clone, Debug)]
pub(super) struct DyadicVector(pub [Dyadic; 3]);

impl DyadicVector {
    pub(super) fn dot(&self, other: &Self) -> Dyadic {
        self.0
            .iter()
            .zip(&other.0)
            .fold(Dyadic::zero(), |sum, (a, b)| &sum + &(a * b))
    }

    pub(super) fn cross(&self, other: &Self) -> Self {
        let part = |i: usize, j: usize| &(&self.0[i] * &other.0[j]) - &(&self.0[j] * &other.0[i]);
        Self([part(1, 2), part(2, 0), part(0, 1)])
    }

    pub(super) fn length_squared(&self) -> Dyadic {
        self.dot(self)
    }

    pub(super) fn scale(&self, factor: &Dyadic) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] * factor))
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] + &other.0[i]))
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] - &other.0[i]))
    }
}

impl From<DVec3> for DyadicVector {
    fn from(v: DVec3) -> Self {
        Self([v.x.into(), v.y.into(), v.z.into()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_integers(a in -1_000_000_i64..1_000_000, b in -1_000_000_i64..1_000_000, s in -60_i32..60) {
            let scale = 2.0_f64.powi(s);
            let (x, y) = (Dyadic::from(a as f64 * scale), Dyadic::from(b as f64 * scale));
            prop_assert_eq!(&x + &y, Dyadic::from((a + b) as f64 * scale));
            prop_assert_eq!(&x - &y, Dyadic::from((a - b) as f64 * scale));
            prop_assert_eq!(&x * &y, Dyadic::from((a * b) as f64 * scale * scale));
            prop_assert_eq!(x.cmp(&y), a.cmp(&b));
        }
    }

    #[test]
    fn keeps_what_f64_loses() {
        let tiny = Dyadic::from(f64::from_bits(1));
        let one = Dyadic::from(1.0);
        assert!(&one + &tiny > one);
        assert_eq!(&(&one + &tiny) - &one, tiny);
    }
}
