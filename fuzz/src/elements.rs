//! Elements, triangles and occluders drawn from bytes.

use crate::bytes::Bytes;
use certilux::math::Aabb;
use certilux::occluder::SlabRectangle;
use certilux::visibility::ElementBounds;
use glam::{Quat, Vec3};

/// A triangle, perhaps a sliver or a point.
pub fn triangle(bytes: &mut Bytes) -> [Vec3; 3] {
    let a = bytes.point();
    if bytes.below(4) == 0 {
        return [a, bytes.point(), bytes.point()];
    }
    // Two sides along axes, as walls and floors have them.
    let axis = bytes.below(3);
    let (mut b, mut c) = (a, a);
    b[axis] = bytes.coordinate();
    c[(axis + 1) % 3] = bytes.coordinate();
    [a, b, c]
}

/// A box, a triangle or an oriented slab.
pub fn element(bytes: &mut Bytes) -> ElementBounds {
    match bytes.below(4) {
        0 => {
            let (p, q) = (bytes.point(), bytes.point());
            ElementBounds::from_box(Aabb::from_points([p, q]))
        }
        1 | 2 => ElementBounds::from_polygon(&triangle(bytes)),
        _ => {
            let [p, q, r] = triangle(bytes);
            let normal = (q - p).cross(r - p).normalize_or(Vec3::Z);
            let thickness = normal * f32::from(bytes.byte()) * 1.0e-7;
            ElementBounds::from_slab([p, q, q + (r - p), r], thickness)
        }
    }
}

/// A rectangle with a thickness, along axes or turned.
pub fn slab(bytes: &mut Bytes) -> SlabRectangle {
    let axis = bytes.below(3);
    let turn = if bytes.below(2) == 0 {
        Quat::IDENTITY
    } else {
        let p = bytes.point();
        Quat::from_xyzw(p.x, p.y, p.z, 0.3).normalize()
    };
    let half = |bytes: &mut Bytes| (bytes.coordinate().abs() * 0.9).max(1.0e-3);
    let (u, v) = (
        turn * Vec3::AXES[axis] * half(bytes),
        turn * Vec3::AXES[(axis + 1) % 3] * half(bytes),
    );
    let thickness = [1.0e-7, 1.0e-6, 3.0e-6, 1.0e-3][bytes.below(4)];
    SlabRectangle::new(
        bytes.point(),
        u,
        v,
        turn * Vec3::AXES[(axis + 2) % 3],
        thickness,
    )
}
