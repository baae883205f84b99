//! TSPLIB's other edge weights, with optima that the library publishes (Reinelt 1991), proven again here.
//!
//! The instances are transcribed; that the transcription is right is shown by the proven optimum, which is the published length.

use christofides::tsplib::{Error, Instance};
use christofides::{Metric, Options, chained_improve, christofides, exact_tour, held_karp, solve};
use proptest::prelude::*;

/// Cities of burma14, degrees and minutes.
const BURMA14: &str =
    "16.47 96.10 16.47 94.44 20.09 92.54 22.39 93.37 25.23 97.24 22.00 96.05 20.47 97.02 17.20 96.29
    16.30 97.38 14.05 98.12 16.53 97.38 21.52 95.59 19.41 97.13 20.09 94.55";

/// Cities of ulysses16, degrees and minutes.
const ULYSSES16: &str =
    "38.24 20.42 39.57 26.15 40.56 25.32 36.26 23.12 33.48 10.54 37.56 12.19 38.42 13.11 37.52 20.44
    41.23 9.10 41.17 13.05 36.08 -5.21 38.47 15.13 38.15 15.35 37.51 15.17 35.49 14.32 39.36 19.56";

/// Cities of att48.
const ATT48: &str = "6734 1453 2233 10 5530 1424 401 841 3082 1644 7608 4458 7573 3716 7265 1268 6898 1885 1112 2049
    5468 2606 5989 2873 4706 2674 4612 2035 6347 2683 6107 669 7611 5184 7462 3590 7732 4723 5900 3561 4483 3369 6101 1110
    5199 2182 1633 2809 4307 2322 675 1006 7555 4819 7541 3981 3177 756 7352 4506 7545 2801 3245 3305 6426 3173 4608 1198
    23 2216 7248 3779 7762 4595 7392 2244 3484 2829 6271 2135 4985 140 1916 1569 7280 4899 7509 3239 10 2676 6807 2993
    5185 3258 3023 1942";

/// Lower triangle of gr17 with its diagonal, row by row.
const GR17: &str = "0 633 0 257 390 0 91 661 228 0 412 227 169 383 0 150 488 112 120 267 0 80 572 196 77 351 63 0
    134 530 154 105 309 34 29 0 259 555 372 175 338 264 232 249 0 505 289 262 476 196 360 444 402 495 0
    353 282 110 324 61 208 292 250 352 154 0 324 638 437 240 421 329 297 314 95 578 435 0
    70 567 191 27 346 83 47 68 189 439 287 254 0 211 466 74 182 243 105 150 108 326 336 184 391 145 0
    268 420 53 239 199 123 207 165 383 240 140 448 202 57 0 246 745 472 237 528 364 332 349 202 685 542 157 289 426 483 0
    121 518 142 84 297 35 29 36 236 390 238 301 55 96 153 336 0";

fn with_points(kind: &str, coordinates: &str) -> Instance {
    let words: Vec<&str> = coordinates.split_whitespace().collect();
    let rows: String =
        words.chunks(2).enumerate().map(|(k, p)| format!("{} {}\n", k + 1, p.join(" "))).collect();
    let n = words.len() / 2;
    let text = format!("DIMENSION: {n}\nEDGE_WEIGHT_TYPE: {kind}\nNODE_COORD_SECTION\n{rows}EOF\n");
    Instance::read(&text).unwrap()
}

fn with_matrix(format: &str, n: usize, weights: &str) -> Instance {
    let text = format!(
        "DIMENSION : {n}\nEDGE_WEIGHT_TYPE : EXPLICIT\nEDGE_WEIGHT_FORMAT : {format}\nEDGE_WEIGHT_SECTION\n{weights}\nEOF\n"
    );
    Instance::read(&text).unwrap()
}

fn assert_optimum(instance: &Instance, optimum: f64) {
    let metric = instance.metric(true);
    assert_eq!(exact_tour(&metric).unwrap().cost(), optimum);
    let solved = solve(&metric, &Options::default(), &mut || false).unwrap();
    assert_eq!(solved.cost(), optimum);
    assert!(solved.lower_bound().unwrap() <= optimum);
    let bound = held_karp(&metric, 400).unwrap().value();
    assert!(bound <= optimum && bound >= 0.97 * optimum, "{bound}");
}

#[test]
fn geographic() {
    assert_optimum(&with_points("GEO", BURMA14), 3323.0);
    assert_optimum(&with_points("GEO", ULYSSES16), 6859.0);
}

