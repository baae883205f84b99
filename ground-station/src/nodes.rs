//! Nodes for the solvers alone: files of TSPLIB (Reinelt 1991) and tables of points.

use crate::geodesy::Origin;
use crate::problem::Problem;
use planner::christofides::tsplib::{Distances, Instance};

/// Points or a matrix, with or without TSPLIB's rounding of distances to whole numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Nodes {
    instance: Instance,
    is_rounded: bool,
}

impl Nodes {
    /// Reads a TSPLIB file, recognised by its sections, a table of targets with columns `lat`
    /// and `lon` or `east` and `north`, or lines that end in two coordinates, separated by commas or spaces.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub fn read(file: &str, text: &str, is_rounded: bool) -> Result<Self, Problem> {
        let wrong =
            |message: String| Problem { file: file.to_owned(), line: None, key: String::new(), message };
        let is_tsplib = Instance::is_one(text);
        let instance = if is_tsplib {
            Instance::read(text).map_err(|error| wrong(error.to_string()))?
        } else {
            let points = read_columns(text).unwrap_or_else(|| read_points(text));
            if points.iter().flatten().any(|number| !number.is_finite()) {
                return Err(wrong("holds a number that is not finite".to_owned()));
            }
            Instance::planar(points)
        };
        if instance.is_empty() {
            return Err(wrong("holds no points: give a TSPLIB file, or lines that end in x,y".to_owned()));
        }
        Ok(Self { instance, is_rounded: is_rounded && is_tsplib })
    }

    /// The distances between them.
    #[must_use]
    pub fn metric(&self) -> Distances<'_> {
        self.instance.metric(self.is_rounded)
    }
}

/// The columns of a table of targets, in metres: east and north, or latitude and longitude on a plane through the first place.
fn read_columns(text: &str) -> Option<Vec<[f64; 2]>> {
    let mut table =
        csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(text.as_bytes());
    let header = table.headers().ok()?.clone();
    let places = |names: [&str; 2]| {
        let [a, b] = names.map(|name| header.iter().position(|word| word.eq_ignore_ascii_case(name)));
        a.zip(b)
    };
    let plane = places(["east", "north"]);
    let (a, b) = plane.or(places(["lat", "lon"])).or(places(["latitude", "longitude"]))?;
    let number = |record: &csv::StringRecord, column: usize| record.get(column)?.parse::<f64>().ok();
    let pair = |record: &csv::StringRecord| Some([number(record, a)?, number(record, b)?]);
    let points: Vec<[f64; 2]> = table.records().flatten().filter_map(|record| pair(&record)).collect();
    let [latitude, longitude] = *points.first()?;
    let origin = Origin { latitude, longitude, altitude: 0.0 };
    Some(match plane {
        Some(_) => points,
        None => points.iter().map(|&[latitude, longitude]| origin.local(latitude, longitude)).collect(),
    })
}

fn read_points(text: &str) -> Vec<[f64; 2]> {
    let numbers = |line: &str| -> Option<Vec<f64>> {
        let words = line.split([',', ' ', '\t', '\r']).filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() >= 2);
    rows.map(|row| [row[row.len() - 2], row[row.len() - 1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner::christofides::Metric;

    const TRIANGLE: &str =
        "NAME: t\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n1 0 0\n2 3 4\n3 0 1.4\nEOF\n";

    #[test]
    fn files_and_tables_are_read() -> Result<(), Problem> {
        let points = Nodes::read("t.tsp", TRIANGLE, true)?;
        assert_eq!((points.metric().distance(0, 1), points.metric().distance(0, 2)), (5.0, 1.0));
        let table = Nodes::read("t.csv", "x,y\n1,0,0\n2,3,4.5\n", true)?;
        assert!(
            table.metric().len() == 2 && table.metric().distance(0, 1) > 5.4 && !table.metric().are_whole()
        );
        let places = "id,name,lat,lon,radius\n1,oak,42.0308,-93.6319,\n2,fir,42.0317,-93.6319,4\n";
        let places = Nodes::read("targets.csv", places, false)?;
        let apart = places.metric().distance(0, 1);
        assert!((apart - 100.0).abs() < 0.1, "a nine thousandth of a degree is 100 m, not {apart} m");
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (from, to, wanted) in [
            ("EUC_2D", "MAN_2D", "EDGE_WEIGHT_TYPE MAN_2D is not supported"),
            ("3\nEDGE", "4\nEDGE", "4 points are announced, 3 found"),
            ("1.4", "inf", "not finite"),
            ("DIMENSION: 3", "DIMENSION: x", "DIMENSION is no whole number"),
        ] {
            let problem = Nodes::read("t.tsp", &TRIANGLE.replace(from, to), false);
            assert!(problem.is_err_and(|problem| problem.message.contains(wanted)), "{wanted}");
        }
        assert!(Nodes::read("t.csv", "nothing", false).is_err());
        assert!(
            Nodes::read("t.csv", "1,2\n3,inf\n", false)
                .is_err_and(|problem| problem.message.contains("finite"))
        );
    }
}
