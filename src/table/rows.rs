//! A row as a struct, and how it is declared.

use super::cell::Cell;
use super::column::Column;

/// A row of a table.
pub trait Row: Sized {
    /// name of the table
    const TABLE: &'static str;
    /// what one row is, in a sentence
    const WORDS: &'static str;

    /// The columns, in order.
    fn columns() -> Vec<Column>;

    /// One a column.
    fn cells(&self) -> Vec<Cell>;

    /// From one cell a column.
    ///
    /// # Errors
    /// [`TableError::Cell`] where a column holds another kind.
    fn of_cells(cells: Vec<Cell>) -> Result<Self, TableError>;
}

/// Why a table cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// a column holds what it should not
    #[error("table {table}: expected a {expected} in column {column}, got something else or nothing")]
    Cell {
        /// which table
        table: &'static str,
        /// which column
        column: &'static str,
        /// what it should hold
        expected: &'static str,
    },
    /// a line is no JSON object
    #[error("table {table}, line {line}: expected a JSON object, got {why}")]
    Line {
        /// which table
        table: &'static str,
        /// from 1
        line: usize,
        /// why
        why: String,
    },
    /// the file is of another form, or damaged
    #[error("table {table}: {why}")]
    File {
        /// which table
        table: &'static str,
        /// why
        why: String,
    },
}

/// Declares the rows of a table: a struct with one public field a column, its unit, and the sentence that documents both.
#[macro_export]
macro_rules! table_rows {
    (
        $(#[$of_struct:meta])*
        $name:ident, $table:literal, $what:literal {
            $( $field:ident: $kind:ty, $unit:literal, $words:literal; )+
        }
    ) => {
        $(#[$of_struct])*
        #[doc = concat!("A row of the table `", $table, "`: ", $what, ".")]
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $( #[doc = $words] #[doc = concat!("(", $unit, ")")] pub $field: $kind, )+
        }

        impl $crate::table::Row for $name {
            const TABLE: &'static str = $table;
            const WORDS: &'static str = $what;

            fn columns() -> Vec<$crate::table::Column> {
                vec![$( $crate::table::Column {
                    name: stringify!($field),
                    kind: <$kind as $crate::table::Field>::KIND,
                    may_be_empty: <$kind as $crate::table::Field>::MAY_BE_EMPTY,
                    unit: $unit,
                    words: $words,
                }, )+]
            }

            fn cells(&self) -> Vec<$crate::table::Cell> {
                vec![$( $crate::table::Field::cell(&self.$field), )+]
            }

            fn of_cells(cells: Vec<$crate::table::Cell>) -> Result<Self, $crate::table::TableError> {
                let mut cells = cells.into_iter();
                Ok(Self {
                    $( $field: cells
                        .next()
                        .and_then(<$kind as $crate::table::Field>::of)
                        .ok_or($crate::table::TableError::Cell {
                            table: $table,
                            column: stringify!($field),
                            expected: <$kind as $crate::table::Field>::KIND.name(),
                        })?, )+
                })
            }
        }
    };
}
