//! The tables as a document.

use super::rows::SCHEMA;
use crate::each_table;
use crate::table::{Column, Row};
use serde::Serialize;

/// One table with its columns.
#[derive(Debug, Clone, Serialize)]
pub struct TableSchema {
    /// name, which is that of its folder
    pub name: &'static str,
    /// what one row is
    pub row: &'static str,
    /// the columns, in order
    pub columns: Vec<Column>,
}

/// All tables.
#[derive(Debug, Clone, Serialize)]
pub struct Schema {
    /// version
    pub schema: i64,
    /// the tables
    pub tables: Vec<TableSchema>,
}

impl Schema {
    /// The tables that this program writes.
    #[must_use]
    pub fn current() -> Self {
        let mut tables = Vec::new();
        macro_rules! each {
            ($field:ident, $row:ty) => {
                tables.push(TableSchema {
                    name: <$row>::TABLE,
                    row: <$row>::WORDS,
                    columns: <$row>::columns(),
                });
            };
        }
        each_table!(each);
        Self { schema: SCHEMA, tables }
    }

    /// As tables of a Markdown document.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut out = String::new();
        for table in &self.tables {
            out.push_str(&format!("### {}\n\nOne row: {}.\n\n", table.name, table.row));
            out.push_str("| column | kind | unit | meaning |\n|---|---|---|---|\n");
            for column in &table.columns {
                let empty = if column.may_be_empty { ", may be empty" } else { "" };
                let (kind, unit) = (column.kind.name(), column.unit);
                out.push_str(&format!("| `{}` | {kind}{empty} | {unit} | {} |\n", column.name, column.words));
            }
            out.push('\n');
        }
        out.trim_end().to_owned() + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_names_its_log_and_no_column_twice() {
        for table in Schema::current().tables {
            assert_eq!(table.columns[0].name, "log", "{}", table.name);
            let mut names: Vec<&str> = table.columns.iter().map(|column| column.name).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), table.columns.len(), "{}", table.name);
            assert!(table.columns.iter().all(|column| !column.words.is_empty()), "{}", table.name);
        }
    }
}
