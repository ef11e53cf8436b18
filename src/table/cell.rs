//! What stands in one row of one column.

use super::column::Kind;

/// What stands in one row of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// nothing
    Empty,
    /// words
    Text(String),
    /// a number; one that is not finite is stored as nothing
    Number(f64),
    /// a whole number
    Whole(i64),
    /// yes or no
    Truth(bool),
    /// several numbers
    Numbers(Vec<f64>),
}

/// A type that a column can have.
pub trait Field: Sized {
    /// what the column holds
    const KIND: Kind;
    /// a row may have none
    const MAY_BE_EMPTY: bool = false;

    /// For a table.
    fn cell(&self) -> Cell;

    /// From a table; `None` where another kind stands there.
    fn of(cell: Cell) -> Option<Self>;
}

impl Field for String {
    const KIND: Kind = Kind::Text;

    fn cell(&self) -> Cell {
        Cell::Text(self.clone())
    }

    fn of(cell: Cell) -> Option<Self> {
        if let Cell::Text(text) = cell { Some(text) } else { None }
    }
}

impl Field for f64 {
    const KIND: Kind = Kind::Number;

    fn cell(&self) -> Cell {
        Cell::Number(*self)
    }

    fn of(cell: Cell) -> Option<Self> {
        match cell {
            Cell::Number(number) => Some(number),
            Cell::Whole(whole) => Some(whole as f64),
            _ => None,
        }
    }
}

impl Field for i64 {
    const KIND: Kind = Kind::Whole;

    fn cell(&self) -> Cell {
        Cell::Whole(*self)
    }

    fn of(cell: Cell) -> Option<Self> {
        if let Cell::Whole(whole) = cell { Some(whole) } else { None }
    }
}

impl Field for bool {
    const KIND: Kind = Kind::Truth;

    fn cell(&self) -> Cell {
        Cell::Truth(*self)
    }

    fn of(cell: Cell) -> Option<Self> {
        if let Cell::Truth(truth) = cell { Some(truth) } else { None }
    }
}

impl Field for Vec<f64> {
    const KIND: Kind = Kind::Numbers;

    fn cell(&self) -> Cell {
        Cell::Numbers(self.clone())
    }

    fn of(cell: Cell) -> Option<Self> {
        if let Cell::Numbers(numbers) = cell { Some(numbers) } else { None }
    }
}

impl<T: Field> Field for Option<T> {
    const KIND: Kind = T::KIND;
    const MAY_BE_EMPTY: bool = true;

    fn cell(&self) -> Cell {
        self.as_ref().map_or(Cell::Empty, Field::cell)
    }

    fn of(cell: Cell) -> Option<Self> {
        if cell == Cell::Empty { Some(None) } else { T::of(cell).map(Some) }
    }
}
