//! TSPLIB files (Reinelt 1991) and tables of points, for the solvers alone.

use crate::geodesy::Origin;
use crate::problem::{Problem, abridged};
use planner::christofides::{Geometry, Metric};

/// How distances follow from the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Euclidean,
    Ceiling,
    PseudoEuclidean,
    Geographic,
    Explicit,
}

const KINDS: [(&str, Kind); 5] = [
    ("EUC_2D", Kind::Euclidean),
    ("CEIL_2D", Kind::Ceiling),
    ("ATT", Kind::PseudoEuclidean),
    ("GEO", Kind::Geographic),
    ("EXPLICIT", Kind::Explicit),
];

/// The most nodes of an explicit matrix, which is held whole.
const LARGEST_MATRIX: usize = 10_000;

/// An instance: points or a matrix, with or without TSPLIB's rounding of distances to whole numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    kind: Kind,
    points: Vec<[f64; 2]>,
    matrix: Vec<f64>,
    n: usize,
    is_rounded: bool,
}

impl Instance {
    /// Reads a TSPLIB file, recognised by its sections, a table of targets with columns `lat`
    /// and `lon` or `east` and `north`, or lines that end in two coordinates, separated by commas or spaces.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub fn read(file: &str, text: &str, is_rounded: bool) -> Result<Self, Problem> {
        let wrong =
            |message: String| Problem { file: file.to_owned(), line: None, key: String::new(), message };
        let is_tsplib =
            ["NODE_COORD_SECTION", "EDGE_WEIGHT_SECTION"].iter().any(|section| text.contains(section));
        let mut instance = match is_tsplib {
            true => read_tsplib(text).map_err(wrong)?,
            false => points_of(read_columns(text).unwrap_or_else(|| read_points(text))),
        };
        instance.is_rounded = is_rounded && is_tsplib;
        if instance.n == 0 {
            return Err(wrong("holds no points: give a TSPLIB file, or lines that end in x,y".to_owned()));
        }
        let numbers = instance.points.iter().flatten().chain(&instance.matrix);
        match numbers.clone().all(|number| number.is_finite()) {
            true => Ok(instance),
            false => Err(wrong("holds a number that is not finite".to_owned())),
        }
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

fn points_of(points: Vec<[f64; 2]>) -> Instance {
    Instance { kind: Kind::Euclidean, n: points.len(), points, matrix: Vec::new(), is_rounded: false }
}

fn read_points(text: &str) -> Vec<[f64; 2]> {
    let numbers = |line: &str| -> Option<Vec<f64>> {
        let words = line.split([',', ' ', '\t', '\r']).filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() >= 2);
    rows.map(|row| [row[row.len() - 2], row[row.len() - 1]]).collect()
}

fn read_tsplib(text: &str) -> Result<Instance, String> {
    let field = |name: &str| {
        let line = text.lines().find(|line| line.trim_start().starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let word = field("EDGE_WEIGHT_TYPE").unwrap_or_default();
    let kind = KINDS.iter().find(|(known, _)| *known == word).map(|&(_, kind)| kind);
    let kind = kind.ok_or_else(|| {
        let known: Vec<&str> = KINDS.iter().map(|(known, _)| *known).collect();
        format!("EDGE_WEIGHT_TYPE {} is not supported: give one of {}", abridged(&word), known.join(", "))
    })?;
    let n: usize =
        field("DIMENSION").and_then(|text| text.parse().ok()).ok_or("DIMENSION is no whole number")?;
    let mut instance = Instance { kind, n, points: Vec::new(), matrix: Vec::new(), is_rounded: false };
    if kind == Kind::Explicit {
        let format = field("EDGE_WEIGHT_FORMAT").unwrap_or_default();
        instance.matrix = square(&format, n, &numbers(text, "EDGE_WEIGHT_SECTION"))?;
    } else {
        instance.points =
            numbers(text, "NODE_COORD_SECTION").chunks_exact(3).map(|row| [row[1], row[2]]).collect();
        if instance.points.len() != n {
            return Err(format!("{n} points are announced, {} found", instance.points.len()));
        }
    }
    Ok(instance)
}

/// The numbers of a section, up to the first word that is none.
fn numbers(text: &str, section: &str) -> Vec<f64> {
    let body = text.split_once(section).map_or("", |(_, body)| body);
    body.split_whitespace().map_while(|word| word.parse().ok()).collect()
}

/// The symmetric matrix of a list of weights in one of TSPLIB's orders.
fn square(format: &str, n: usize, weights: &[f64]) -> Result<Vec<f64>, String> {
    if n > LARGEST_MATRIX {
        return Err(format!("a matrix of {n} nodes is too large: give at most {LARGEST_MATRIX}"));
    }
    let columns = |row: usize| match format {
        "FULL_MATRIX" => Some(0..n),
        "UPPER_ROW" => Some(row + 1..n),
        "UPPER_DIAG_ROW" => Some(row..n),
        "LOWER_ROW" => Some(0..row),
        "LOWER_DIAG_ROW" => Some(0..row + 1),
        _ => None,
    };
    let mut matrix = vec![0.0; n * n];
    let mut rest = weights.iter();
    for row in 0..n {
        for column in
            columns(row).ok_or_else(|| format!("EDGE_WEIGHT_FORMAT {} is not supported", abridged(format)))?
        {
            let weight =
                *rest.next().ok_or_else(|| format!("only {} edge weights are there", weights.len()))?;
            if row != column {
                matrix[row * n + column] = weight;
                matrix[column * n + row] = weight;
            }
        }
    }
    if rest.next().is_some() {
        Err("more edge weights are there than nodes have".to_owned())
    } else {
        Ok(matrix)
    }
}

impl Metric for Instance {
    fn len(&self) -> usize {
        self.n
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        if self.kind == Kind::Explicit {
            return self.matrix[i * self.n + j];
        }
        let (a, b) = (self.points[i], self.points[j]);
        let euclidean = (a[0] - b[0]).hypot(a[1] - b[1]);
        match (self.kind, self.is_rounded) {
            (Kind::Euclidean, true) => (euclidean + 0.5).floor(),
            (Kind::Ceiling, true) => euclidean.ceil(),
            (Kind::PseudoEuclidean, true) => (euclidean / 10f64.sqrt()).ceil(),
            (Kind::PseudoEuclidean, false) => euclidean / 10f64.sqrt(),
            // By its formula a point would be a kilometre from itself.
            (Kind::Geographic, true) if i == j => 0.0,
            (Kind::Geographic, true) => (geographic(a, b) + 1.0).floor(),
            (Kind::Geographic, false) => geographic(a, b),
            _ => euclidean,
        }
    }

    fn is_metric(&self) -> bool {
        !self.is_rounded && self.kind != Kind::Explicit
    }

    fn positions(&self) -> Geometry<'_> {
        let has_points = !matches!(self.kind, Kind::Explicit | Kind::Geographic);
        if has_points { Geometry::Planar(&self.points) } else { Geometry::Abstract }
    }

    fn geometry(&self) -> Geometry<'_> {
        let is_plane = matches!(self.kind, Kind::Euclidean | Kind::Ceiling) && !self.is_rounded;
        if is_plane { Geometry::Planar(&self.points) } else { Geometry::Abstract }
    }
}

/// Great-circle distance (km) of two points in degrees and minutes (DDD.MM), by TSPLIB's formula with its values of pi and of
/// the earth's radius.
fn geographic(a: [f64; 2], b: [f64; 2]) -> f64 {
    #[allow(clippy::approx_constant)]
    const PI: f64 = 3.141592;
    const EARTH_RADIUS: f64 = 6378.388;
    let radians = |x: f64| {
        let degrees = x.trunc();
        PI * (degrees + 5.0 * (x - degrees) / 3.0) / 180.0
    };
    let [latitude, longitude] = a.map(radians);
    let [other_latitude, other_longitude] = b.map(radians);
    let q1 = (longitude - other_longitude).cos();
    let q2 = (latitude - other_latitude).cos();
    let q3 = (latitude + other_latitude).cos();
    EARTH_RADIUS * (0.5 * ((1.0 + q1) * q2 - (1.0 - q1) * q3)).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TRIANGLE: &str =
        "NAME: t\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n1 0 0\n2 3 4\n3 0 1.4\nEOF\n";

    #[test]
    fn points_matrices_and_tables_are_read() -> Result<(), Problem> {
        let points = Instance::read("t.tsp", TRIANGLE, true)?;
        assert_eq!((points.distance(0, 1), points.distance(0, 2)), (5.0, 1.0));
        let matrix = TRIANGLE
            .split("NODE")
            .next()
            .unwrap_or_default()
            .replace("EUC_2D", "EXPLICIT\nEDGE_WEIGHT_FORMAT: LOWER_ROW");
        let matrix = Instance::read("t.tsp", &format!("{matrix}EDGE_WEIGHT_SECTION\n7\n8 9\nEOF\n"), false)?;
        assert_eq!((matrix.distance(1, 0), matrix.distance(0, 2), matrix.distance(2, 1)), (7.0, 8.0, 9.0));
        let table = Instance::read("t.csv", "x,y\n1,0,0\n2,3,4\n", true)?;
        assert_eq!((table.len(), table.distance(0, 1)), (2, 5.0));
        let places = "id,name,lat,lon,radius\n1,oak,42.0308,-93.6319,\n2,fir,42.0317,-93.6319,4\n";
        let places = Instance::read("targets.csv", places, false)?;
        assert!(
            places.len() == 2 && (places.distance(0, 1) - 100.0).abs() < 0.1,
            "a nine thousandth of a degree is 100 m"
        );
        Ok(())
    }

    /// The first four places of TSPLIB's `ulysses16`; the distances are the first row of its matrix in the literature.
    #[test]
    fn geographic_distances_are_those_of_the_literature() -> Result<(), Problem> {
        let text = "DIMENSION: 4\nEDGE_WEIGHT_TYPE: GEO\nNODE_COORD_SECTION\n\
                    1 38.24 20.42\n2 39.57 26.15\n3 40.56 25.32\n4 36.26 23.12\nEOF\n";
        let places = Instance::read("ulysses.tsp", text, true)?;
        assert_eq!([0, 1, 2, 3].map(|j| places.distance(0, j)), [0.0, 509.0, 501.0, 312.0]);
        let exact = Instance::read("ulysses.tsp", text, false)?;
        assert!((508.0..509.0).contains(&exact.distance(0, 1)));
        assert!(matches!(places.positions(), Geometry::Abstract));
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
            let problem = Instance::read("t.tsp", &TRIANGLE.replace(from, to), false);
            assert!(problem.is_err_and(|problem| problem.message.contains(wanted)), "{wanted}");
        }
        assert!(Instance::read("t.csv", "nothing", false).is_err());
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(place in 0usize..100, text in "[0-9A-Z_: \n.-]{0,20}") {
            let mut source = TRIANGLE.to_owned();
            source.insert_str(place % source.len(), &text);
            let _ = Instance::read("t.tsp", &source, true);
        }
    }
}
