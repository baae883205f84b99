//! A table of text: columns as wide as their widest cell.

/// A table being filled.
#[derive(Debug, Clone, Default)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// With a heading for every column.
    #[must_use]
    pub fn new(headings: &[&str]) -> Self {
        Self { rows: vec![headings.iter().map(|&heading| heading.to_owned()).collect()] }
    }

    /// Adds a row; cells beyond the headings have a column without one.
    pub fn push(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// The headings and then the rows.
    #[must_use]
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The text: cells right-aligned, the first two columns left-aligned, a line below the headings.
    #[must_use]
    pub fn render(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for (index, row) in self.rows.iter().enumerate() {
            text.push_str(&line(row, &widths));
            if index == 0 {
                text.push_str(&"-".repeat(widths.iter().sum::<usize>() + 2 * columns.saturating_sub(1)));
                text.push('\n');
            }
        }
        text
    }
}

fn line(row: &[String], widths: &[usize]) -> String {
    let cell = |(column, width): (usize, &usize)| {
        let cell = row.get(column).map_or("", String::as_str);
        let space = " ".repeat(width - cell.chars().count());
        if column < 2 { format!("{cell}{space}") } else { format!("{space}{cell}") }
    };
    let cells: Vec<String> = widths.iter().enumerate().map(cell).collect();
    format!("{}\n", cells.join("  ").trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new(&["vehicle", "targets", "length"]);
        table.push(vec!["1".into(), "3 7".into(), "12.0 m".into()]);
        table.push(vec!["2".into(), "none".into(), "0.0 m".into()]);
        let wanted = "vehicle  targets  length\n------------------------\n1        3 7      12.0 m\n2        none      0.0 m\n";
        assert_eq!(table.render(), wanted);
    }
}