#[test]
fn pseudo_euclidean() {
    let instance = with_points("ATT", ATT48);
    assert_optimum(&instance, 10628.0);
    // Unrounded it is a metric, so Christofides' algorithm takes it.
    let start = christofides(&instance.metric(false)).unwrap();
    assert!(start.cost() < 1.5 * 10628.0);
}

/// Rounded up, an edge costs at most one more.
#[test]
fn rounded_up() {
    let instance = with_points("CEIL_2D", ATT48);
    let (real, whole) = (instance.metric(false), instance.metric(true));
    for i in 0..instance.len() {
        for j in 0..instance.len() {
            let (x, y) = (real.distance(i, j), whole.distance(i, j));
            assert!(y == y.trunc() && y >= x && y < x + 1.0);
        }
    }
    let optimum = exact_tour(&whole).unwrap().cost();
    let start = christofides(&real).unwrap();
    let start = christofides::Tour::new(&whole, start.into_order()).unwrap();
    assert_eq!(chained_improve(&whole, start, 1000, 1, &mut || false).unwrap().cost(), optimum);
}

/// One matrix in all the forms of a symmetric matrix.
#[test]
fn explicit() {
    let lower = with_matrix("LOWER_DIAG_ROW", 17, GR17);
    assert_optimum(&lower, 2085.0);
    let n = lower.len();
    let entry = |i: usize, j: usize| lower.metric(true).distance(i, j).to_string();
    let rows = |columns: &dyn Fn(usize) -> std::ops::Range<usize>| {
        let cells = (0..n).flat_map(|i| columns(i).map(move |j| (i, j)));
        cells.map(|(i, j)| entry(i, j)).collect::<Vec<_>>().join(" ")
    };
    let forms = [
        ("FULL_MATRIX", rows(&|_| 0..n)),
        ("UPPER_ROW", rows(&|i| i + 1..n)),
        ("UPPER_DIAG_ROW", rows(&|i| i..n)),
        ("LOWER_ROW", rows(&|i| 0..i)),
    ];
    for (format, weights) in forms {
        let other = with_matrix(format, n, &weights);
        for i in 0..n {
            for j in 0..n {
                assert_eq!(other.metric(true).distance(i, j), lower.metric(true).distance(i, j), "{format}");
            }
        }
    }
}

/// A full matrix is taken as it is: one way may be longer than the other.
#[test]
fn asymmetric() {
    let instance = with_matrix("FULL_MATRIX", 2, "7 1 2 9");
    let metric = instance.metric(true);
    assert_eq!([metric.distance(0, 1), metric.distance(1, 0), metric.distance(1, 1)], [1.0, 2.0, 0.0]);
    assert!(exact_tour(&metric).is_err());
}

const TRIANGLE: &str =
    "NAME: t\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n1 0 0\n2 3 4\n3 0 1.4\nEOF\n";

#[test]
fn malformed_files_are_refused() {
    let matrix = "DIMENSION: 3\nEDGE_WEIGHT_TYPE: EXPLICIT\nEDGE_WEIGHT_FORMAT: UPPER_ROW\nEDGE_WEIGHT_SECTION\n1 2\nEOF";
    let vast = matrix.replace(": 3", ": 18446744073709551615");
    let needed = u128::from(u64::MAX) * u128::from(u64::MAX - 1) / 2;
    for (text, wrong) in [
        (TRIANGLE.replace("EUC_2D", "XRAY1"), Error::Kind("XRAY1".to_owned())),
        (TRIANGLE.replace(": 3", ": x"), Error::Dimension),
        (TRIANGLE.replace(": 3", ": 4"), Error::Points { announced: 4, found: 3 }),
        (TRIANGLE.replace("1.4", "inf"), Error::NotFinite),
        (matrix.to_owned(), Error::Weights { needed: 3, found: 2 }),
        (vast, Error::Weights { needed, found: 2 }),
        (matrix.replace("UPPER_ROW", "UPPER_COL"), Error::Format("UPPER_COL".to_owned())),
        ("1 2\n".to_owned(), Error::Kind(String::new())),
    ] {
        assert_eq!(Instance::read(&text), Err(wrong), "{text}");
    }
}

proptest! {
    #[test]
    fn no_text_makes_it_panic(place in 0usize..100, text in "[0-9A-Z_: \n.-]{0,20}") {
        let mut source = TRIANGLE.to_owned();
        source.insert_str(place % source.len(), &text);
        if let Ok(instance) = Instance::read(&source) {
            prop_assert!(instance.metric(true).len() == instance.len());
        }
    }
}
