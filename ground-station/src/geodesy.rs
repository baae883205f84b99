//! Geographic coordinates (WGS-84) and the local east-north plane that touches the ellipsoid at an origin.
//!
//! Points lie at the height of the origin. On the way out a point of the ellipsoid (raised to that height) is projected
//! orthogonally onto the tangent plane; a field of a few kilometres needs nothing more. [`Origin::geographic`] inverts
//! [`Origin::local`] to below a micrometre within 50 km.

/// Semi-major axis of WGS-84 (m).
const SEMI_MAJOR: f64 = 6_378_137.0;
/// Flattening of WGS-84.
const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// First eccentricity squared.
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);

/// The point where the local plane touches the ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// Degrees, north positive; within 89 of the equator, since at a pole there is no east.
    pub latitude: f64,
    /// Degrees, east positive.
    pub longitude: f64,
    /// Metres above mean sea level, for the files that want it.
    pub altitude: f64,
}

impl Origin {
    /// East and north (m) of a latitude and longitude (degrees).
    #[must_use]
    pub fn local(&self, latitude: f64, longitude: f64) -> [f64; 2] {
        let from = cartesian(self.latitude, self.longitude, self.altitude);
        let to = cartesian(latitude, longitude, self.altitude);
        let [x, y, z] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let (sin_latitude, cos_latitude) = self.latitude.to_radians().sin_cos();
        let (sin_longitude, cos_longitude) = self.longitude.to_radians().sin_cos();
        let outward = cos_longitude * x + sin_longitude * y;
        [cos_longitude * y - sin_longitude * x, cos_latitude * z - sin_latitude * outward]
    }

    /// Latitude and longitude (degrees) of a point of the plane, east and north (m).
    ///
    /// The radii of curvature at the origin give a first guess that is off by the square of the distance over the radius
    /// of the earth; the same radii turn the remaining error into a correction, and each round gains at least two digits.
    #[must_use]
    pub fn geographic(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        const ROUNDS: usize = 8;
        let latitude = self.latitude.to_radians();
        let w = 1.0 - ECCENTRICITY_SQUARED * latitude.sin().powi(2);
        let prime_vertical = SEMI_MAJOR / w.sqrt() + self.altitude;
        let meridian = SEMI_MAJOR * (1.0 - ECCENTRICITY_SQUARED) / w.powf(1.5) + self.altitude;
        let mut point = [self.latitude, self.longitude];
        for _ in 0..ROUNDS {
            let reached = self.local(point[0], point[1]);
            point[0] += ((north - reached[1]) / meridian).to_degrees();
            point[1] += ((east - reached[0]) / (prime_vertical * latitude.cos())).to_degrees();
        }
        [point[0], (point[1] + 180.0).rem_euclid(360.0) - 180.0]
    }
}

/// Earth-centred, earth-fixed coordinates (m).
fn cartesian(latitude: f64, longitude: f64, altitude: f64) -> [f64; 3] {
    let (sin_latitude, cos_latitude) = latitude.to_radians().sin_cos();
    let (sin_longitude, cos_longitude) = longitude.to_radians().sin_cos();
    let prime_vertical = SEMI_MAJOR / (1.0 - ECCENTRICITY_SQUARED * sin_latitude * sin_latitude).sqrt();
    let outward = (prime_vertical + altitude) * cos_latitude;
    let polar = prime_vertical * (1.0 - ECCENTRICITY_SQUARED) + altitude;
    [outward * cos_longitude, outward * sin_longitude, polar * sin_latitude]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Length of one degree of latitude and of longitude at 45 degrees on WGS-84 (m), as geodesy tables give them.
    const DEGREE_OF_LATITUDE_45: f64 = 111_131.745;
    const DEGREE_OF_LONGITUDE_45: f64 = 78_846.806;

    #[test]
    fn a_small_step_is_as_long_as_tables_say() {
        let origin = Origin { latitude: 45.0, longitude: 7.0, altitude: 0.0 };
        let [_, north] = origin.local(45.0 + 1e-4, 7.0);
        let [east, _] = origin.local(45.0, 7.0 + 1e-4);
        assert!((north - DEGREE_OF_LATITUDE_45 * 1e-4).abs() < 1e-3, "{north}");
        assert!((east - DEGREE_OF_LONGITUDE_45 * 1e-4).abs() < 1e-3, "{east}");
    }

    #[test]
    fn the_plane_is_the_one_of_the_radii_of_curvature_close_by() {
        // An independent form: series of the radii of curvature, good to the convergence of the meridians.
        let origin = Origin { latitude: 42.0308, longitude: -93.6319, altitude: 290.0 };
        let phi = origin.latitude.to_radians();
        let w = 1.0 - ECCENTRICITY_SQUARED * phi.sin().powi(2);
        let n = SEMI_MAJOR / w.sqrt() + 290.0;
        let m = SEMI_MAJOR * (1.0 - ECCENTRICITY_SQUARED) / w.powf(1.5) + 290.0;
        let [east, north] = origin.local(42.0308 + 1e-3, -93.6319 - 1e-3);
        assert!((north - m * 1e-3f64.to_radians()).abs() < 0.01, "{north}");
        assert!((east + n * phi.cos() * 1e-3f64.to_radians()).abs() < 0.01, "{east}");
    }

    proptest! {
        #[test]
        fn the_way_there_and_back_closes(
            latitude in -89.0..89.0f64, longitude in -180.0..180.0f64, altitude in -400.0..9000.0f64,
            east in -2e4..2e4f64, north in -2e4..2e4f64,
        ) {
            // Close to a pole a degree of longitude is too short for a field of 40 km to be a plane of degrees.
            prop_assume!(latitude.abs() < 80.0);
            let origin = Origin { latitude, longitude, altitude };
            let [there, across] = origin.geographic([east, north]);
            let back = origin.local(there, across);
            prop_assert!((back[0] - east).abs() < 1e-6 && (back[1] - north).abs() < 1e-6, "{:?}", back);
        }
    }
}
