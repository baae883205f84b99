//! Instances in the format of TSPLIB (Reinelt 1991), from text: coordinates or a matrix, with the library's own distances.
//!
//! | `EDGE_WEIGHT_TYPE` | distance | rounded |
//! |---|---|---|
//! | `EUC_2D` | Euclidean | to the nearest whole number |
//! | `CEIL_2D` | Euclidean | up |
//! | `ATT` | Euclidean over the square root of 10 | up |
//! | `GEO` | great circle (km) between degrees and minutes `DDD.MM` | down, and one more |
//! | `EXPLICIT` | as listed: full matrix, or upper or lower triangle by rows, with or without its diagonal | not at all |
//!
//! Published optima are those of rounded distances; these are no metric, so Christofides' bound asks for the others.
//!
//! ```
//! use christofides::tsplib::Instance;
//! use christofides::{Metric, exact_tour};
//!
//! let text = "DIMENSION: 4\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n1 0 0\n2 3 0\n3 3 4.4\n4 0 4\nEOF\n";
//! let instance = Instance::read(text)?;
//! assert_eq!(exact_tour(&instance.metric(true))?.cost(), 14.0);
//! assert!(instance.metric(false).distance(2, 3) > 3.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::{Geometry, Metric};

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

/// Why a text is no instance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The number of vertices is missing or no whole number.
    #[error("DIMENSION is no whole number: give the number of nodes")]
    Dimension,
    /// Distances of a kind that is not read.
    #[error("EDGE_WEIGHT_TYPE {0} is not supported: give one of EUC_2D, CEIL_2D, ATT, GEO, EXPLICIT")]
    Kind(String),
    /// A matrix in a form that is not read.
    #[error(
        "EDGE_WEIGHT_FORMAT {0} is not supported: give one of FULL_MATRIX, UPPER_ROW, UPPER_DIAG_ROW, LOWER_ROW, LOWER_DIAG_ROW"
    )]
    Format(String),
    /// More or fewer points than announced.
    #[error("{announced} points are announced, {found} found")]
    Points {
        /// `DIMENSION`.
        announced: usize,
        /// Rows of three numbers in `NODE_COORD_SECTION`.
        found: usize,
    },
    /// More or fewer edge weights than the matrix needs.
    #[error("{needed} edge weights are needed, {found} found")]
    Weights {
        /// What form and `DIMENSION` ask for.
        needed: u128,
        /// Numbers in `EDGE_WEIGHT_SECTION`.
        found: usize,
    },
    /// A coordinate or an edge weight is NaN or infinite.
    #[error("a coordinate or an edge weight is not finite")]
    NotFinite,
}

/// Points or a matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    kind: Kind,
    points: Vec<[f64; 2]>,
    /// Row by row; empty but for explicit weights.
    matrix: Vec<f64>,
    n: usize,
}

/// The distances of an instance, with or without TSPLIB's rounding.
#[derive(Debug, Clone, Copy)]
pub struct Distances<'a> {
    instance: &'a Instance,
    is_rounded: bool,
}

impl Instance {
    /// Reads a file's text.
    ///
    /// # Errors
    /// [`Error`]: what is wrong with it.
    pub fn read(text: &str) -> Result<Self, Error> {
        let word = field(text, "EDGE_WEIGHT_TYPE").unwrap_or_default();
        let kind = KINDS.iter().find(|(known, _)| *known == word).map(|&(_, kind)| kind);
        let kind = kind.ok_or_else(|| Error::Kind(abridged(word)))?;
        let n = field(text, "DIMENSION").and_then(|word| word.parse().ok()).ok_or(Error::Dimension)?;
        let mut instance = Self { kind, points: Vec::new(), matrix: Vec::new(), n };
        if kind == Kind::Explicit {
            let format = field(text, "EDGE_WEIGHT_FORMAT").unwrap_or_default();
            instance.matrix = square(format, n, &numbers(text, "EDGE_WEIGHT_SECTION"))?;
        } else {
            let rows = numbers(text, "NODE_COORD_SECTION");
            instance.points = rows.chunks_exact(3).map(|row| [row[1], row[2]]).collect();
            let found = instance.points.len();
            if found != n {
                return Err(Error::Points { announced: n, found });
            }
        }
        let all_finite =
            instance.points.iter().flatten().chain(&instance.matrix).all(|number| number.is_finite());
        if all_finite { Ok(instance) } else { Err(Error::NotFinite) }
    }

    /// Whether a text has a section of such a file.
    #[must_use]
    pub fn is_one(text: &str) -> bool {
        ["NODE_COORD_SECTION", "EDGE_WEIGHT_SECTION"].iter().any(|section| text.contains(section))
    }

    /// Points of the plane.
    #[must_use]
    pub fn planar(points: Vec<[f64; 2]>) -> Self {
        Self { kind: Kind::Euclidean, n: points.len(), points, matrix: Vec::new() }
    }

    /// The number of vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.n
    }

    /// Whether there is no vertex.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// The distances.
    #[must_use]
    pub fn metric(&self, is_rounded: bool) -> Distances<'_> {
        Distances { instance: self, is_rounded }
    }
}

impl Distances<'_> {
    /// Whether all distances are whole numbers, so that every tour's length is one and a lower bound may be rounded up.
    #[must_use]
    pub fn are_whole(&self) -> bool {
        match self.instance.kind {
            Kind::Explicit => self.instance.matrix.iter().all(|weight| weight.fract() == 0.0),
            _ => self.is_rounded,
        }
    }
}

/// What follows a keyword and its colon.
fn field<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let line = text.lines().find(|line| line.trim_start().starts_with(name))?;
    Some(line.split_once(':')?.1.trim())
}

/// The numbers of a section, up to the first word that is none.
fn numbers(text: &str, section: &str) -> Vec<f64> {
    let body = text.split_once(section).map_or("", |(_, body)| body);
    body.split_whitespace().map_while(|word| word.parse().ok()).collect()
}

/// As much of a word as a message needs.
fn abridged(word: &str) -> String {
    word.chars().take(40).collect()
}

/// The matrix of a list of weights in one of TSPLIB's orders.
fn square(format: &str, n: usize, weights: &[f64]) -> Result<Vec<f64>, Error> {
    let diagonal = n as u128;
    let triangle = diagonal * diagonal.saturating_sub(1) / 2;
    let needed = match format {
        "FULL_MATRIX" => diagonal * diagonal,
        "UPPER_ROW" | "LOWER_ROW" => triangle,
        "UPPER_DIAG_ROW" | "LOWER_DIAG_ROW" => triangle + diagonal,
        _ => return Err(Error::Format(abridged(format))),
    };
    // Asked first, so that a number alone takes no memory.
    if needed != weights.len() as u128 {
        return Err(Error::Weights { needed, found: weights.len() });
    }
    let columns = |row: usize| match format {
        "UPPER_ROW" => row + 1..n,
        "UPPER_DIAG_ROW" => row..n,
        "LOWER_ROW" => 0..row,
        "LOWER_DIAG_ROW" => 0..row + 1,
        _ => 0..n,
    };
    let mut matrix = vec![0.0; n * n];
    let mut rest = weights.iter();
    for row in 0..n {
        for column in columns(row) {
            let weight = rest.next().copied().filter(|_| row != column).unwrap_or(0.0);
            matrix[row * n + column] = weight;
            if format != "FULL_MATRIX" {
                matrix[column * n + row] = weight;
            }
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
            // By its formula a place would be a kilometre from itself.
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

/// Great-circle distance in kilometres by TSPLIB's formula, with its values of pi and of the earth's radius.
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
