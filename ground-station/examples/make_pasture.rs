//! Writes the targets of the pasture mission: `cargo run --example make_pasture > missions/pasture.geojson`.
//!
//! A hundred points, uniform in a square of 2 km around the origin, at least 30 m from each other and from the depot in
//! its middle, drawn one after the other and thrown away if too close. The stored file is the truth; this says where it is from.

use ground_station::geodesy::Origin;

const SEED: u64 = 2020;
const POINTS: usize = 100;
const HALF_SIDE: f64 = 1000.0;
const LEAST_DISTANCE: f64 = 30.0;
/// The origin of `missions/pasture.toml`.
const ORIGIN: Origin = Origin { latitude: 42.0308, longitude: -93.6319, altitude: 290.0 };

fn main() {
    let mut state = SEED;
    let mut points = vec![[0.0, 0.0]];
    while points.len() <= POINTS {
        let point = [0, 1].map(|_| HALF_SIDE * (2.0 * uniform(&mut state) - 1.0));
        let near = |other: &[f64; 2]| (other[0] - point[0]).hypot(other[1] - point[1]) < LEAST_DISTANCE;
        if !points.iter().any(near) {
            points.push(point);
        }
    }
    let features: Vec<String> = (1..=POINTS)
        .map(|number| {
            let [latitude, longitude] = ORIGIN.geographic(points[number]);
            format!(
                "  {{ \"type\": \"Feature\", \"properties\": {{ \"name\": \"P{number:03}\" }}, \
                 \"geometry\": {{ \"type\": \"Point\", \"coordinates\": [{longitude:.7}, {latitude:.7}] }} }}"
            )
        })
        .collect();
    println!("{{\n\"type\": \"FeatureCollection\",\n\"features\": [\n{}\n]\n}}", features.join(",\n"));
}

/// The next number in [0, 1) of SplitMix64 (Steele, Lea and Flood, 2014).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
