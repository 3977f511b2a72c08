//! Bookcases: sides, boards, a back, and rows of books.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::BOOKS;

/// Thickness of sides, boards and back in metres.
const BOARD: f64 = 0.03;
/// Tag of the wood; books follow.
const WOOD: u16 = 0;

/// Measures of a bookcase in metres.
#[derive(Clone, Copy, Debug)]
pub struct ShelfSize {
    /// Outer width.
    pub width: f64,
    /// Outer height.
    pub height: f64,
    /// Outer depth.
    pub depth: f64,
    /// Compartments one above the other.
    pub compartments: usize,
    /// Groups of books side by side in a compartment; 0 for an empty shelf.
    pub books: usize,
}

/// A bookcase. Groups of books leave a gap now and then, as `dice` will have it.
pub fn shelf(size: ShelfSize, cell: f64, wood: Material, dice: &mut Dice) -> Mesh {
    let (x, y) = (size.width / 2.0, size.depth / 2.0);
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -y, 0.0], [-x + BOARD, y, size.height], WOOD);
    blocks.add([x - BOARD, -y, 0.0], [x, y, size.height], WOOD);
    blocks.add([-x, y - BOARD, 0.0], [x, y, size.height], WOOD);
    let pitch = (size.height - BOARD) / size.compartments as f64;
    for board in 0..=size.compartments {
        let z = pitch * board as f64;
        blocks.add([-x, -y, z], [x, y, z + BOARD], WOOD);
    }
    let inside = size.width - 2.0 * BOARD;
    for compartment in 0..size.compartments {
        let floor = pitch * compartment as f64 + BOARD;
        // Two heights of books a compartment keep the number of cuts low.
        let clear = pitch - BOARD;
        for book in 0..size.books {
            let share = [0.0, 0.66, 0.82, 0.82][dice.pick(4)];
            let left = -x + BOARD + inside * book as f64 / size.books as f64;
            let right = -x + BOARD + inside * (book + 1) as f64 / size.books as f64;
            if share > 0.0 {
                let tag = 1 + dice.pick(BOOKS.len()) as u16;
                blocks.add(
                    [left, -y + BOARD, floor],
                    [right, y - BOARD, floor + clear * share],
                    tag,
                );
            }
        }
    }
    blocks.mesh(|face| match face.solid {
        WOOD => wood,
        book => BOOKS[usize::from(book) - 1],
    })
}
