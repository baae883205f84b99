//! Continuous gusts of the Dryden form.

use nalgebra::{Matrix3, Vector3};

use super::noise::Gaussian;

/// Dryden gusts (MIL-F-8785C, section 3.7.2) on a steady wind, sampled at a fixed step.
///
/// Along the wind the spectrum is that of a first-order lag, across it and vertically that of
/// `(1 + sqrt(3) T s)/(1 + T s)^2`, `T = L/V`, `L` the length scale and `V` the air speed. The linear filters are
/// discretised exactly (stationary covariance), so the standard deviation does not depend on the step.
#[derive(Debug, Clone)]
pub struct Dryden {
    mean: Vector3<f64>,
    /// Columns: along the wind, across, up.
    axes: Matrix3<f64>,
    along: FirstOrder,
    across: SecondOrder,
    vertical: SecondOrder,
    random: Gaussian,
}

impl Dryden {
    /// Gusts with standard deviations `intensity` (along, across, vertical; m/s) on a `mean` wind (m/s, world) at a
    /// `height` (m) for a vehicle of `air_speed` (m/s), every `step` seconds.
    ///
    /// Length scales are those near the ground (below 1000 ft): vertical the height, horizontal
    /// `h/(0.177 + 0.000823 h)^1.2`, `h` in feet, at least 10. Air speeds under 1 m/s count as 1 m/s: the gusts are
    /// carried past a vehicle that stands still in the air.
    #[must_use]
    pub fn new(
        mean: Vector3<f64>,
        intensity: Vector3<f64>,
        height: f64,
        air_speed: f64,
        step: f64,
        seed: u64,
    ) -> Self {
        let feet = height_in_feet(height);
        let horizontal = feet / (0.177 + 0.000_823 * feet).powf(1.2) * FOOT;
        let speed = air_speed.max(1.0);
        let level = mean.xy().norm();
        let (x, y) = if level > 0.0 { (mean.x / level, mean.y / level) } else { (1.0, 0.0) };
        // Gusts and sensor noise of one seed must not be the same numbers.
        let mut random = Gaussian::new(seed ^ 0x9e37_79b9_7f4a_7c15);
        Self {
            mean,
            axes: Matrix3::new(x, -y, 0.0, y, x, 0.0, 0.0, 0.0, 1.0),
            along: FirstOrder::new(intensity.x, horizontal / speed, step, &mut random),
            across: SecondOrder::new(intensity.y, horizontal / speed, step, &mut random),
            vertical: SecondOrder::new(intensity.z, feet * FOOT / speed, step, &mut random),
            random,
        }
    }

    /// Standard deviations (along, across, vertical; m/s) near the ground for a wind of `speed` m/s at 20 ft: vertical
    /// `0.1 speed`, horizontal that over `(0.177 + 0.000823 h)^0.4`, `h` the height in feet, at least 10.
    #[must_use]
    pub fn low_altitude_intensity(speed: f64, height: f64) -> Vector3<f64> {
        let vertical = 0.1 * speed;
        let horizontal = vertical / (0.177 + 0.000_823 * height_in_feet(height)).powf(0.4);
        Vector3::new(horizontal, horizontal, vertical)
    }

    /// The wind (m/s, world) of the next step.
    pub fn advance(&mut self) -> Vector3<f64> {
        let along = self.along.advance(&mut self.random);
        let across = self.across.advance(&mut self.random);
        let vertical = self.vertical.advance(&mut self.random);
        self.mean + self.axes * Vector3::new(along, across, vertical)
    }
}

const FOOT: f64 = 0.3048;

/// The height of MIL-F-8785C's low-altitude formulas: from 10 to 1000 ft.
fn height_in_feet(height: f64) -> f64 {
    (height / FOOT).clamp(10.0, 1000.0)
}

/// `T y' + y = noise`.
#[derive(Debug, Clone)]
struct FirstOrder {
    value: f64,
    decay: f64,
    kick: f64,
}

impl FirstOrder {
    fn new(deviation: f64, time: f64, step: f64, random: &mut Gaussian) -> Self {
        let decay = (-step / time).exp();
        let kick = deviation * (1.0 - decay * decay).max(0.0).sqrt();
        Self { value: deviation * random.next(), decay, kick }
    }

    fn advance(&mut self, random: &mut Gaussian) -> f64 {
        self.value = self.decay * self.value + self.kick * random.next();
        self.value
    }
}

/// `(1 + sqrt(3) T s)/(1 + T s)^2` as two lags in a row: `y = sqrt(3) x1 + (1 - sqrt(3)) x2`, `T x1' = noise - x1`,
/// `T x2' = x1 - x2`. In the stationary state `var x1 = p`, `var x2 = cov = p/2` and `var y = 2 p`.
#[derive(Debug, Clone)]
struct SecondOrder {
    x: [f64; 2],
    decay: f64,
    coupling: f64,
    /// Lower triangle of the root of the covariance of one step's noise.
    root: [f64; 3],
}

impl SecondOrder {
    fn new(deviation: f64, time: f64, step: f64, random: &mut Gaussian) -> Self {
        let decay = (-step / time).exp();
        let coupling = decay * step / time;
        let p = 0.5 * deviation * deviation;
        let stationary = cholesky(p, 0.5 * p, 0.5 * p);
        // Q = P - A P A^T, A = [[d, 0], [c, d]]
        let (d, c) = (decay, coupling);
        let first = p * (1.0 - d * d);
        let cross = 0.5 * p - p * (d * c + 0.5 * d * d);
        let second = 0.5 * p - p * (c * c + c * d + 0.5 * d * d);
        let x = draw(&stationary, random);
        Self { x, decay, coupling, root: cholesky(first, cross, second) }
    }

    fn advance(&mut self, random: &mut Gaussian) -> f64 {
        let noise = draw(&self.root, random);
        let [x1, x2] = self.x;
        self.x = [self.decay * x1 + noise[0], self.coupling * x1 + self.decay * x2 + noise[1]];
        let root3 = 3.0_f64.sqrt();
        root3 * self.x[0] + (1.0 - root3) * self.x[1]
    }
}

fn cholesky(first: f64, cross: f64, second: f64) -> [f64; 3] {
    let a = first.max(0.0).sqrt();
    let b = if a > 0.0 { cross / a } else { 0.0 };
    [a, b, (second - b * b).max(0.0).sqrt()]
}

fn draw(root: &[f64; 3], random: &mut Gaussian) -> [f64; 2] {
    let (a, b) = (random.next(), random.next());
    [root[0] * a, root[1] * a + root[2] * b]
}
