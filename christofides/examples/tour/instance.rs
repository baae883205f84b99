//! TSPLIB files (Reinelt 1991) and lines `x,y`.

use christofides::{Geometry, Metric};
use std::error::Error;

/// How distances follow from the data.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Euclidean,
    Ceiling,
    Geographic,
    PseudoEuclidean,
    Explicit,
}

/// Points or a matrix.
pub struct Instance {
    kind: Kind,
    points: Vec<[f64; 2]>,
    matrix: Vec<f64>,
    n: usize,
}

/// The distances of an instance, with or without TSPLIB's rounding.
pub struct Distances<'a> {
    instance: &'a Instance,
    is_rounded: bool,
}

impl Instance {
    /// Reads either format; TSPLIB is recognised by its header.
    pub fn read(text: &str) -> Result<Self, Box<dyn Error>> {
        if text.contains("NODE_COORD_SECTION") || text.contains("EDGE_WEIGHT_SECTION") {
            return Self::read_tsplib(text);
        }
        let is_data = |line: &&str| !line.trim().is_empty() && line.trim() != "x,y";
        let point = |line: &str| -> Result<[f64; 2], Box<dyn Error>> {
            let (x, y) = line.split_once(',').ok_or_else(|| format!("no comma in line {line:?}"))?;
            Ok([x.trim().parse()?, y.trim().parse()?])
        };
        let points = text.lines().filter(is_data).map(point).collect::<Result<Vec<_>, _>>()?;
        Ok(Instance { kind: Kind::Euclidean, n: points.len(), points, matrix: Vec::new() })
    }

    fn read_tsplib(text: &str) -> Result<Self, Box<dyn Error>> {
        let field = |name: &str| {
            let line = text.lines().find(|line| line.trim_start().starts_with(name))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        };
        let n: usize = field("DIMENSION").ok_or("no DIMENSION")?.parse()?;
        let kind = match field("EDGE_WEIGHT_TYPE").as_deref() {
            Some("EUC_2D") => Kind::Euclidean,
            Some("CEIL_2D") => Kind::Ceiling,
            Some("GEO") => Kind::Geographic,
            Some("ATT") => Kind::PseudoEuclidean,
            Some("EXPLICIT") => Kind::Explicit,
            other => return Err(format!("edge weight type {other:?} is not supported").into()),
        };
        let mut instance = Instance { kind, n, points: Vec::new(), matrix: Vec::new() };
        if kind == Kind::Explicit {
            let format = field("EDGE_WEIGHT_FORMAT").unwrap_or_default();
            instance.matrix = square(&format, n, &numbers(text, "EDGE_WEIGHT_SECTION"))?;
        } else {
            let numbers = numbers(text, "NODE_COORD_SECTION");
            instance.points = numbers.chunks_exact(3).map(|row| [row[1], row[2]]).collect();
            if instance.points.len() != n {
                return Err(format!("{n} points announced, {} found", instance.points.len()).into());
            }
        }
        Ok(instance)
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        self.n
    }

    /// The distances.
    pub fn metric(&self, is_rounded: bool) -> Distances<'_> {
        Distances { instance: self, is_rounded }
    }
}

/// The numbers of a section, up to the first word that is none.
fn numbers(text: &str, section: &str) -> Vec<f64> {
    let body = text.split_once(section).map_or("", |(_, body)| body);
    body.split_whitespace().map_while(|word| word.parse().ok()).collect()
}

fn square(format: &str, n: usize, numbers: &[f64]) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut cells: Vec<(usize, usize)> = Vec::new();
    for i in 0..n {
        match format {
            "FULL_MATRIX" => cells.extend((0..n).map(|j| (i, j))),
            "UPPER_ROW" => cells.extend((i + 1..n).map(|j| (i, j))),
            "UPPER_DIAG_ROW" => cells.extend((i..n).map(|j| (i, j))),
            "LOWER_ROW" => cells.extend((0..i).map(|j| (i, j))),
            "LOWER_DIAG_ROW" => cells.extend((0..=i).map(|j| (i, j))),
            _ => return Err(format!("edge weight format {format:?} is not supported").into()),
        }
    }
    if cells.len() != numbers.len() {
        return Err(format!("{} edge weights needed, {} found", cells.len(), numbers.len()).into());
    }
    let mut matrix = vec![0.0; n * n];
    for ((i, j), &weight) in cells.into_iter().zip(numbers) {
        if i != j {
            matrix[i * n + j] = weight;
            matrix[j * n + i] = weight;
        }
    }
    Ok(matrix)
}

impl Metric for Distances<'_> {
    fn len(&self) -> usize {
        self.instance.n
    }

    #[inline(always)]
    fn distance(&self, i: usize, j: usize) -> f64 {
        let instance = self.instance;
        if instance.kind == Kind::Explicit {
            return instance.matrix[i * instance.n + j];
        }
        let (a, b) = (instance.points[i], instance.points[j]);
        let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
        let euclidean = (dx * dx + dy * dy).sqrt();
        match (instance.kind, self.is_rounded) {
            // As floor(), which is a call of a function where the processor is not known.
            (Kind::Euclidean, true) => (euclidean + 0.5) as i64 as f64,
            (Kind::Ceiling, true) => euclidean.ceil(),
            (Kind::PseudoEuclidean, true) => (euclidean / 10.0_f64.sqrt()).ceil(),
            (Kind::PseudoEuclidean, false) => euclidean / 10.0_f64.sqrt(),
            (Kind::Geographic, true) if i == j => 0.0,
            (Kind::Geographic, true) => (geographic(a, b) + 1.0).floor(),
            (Kind::Geographic, false) => geographic(a, b),
            _ => euclidean,
        }
    }

    fn is_metric(&self) -> bool {
        !self.is_rounded && self.instance.kind != Kind::Explicit
    }

    fn positions(&self) -> Geometry<'_> {
        let has_points = !matches!(self.instance.kind, Kind::Explicit | Kind::Geographic);
        if has_points { Geometry::Planar(&self.instance.points) } else { Geometry::Abstract }
    }

    fn geometry(&self) -> Geometry<'_> {
        let is_plane = matches!(self.instance.kind, Kind::Euclidean | Kind::Ceiling);
        if is_plane && !self.is_rounded {
            Geometry::Planar(&self.instance.points)
        } else {
            Geometry::Abstract
        }
    }
}

/// The value that TSPLIB prescribes.
#[allow(clippy::approx_constant)]
const PI: f64 = 3.141592;

/// Great-circle distance in kilometres by TSPLIB's formula, with its value of pi and of the earth's radius.
fn geographic(a: [f64; 2], b: [f64; 2]) -> f64 {
    let radians = |x: f64| {
        let degrees = x.trunc();
        PI * (degrees + 5.0 * (x - degrees) / 3.0) / 180.0
    };
    let [latitude, longitude] = a.map(radians);
    let [other_latitude, other_longitude] = b.map(radians);
    let q1 = (longitude - other_longitude).cos();
    let q2 = (latitude - other_latitude).cos();
    let q3 = (latitude + other_latitude).cos();
    6378.388 * (0.5 * ((1.0 + q1) * q2 - (1.0 - q1) * q3)).clamp(-1.0, 1.0).acos()
}
