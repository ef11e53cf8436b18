//! Tables for a terminal.

use std::fmt::Write;

/// Columns that a table keeps to: those of a terminal that nobody made wider.
const COLUMNS: usize = 80;
/// As the words above a table: with it four rotors have room, with errors of two digits.
const INDENT: usize = 2;
/// Columns between a cell and the next one.
const APART: usize = 2;

/// A table, heads first, in lines that a terminal does not break: columns for which there is no room follow below, behind the first one. A
/// head in brackets stands on a line of its own where it makes its column wide.
pub(super) fn columns(page: &mut String, table: &[Vec<String>]) {
    let table = with_two_heads(table);
    let Some(first) = table.first() else { return };
    let wide = |column: usize| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let begin = INDENT + wide(0);
    let mut from = 1;
    while from < first.len() {
        let mut taken = begin;
        let fits = |column: &usize| {
            taken += APART + wide(*column);
            taken <= COLUMNS || *column == from
        };
        let to = from + (from..first.len()).take_while(fits).count();
        let shown: Vec<usize> = std::iter::once(0).chain(from..to).collect();
        for row in &table {
            let cell = |&column: &usize| format!("{:<1$}", row[column], wide(column) + APART);
            let cells: String = shown.iter().map(cell).collect();
            // heads without brackets have nothing below them
            if !cells.trim().is_empty() {
                // writing to a String cannot fail
                let _ = writeln!(page, "{:INDENT$}{}", "", cells.trim_end());
            }
        }
        from = to;
        if from < first.len() {
            page.push('\n');
        }
    }
}

/// The same table with what heads have in brackets below them, where a head is wider than the cells of its column.
fn with_two_heads(table: &[Vec<String>]) -> Vec<Vec<String>> {
    let Some((heads, rows)) = table.split_first() else { return Vec::new() };
    let split = |(column, head): (usize, &String)| {
        let widest = rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
        match head.split_once(" (").filter(|_| column > 0 && head.chars().count() > widest) {
            Some((name, rest)) => (name.to_owned(), format!("({rest}")),
            None => (head.clone(), String::new()),
        }
    };
    let (upper, lower): (Vec<String>, Vec<String>) = heads.iter().enumerate().map(split).unzip();
    let lower = lower.iter().any(|head| !head.is_empty()).then_some(lower);
    std::iter::once(upper).chain(lower).chain(rows.iter().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(cells: &[&str]) -> Vec<String> {
        cells.iter().map(|cell| (*cell).to_owned()).collect()
    }

    #[test]
    fn a_table_that_is_too_wide_goes_on_below() {
        let heads: Vec<String> = std::iter::once("flight".to_owned())
            .chain((1..=8).map(|rotor| format!("motor {rotor} (front right)")))
            .collect();
        let values = |flight: usize| {
            let value = |rotor: usize| format!("1.00{rotor} +- 0.001");
            std::iter::once(flight.to_string()).chain((1..=8).map(value)).collect()
        };
        let table: Vec<Vec<String>> = std::iter::once(heads).chain((1..=16).map(values)).collect();
        let mut page = String::new();
        columns(&mut page, &table);
        assert!(page.lines().all(|line| line.chars().count() <= COLUMNS), "{page}");
        // each value once, and each flight in each part
        for rotor in 1..=8 {
            assert_eq!(page.matches(&format!("1.00{rotor} +- 0.001")).count(), 16, "{page}");
        }
        assert_eq!(page.lines().filter(|line| line.trim().starts_with("16 ")).count(), 2, "{page}");
        assert_eq!(page.lines().nth(1).map(|line| line.matches("(front right)").count()), Some(4), "{page}");
    }

    #[test]
    fn columns_are_as_wide_as_their_cells() {
        let mut page = String::new();
        columns(&mut page, &[row(&["", "flight 1"]), row(&["ixx (kg m^2)", "2.0 +- 0.1"])]);
        assert_eq!(page, "                flight 1\n  ixx (kg m^2)  2.0 +- 0.1\n");
        page.clear();
        // four rotors fit a terminal
        let heads = ["flight", "motor 1 (front right)", "motor 2 (rear left)", "motor 3", "motor 4"];
        let value = "1.0011 +- 0.0017";
        columns(&mut page, &[row(&heads), row(&["16", value, value, value, value])]);
        assert_eq!(page.lines().count(), 3, "{page}");
        page.clear();
        // a cell that is wider than a line
        columns(&mut page, &[row(&["flight", &"x".repeat(90), "V"])]);
        assert_eq!(page.lines().count(), 3, "{page}");
    }
}
