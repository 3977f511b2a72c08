//! What an exchange leaves on its receiver: what would arrive unoccluded, times what is seen of the source, part by part.

use super::arrival::Arrival;
use super::pair::Receiver;
use super::push_pull::split_values;
use super::task::Task;
use crate::visibility::PartVisibility;

impl<const C: usize> Task<'_, '_, C> {
    /// Adds the light of a source whose radiosity, with its weight, is `light`.
    pub(super) fn deposit(
        &mut self,
        receiver: &Receiver,
        unoccluded: &Arrival,
        visibility: &PartVisibility,
        light: [f64; C],
    ) {
        let whole = light.map(|b| b * f64::from(visibility.whole));
        match unoccluded {
            Arrival::Linear(irradiance) => {
                let element = receiver.element;
                let at = self.gatherer.patch(element.facet(), element.path);
                // A patch that no light has yet split takes its shadow as a whole: what many weak exchanges leave on
                // it is not worth patches of their own (`bench/runs/`, accuracy).
                match self.gatherer.children[at] as usize {
                    first if first != 0 && !visibility.is_even() => {
                        let corners = irradiance.map(|e| light.map(|b| b * f64::from(e)));
                        for (which, &share) in visibility.parts[..4].iter().enumerate() {
                            let part = split_values(&corners, which);
                            let share = [f64::from(share); C];
                            add_corners(&mut self.gatherer.gathered[first + which], part, share);
                        }
                    }
                    _ => {
                        let corners = irradiance.map(|e| [f64::from(e); C]);
                        add_corners(&mut self.gatherer.gathered[at], corners, whole);
                    }
                }
            }
            Arrival::Vectors(nodes) => {
                for ((local, arrived), &share) in nodes.lights().zip(&visibility.parts) {
                    let clusters = &mut self.gatherer.clusters[local];
                    for (sum, b) in clusters.iter_mut().zip(light) {
                        sum.add(&arrived, f64::from(share) * b);
                    }
                }
            }
        }
    }
}

/// Adds values at the three corners of a patch, each channel times its factor.
#[inline(always)]
fn add_corners<const C: usize>(sums: &mut [[f64; C]; 3], values: [[f64; C]; 3], factor: [f64; C]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        for c in 0..C {
            sum[c] += value[c] * factor[c];
        }
    }
}
