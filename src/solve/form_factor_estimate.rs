//! The oracle's estimate of a form factor.

use super::element::Element;
use std::f32::consts::PI;

/// An estimate from above of the form factor source -> receiver for the oracle: the point kernel with
/// each cosine raised by the angular radius of the other end, which a zero at the centres cannot hide.
pub fn oracle_form_factor(source: &Element, receiver: &Element) -> f32 {
    let d = receiver.centroid - source.centroid;
    let distance2 = d.length_squared();
    if distance2 <= 0.0 {
        return 1.0;
    }
    let inverse = 1.0 / distance2.sqrt();
    let spread = (source.radius + receiver.radius) * inverse;
    let cos_source = (source.normal.dot(d) * inverse).max(0.0) + spread + source.cone_sin;
    let cos_receiver = (-receiver.normal.dot(d) * inverse).max(0.0) + spread + receiver.cone_sin;
    let f = receiver.area * cos_source.min(1.0) * cos_receiver.min(1.0)
        / (PI * distance2 + receiver.area);
    f.min(1.0)
}
