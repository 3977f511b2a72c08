//! Typed 32-bit indices, so that a facet is never looked up where a polygon is meant.

macro_rules! typed_id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id of the element at `index`; panics beyond 32 bits (the loader refuses such scenes).
            pub fn new(index: usize) -> Self {
                Self(u32::try_from(index).expect("scenes are limited to 2^32 elements"))
            }

            /// The index as `usize`.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

typed_id!(
    /// A triangle of the validated scene (`Scene::polygons`).
    PolygonId
);
typed_id!(
    /// One side of a polygon, in the order of the hierarchy (`Hierarchy::facets`).
    FacetId
);
typed_id!(
    /// A node of the scene hierarchy (`Hierarchy::nodes`).
    NodeId
);
