//! The eight-wide irradiance against its scalar twin.

use super::composite_rule::CompositeRule;
use super::irradiance_kernel::{Shining, irradiance_on};
use super::triangle_vector::triangle_vector;
use glam::Vec3;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0f32..1.0).prop_map(Vec3::from)
}

proptest! {
    /// Random triangles at any distance, before, behind and across each other's horizons.
    #[test]
    fn octets_agree_with_the_scalar_rules(
        source in prop::array::uniform3(vector()),
        receiver in prop::array::uniform3(vector()),
        away in vector(),
        distance in 0.0f32..60.0,
    ) {
        let cross = (source[1] - source[0]).cross(source[2] - source[0]);
        let facing = (receiver[1] - receiver[0]).cross(receiver[2] - receiver[0]);
        prop_assume!(cross.length() > 1.0e-2 && facing.length() > 1.0e-2);
        let receiver = receiver.map(|p| p + away * distance);
        let (normal, tau) = (facing.normalize(), 1.0e-6);
        let shining = Shining { corners: source, normal: cross.normalize(), area: 0.5 * cross.length() };
        for splits in 0..3 {
            let rule = CompositeRule::on_parts(splits);
            let mut results = vec![[f32::NAN; 8]; rule.octets.len()];
            irradiance_on(&shining, receiver, normal, tau, &rule.octets, &mut results);
            for (octet, result) in rule.octets.iter().zip(&results) {
                for l in 0..8 {
                    let point = receiver[0] * octet[0][l] + receiver[1] * octet[1][l] + receiver[2] * octet[2][l];
                    let k = triangle_vector(shining.corners, shining.normal, shining.area, point, Some(normal), tau);
                    let want = normal.dot(k).max(0.0);
                    // Rules may differ within an octet; where both are contours only rounding does.
                    let tolerance = 2.0e-6 + 2.0e-3 * want;
                    prop_assert!((result[l] - want).abs() < tolerance, "{} for {want}", result[l]);
                }
            }
        }
    }
}
