//! Faults that the audit's own tests plant in the engine, to see that the audit finds them.
//!
//! Outside tests and the feature `plant-faults` no fault can be planted and every question below is
//! a constant `false`.

/// Which faults are planted; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// A shaft wholly beside the rectangle passes for one that goes through it.
    #[cfg(any(test, feature = "plant-faults"))]
    pub beside_is_inside: bool,
    /// On an early stop the unvisited nodes are not appended to the survivors.
    #[cfg(any(test, feature = "plant-faults"))]
    pub survivors_cut: bool,
    /// Polygons much longer than wide are taken to miss every shaft.
    #[cfg(any(test, feature = "plant-faults"))]
    pub slivers_forgotten: bool,
    /// Pairs count as hidden by parts of which one was never looked at.
    #[cfg(any(test, feature = "plant-faults"))]
    pub part_forgotten: bool,
    /// Surfaces count as cutting a shaft though they have a border in it.
    #[cfg(any(test, feature = "plant-faults"))]
    pub borders_forgotten: bool,
}

impl Faults {
    /// No fault.
    pub const NONE: Self = Self {
        #[cfg(any(test, feature = "plant-faults"))]
        beside_is_inside: false,
        #[cfg(any(test, feature = "plant-faults"))]
        survivors_cut: false,
        #[cfg(any(test, feature = "plant-faults"))]
        slivers_forgotten: false,
        #[cfg(any(test, feature = "plant-faults"))]
        part_forgotten: false,
        #[cfg(any(test, feature = "plant-faults"))]
        borders_forgotten: false,
    };
}

macro_rules! question {
    ($name:ident, $field:ident) => {
        #[cfg(any(test, feature = "plant-faults"))]
        #[inline(always)]
        pub(super) fn $name(self) -> bool {
            self.$field
        }

        #[cfg(not(any(test, feature = "plant-faults")))]
        #[inline(always)]
        pub(super) fn $name(self) -> bool {
            false
        }
    };
}

impl Faults {
    question!(beside_counts_as_inside, beside_is_inside);
    question!(cuts_survivors, survivors_cut);
    question!(forgets_slivers, slivers_forgotten);
    question!(forgets_a_part, part_forgotten);
    question!(forgets_borders, borders_forgotten);
}
