//! What counts as an occluder, and how many of them are wanted.

/// Configuration of the extraction. Sizes are relative, so that no answer depends on units.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct OccluderConfig {
    /// Rectangles kept of one flat cluster at most (`--occluders`).
    pub per_cluster: usize,
    /// Smallest area of a rectangle, and of a cluster worth a try, as a fraction of the squared
    /// diagonal of the scene (`--occluder-size`).
    pub min_area: f64,
    /// A cluster is flat while the angle that its deviation makes over its width is below this, in
    /// degrees (`--flatness`). The paper asks 1 degree of the normals.
    pub flatness_degrees: f64,
    /// Greatest angle in degrees between the cluster's normal and that of any of its facets that is
    /// not a sliver. It parts sheets from thin solids, whose two sides would otherwise be one
    /// "flat" cluster; the flatness bounds everything finer.
    pub cone_degrees: f64,
    /// Lets a rectangle stick out over the border of its surface by up to 0.67 w, as far as no claim
    /// becomes false: a segment there grazes the surface within w. Without it, nothing that reaches
    /// down to the floor on both sides of a wall could be proved occluded by the wall, which ends at
    /// the floor. Off, every rectangle lies inside the footprint (cracks apart).
    pub flush: bool,
    /// Looks for solids behind the largest rectangles ([`super::Solid`]).
    pub solids: bool,
}

impl Default for OccluderConfig {
    fn default() -> Self {
        Self {
            // A wall with a door and a few windows needs this many to be covered by over 85 %.
            per_cluster: 8,
            // 0.1 m2 in a flat of 30 m diagonal: smaller ones hide next to nothing.
            min_area: 1.0e-4,
            flatness_degrees: 1.0,
            // The riser of a step is perpendicular; bevels and panels of doors are not.
            cone_degrees: 45.0,
            flush: true,
            solids: true,
        }
    }
}
