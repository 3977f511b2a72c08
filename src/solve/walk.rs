//! The walk of one task over pairs (source, receiver), from the root down, without storing links (Stamminger et al.
//! 1998): what is split, what is proved, what is exchanged (paper, section 5.3).

use super::element::Shape;
use super::exchange::Next;
use super::oracle::Decision;
use super::pair::{Known, Receiver, Source};
use super::prover::Prover;
use super::push_pull::local_children;
use super::query_schedule::QuerySchedule;
use super::task::{PassOutcome, Task};
use crate::cluster::Hierarchy;

/// Visits between two questions to the observer: a few hundred microseconds.
const VISITS_BETWEEN_QUESTIONS: u32 = 4096;

/// What came of a task.
pub(super) struct TaskOutcome {
    pub(super) owner: usize,
    pub(super) outcome: PassOutcome,
    /// What it learned of queries.
    pub(super) schedule: Option<QuerySchedule>,
}

impl<const C: usize> Task<'_, '_, C> {
    /// Runs the task of owner number `owner`.
    pub(super) fn run(mut self, owner: usize) -> TaskOutcome {
        let source = self.source_of_node(Hierarchy::ROOT);
        let receiver = Receiver {
            element: &self.pass.context.elements[self.gatherer.root.index()],
            local: 0,
        };
        let greatest = self.greatest(&source);
        self.walk(&source, &receiver, greatest, &Known::NOTHING);
        let mut schedule = self.prover.map(Prover::into_schedule);
        if let (Some(schedule), Some(cache)) = (&mut schedule, &self.shadow_cache) {
            schedule.book_screened(cache.account());
        }
        TaskOutcome {
            owner,
            outcome: self.outcome,
            schedule,
        }
    }

    /// Decides a pair whose source has the unshot radiosity `greatest`, of its greatest channel.
    fn walk(&mut self, source: &Source, receiver: &Receiver, greatest: f64, known: &Known) {
        if greatest <= 0.0 || self.is_interrupted() {
            return;
        }
        let decision =
            self.pass
                .oracle
                .decide(source.element, receiver.element, greatest, source.weight);
        match decision {
            Decision::Nothing => {}
            Decision::Play(chance) => {
                if self.pass.wins(source.element, receiver.element, chance) {
                    let mut source = *source;
                    source.weight /= chance;
                    self.walk(&source, receiver, greatest / chance, known);
                }
            }
            Decision::Exchange(carried) => {
                // Shadows and gradients are looked for as if the pair had not been played for: its light is a sample.
                let weight = source.weight;
                match self.exchange(source, receiver, greatest / weight, carried / weight, known) {
                    Next::Done => {}
                    Next::SplitSource => {
                        self.split(source, receiver, greatest, carried, known, true)
                    }
                    Next::SplitReceiver => {
                        self.split(source, receiver, greatest, carried, known, false);
                    }
                    Next::SplitShadow(mut known) => {
                        known.descend();
                        self.split_receiver(source, receiver, greatest, &known);
                    }
                }
            }
            Decision::SplitSource(power) => {
                self.split(source, receiver, greatest, power, known, true);
            }
            Decision::SplitReceiver(power) => {
                self.split(source, receiver, greatest, power, known, false);
            }
        }
    }

    /// Asks for a guarantee where it is due about a pair that carries `power`, and goes on with the children of one end.
    fn split(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        greatest: f64,
        power: f64,
        known: &Known,
        by_source: bool,
    ) {
        let mut known = *known;
        let vain = self.prove_before_split(source, receiver, power, &mut known);
        if known.ends_the_pair(self.pass.config) {
            return;
        }
        let before = self.rays_tested();
        known.descend();
        if by_source {
            self.split_source(source, receiver, &known);
        } else {
            self.split_receiver(source, receiver, greatest, &known);
        }
        if let Some(expected) = vain {
            self.book_below(expected, before);
        }
    }

    fn is_interrupted(&mut self) -> bool {
        self.visits = self.visits.wrapping_add(1);
        if self.visits.is_multiple_of(VISITS_BETWEEN_QUESTIONS) {
            self.outcome.interrupted |= self.pass.context.observer.interrupted();
        }
        self.outcome.interrupted
    }

    fn split_source(&mut self, source: &Source, receiver: &Receiver, known: &Known) {
        if let Shape::Triangle(corners) = source.element.shape {
            let first =
                self.pass.shooters[source.owner as usize].splits[source.slot as usize].first;
            for which in 0..4 {
                let element = source.element.triangle_child(corners, which);
                let child = Source {
                    element: &element,
                    owner: source.owner,
                    // Below a frozen leaf the source is split virtually: the leaf's radiosity serves.
                    slot: if first == 0 {
                        source.slot
                    } else {
                        first + which
                    },
                    weight: source.weight,
                };
                let greatest = self.greatest(&child);
                self.walk(&child, receiver, greatest, known);
            }
        } else if let Some(children) = self.pass.context.hierarchy.children(source.element.node) {
            for child in children {
                let child = Source {
                    weight: source.weight,
                    ..self.source_of_node(child)
                };
                let greatest = self.greatest(&child);
                self.walk(&child, receiver, greatest, known);
            }
        }
    }

    fn split_receiver(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        greatest: f64,
        known: &Known,
    ) {
        let context = self.pass.context;
        if let Shape::Triangle(corners) = receiver.element.shape {
            for which in 0..4 {
                let element = receiver.element.triangle_child(corners, which);
                let child = Receiver {
                    element: &element,
                    local: 0,
                };
                self.walk(source, &child, greatest, known);
            }
        } else if let Some(children) = context.hierarchy.children(receiver.element.node) {
            let locals = local_children(context.hierarchy, children[0], receiver.local as usize);
            for (child, local) in children.into_iter().zip(locals) {
                let child = Receiver {
                    element: &context.elements[child.index()],
                    local: local as u32,
                };
                self.walk(source, &child, greatest, known);
            }
        }
    }
}
