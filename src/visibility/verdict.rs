//! The three answers to "do these two elements see each other?".

/// What is known of all segments between two elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Proved: none of them is clear.
    Occluded,
    /// Proved: none of them is blocked.
    Visible,
    /// Neither is proved, which is no evidence for either: the only road to sampling.
    Unknown,
}
