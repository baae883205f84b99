//! Sums from which means, spreads and extremes follow, and which shards add up.

use crate::failure::Failure;
use crate::problem::{Problem, abridged};

/// What is kept of many values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    /// How many.
    pub count: u64,
    /// Their sum.
    pub sum: f64,
    /// The sum of their squares.
    pub squares: f64,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
    /// How many are above 1, for ratios.
    pub above_one: u64,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            count: 0,
            sum: 0.0,
            squares: 0.0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            above_one: 0,
        }
    }
}

impl FromIterator<f64> for Tally {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut tally = Self::default();
        for value in values {
            tally.count += 1;
            tally.sum += value;
            tally.squares += value * value;
            tally.least = tally.least.min(value);
            tally.greatest = tally.greatest.max(value);
            tally.above_one += u64::from(value > 1.0);
        }
        tally
    }
}

impl Tally {
    /// Both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            squares: self.squares + other.squares,
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            above_one: self.above_one + other.above_one,
        }
    }

    /// The mean; 0 of nothing.
    #[must_use]
    pub fn mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.sum / self.count as f64 }
    }

    /// The standard deviation of the values; 0 of fewer than two.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        if self.count < 2 {
            return 0.0;
        }
        let (n, mean) = (self.count as f64, self.mean());
        ((self.squares / n - mean * mean).max(0.0) * n / (n - 1.0)).sqrt()
    }
}

/// A line of a study's table: a tally at a place of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The curve.
    pub series: String,
    /// The place on it.
    pub x: f64,
    /// The values there.
    pub tally: Tally,
}

const HEADER: [&str; 11] = [
    "study",
    "series",
    "x",
    "count",
    "sum",
    "sum_of_squares",
    "least",
    "greatest",
    "above_one",
    "mean",
    "deviation",
];

/// The table of a study as CSV; the last two columns follow from the others.
#[must_use]
pub fn to_csv(study: &str, rows: &[Row]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing into memory does not fail.
    let _ = writer.write_record(HEADER);
    for Row { series, x, tally } in rows.iter().filter(|row| row.tally.count > 0) {
        let numbers =
            [tally.sum, tally.squares, tally.least, tally.greatest].map(|number| number.to_string());
        let [sum, squares, least, greatest] = numbers;
        let _ = writer.write_record([
            study.to_owned(),
            series.clone(),
            x.to_string(),
            tally.count.to_string(),
            sum,
            squares,
            least,
            greatest,
            tally.above_one.to_string(),
            format!("{:.6}", tally.mean()),
            format!("{:.6}", tally.deviation()),
        ]);
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

/// Reads tables of shards and adds them up; returns the study's name and its rows in the order of the first table.
///
/// # Errors
///
/// [`Failure::Input`] for what is no such table, or of another study than the first.
pub fn merged(files: &[(String, String)]) -> Result<(String, Vec<Row>), Failure> {
    let mut study: Option<String> = None;
    let mut rows: Vec<Row> = Vec::new();
    let mut problems = Vec::new();
    for (file, text) in files {
        let mut wrong = |line: Option<usize>, message: String| {
            problems.push(Problem { file: file.clone(), line, key: String::new(), message });
        };
        let mut table = csv::Reader::from_reader(text.as_bytes());
        if !table.headers().is_ok_and(|header| header.iter().eq(HEADER)) {
            wrong(Some(1), format!("is no table of a study: its first line must be {}", HEADER.join(",")));
            continue;
        }
        for (index, record) in table.records().enumerate() {
            let read = record.ok().and_then(|record| read_row(&record));
            match read {
                Some((name, row)) if study.get_or_insert_with(|| name.clone()) == &name => {
                    add(&mut rows, row)
                }
                Some((name, _)) => {
                    wrong(Some(index + 2), format!("is of another study, {}", abridged(&name)))
                }
                None => wrong(Some(index + 2), "is no row of a study".to_owned()),
            }
        }
    }
    match study {
        Some(study) if problems.is_empty() => Ok((study, rows)),
        None if problems.is_empty() => Err(Failure::Refused("the tables are empty".to_owned())),
        _ => Err(Failure::Input(problems)),
    }
}

fn read_row(record: &csv::StringRecord) -> Option<(String, Row)> {
    let number = |index: usize| record.get(index)?.parse::<f64>().ok().filter(|number| number.is_finite());
    let count = |index: usize| record.get(index)?.parse::<u64>().ok();
    let tally = Tally {
        count: count(3)?,
        sum: number(4)?,
        squares: number(5)?,
        least: number(6)?,
        greatest: number(7)?,
        above_one: count(8)?,
    };
    Some((record.get(0)?.to_owned(), Row { series: record.get(1)?.to_owned(), x: number(2)?, tally }))
}

fn add(rows: &mut Vec<Row>, row: Row) {
    match rows.iter_mut().find(|known| known.series == row.series && known.x == row.x) {
        Some(known) => known.tally = known.tally.and(row.tally),
        None => rows.push(row),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn row(values: &[f64]) -> Vec<Row> {
        vec![Row { series: "m = 2".into(), x: 20.0, tally: values.iter().copied().collect() }]
    }

    proptest! {
        #[test]
        fn shards_add_up(values in proptest::collection::vec(0.5..2.0f64, 2..40), cut in 1usize..39) {
            let (a, b) = values.split_at(cut.min(values.len() - 1));
            let files = [a, b].map(|part| (String::new(), to_csv("cost", &row(part))));
            let (study, merged) = merged(&files).map_err(|failure| TestCaseError::fail(failure.to_string()))?;
            let whole = row(&values)[0].tally;
            prop_assert_eq!(study, "cost");
            let tally = merged[0].tally;
            prop_assert_eq!((tally.count, tally.least, tally.greatest, tally.above_one), (whole.count, whole.least, whole.greatest, whole.above_one));
            prop_assert!((tally.mean() - whole.mean()).abs() < 1e-12 && (tally.deviation() - whole.deviation()).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_no_table_is_said() {
        let table = |study: &str| ("a.csv".to_owned(), to_csv(study, &row(&[1.0])));
        assert!(
            merged(&[table("cost"), table("procedures")])
                .is_err_and(|failure| failure.to_string().contains("another study"))
        );
        let broken = ("b.csv".to_owned(), "x,y\n1,2\n".to_owned());
        assert!(
            merged(&[table("cost"), broken])
                .is_err_and(|failure| failure.to_string().contains("b.csv:1: is no table"))
        );
        let cut = ("c.csv".to_owned(), to_csv("cost", &row(&[1.0])).replace("0.0", "x").replace(",1,", ",,"));
        assert!(merged(&[cut]).is_err());
    }
}
