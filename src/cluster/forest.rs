//! Binary trees in the making: leaves first, then joins in the order in which they were made.

/// A forest. Nodes below `leaf_count` are leaves (facets); node `leaf_count + k` is join `k`, and
/// its children have smaller numbers.
#[derive(Clone, Debug)]
pub(super) struct Forest {
    leaf_count: u32,
    children: Vec<[u32; 2]>,
    /// Step of flatness of each join made by face clustering (0 is coplanar).
    flatness: Vec<u8>,
}

impl Forest {
    /// Leaves only.
    pub fn new(leaf_count: usize) -> Self {
        Self {
            leaf_count: leaf_count as u32,
            children: Vec::with_capacity(leaf_count.saturating_sub(1)),
            flatness: Vec::with_capacity(leaf_count.saturating_sub(1)),
        }
    }

    /// Adds a parent above two roots and returns it.
    pub fn join(&mut self, children: [u32; 2], flatness: u8) -> u32 {
        let node = self.len() as u32;
        debug_assert!(children.iter().all(|&c| c < node));
        self.children.push(children);
        self.flatness.push(flatness);
        node
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.leaf_count as usize + self.children.len()
    }

    /// Number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaf_count as usize
    }

    /// Step of flatness of a join.
    pub fn flatness(&self, join: u32) -> u8 {
        self.flatness[(join - self.leaf_count) as usize]
    }

    /// The children of a join.
    pub fn join_children(&self, join: u32) -> [u32; 2] {
        self.children[(join - self.leaf_count) as usize]
    }

    /// The children of a node, `None` for a leaf.
    pub fn children(&self, node: u32) -> Option<[u32; 2]> {
        node.checked_sub(self.leaf_count)
            .map(|join| self.children[join as usize])
    }

    /// Nodes without a parent, ascending.
    pub fn roots(&self) -> Vec<u32> {
        let mut has_parent = vec![false; self.len()];
        for child in self.children.iter().flatten() {
            has_parent[*child as usize] = true;
        }
        (0..self.len() as u32)
            .filter(|&node| !has_parent[node as usize])
            .collect()
    }

    /// For each node, a value folded from its leaves upwards.
    pub fn fold<T: Copy>(&self, leaf: impl Fn(u32) -> T, join: impl Fn(T, T) -> T) -> Vec<T> {
        let mut values: Vec<T> = (0..self.leaf_count).map(leaf).collect();
        values.reserve_exact(self.children.len());
        for &[a, b] in &self.children {
            values.push(join(values[a as usize], values[b as usize]));
        }
        values
    }
}
