//! Cells of air and solid between the planes of a rectilinear grid.

use glam::DVec3;

/// What fills a cell. The tag tells rooms, or parts of a piece, apart when it is painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// Lit space.
    Air(u16),
    /// Opaque matter.
    Solid(u16),
}

/// A cell of the border, as the painter sees it.
#[derive(Clone, Copy, Debug)]
pub struct BorderFace {
    /// Tag of the air in front.
    pub air: u16,
    /// Tag of the solid behind.
    pub solid: u16,
    /// Unit normal, towards the air, along an axis.
    pub normal: DVec3,
    /// Centre of the cell in metres.
    pub centre: DVec3,
}

impl BorderFace {
    /// True for floors, seats and table tops.
    pub fn faces_up(&self) -> bool {
        self.normal.z > 0.5
    }

    /// True for ceilings and undersides.
    pub fn faces_down(&self) -> bool {
        self.normal.z < -0.5
    }
}

/// Cuts closer than this (in metres) are one cut: a tenth of the finest detail that is written.
pub const SAME_CUT: f64 = 1e-7;

/// The filled cells; outside lies what everything was at the start.
pub struct CellGrid {
    start: Cell,
    size: [isize; 3],
    cells: Vec<Cell>,
}

impl CellGrid {
    /// Applies `fills` in turn to cells between `lines` that hold `start` at first.
    pub fn new(start: Cell, fills: &[(DVec3, DVec3, Cell)], lines: &[Vec<f64>; 3]) -> Self {
        let size = lines.each_ref().map(|l| l.len() as isize - 1);
        let volume = size.iter().product::<isize>().max(0) as usize;
        let mut grid = Self {
            start,
            size,
            cells: vec![start; volume],
        };
        for &(min, max, cell) in fills {
            let range: [_; 3] = std::array::from_fn(|a| {
                let index = |at: f64| lines[a].partition_point(|&l| l < at - SAME_CUT) as isize;
                index(min[a])..index(max[a])
            });
            for k in range[2].clone() {
                for j in range[1].clone() {
                    for i in range[0].clone() {
                        let index = grid.index([i, j, k]);
                        grid.cells[index] = cell;
                    }
                }
            }
        }
        grid
    }

    fn index(&self, [i, j, k]: [isize; 3]) -> usize {
        ((k * self.size[1] + j) * self.size[0] + i) as usize
    }

    /// What fills a cell; indices may lie outside.
    pub fn at(&self, at: [isize; 3]) -> Cell {
        if (0..3).all(|a| (0..self.size[a]).contains(&at[a])) {
            self.cells[self.index(at)]
        } else {
            self.start
        }
    }
}
