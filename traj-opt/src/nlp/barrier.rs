//! Bounds on the variables and their barrier terms.

/// Bounds with multipliers over all variables. Variables without a bound have an infinite one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Box {
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// Multipliers; zero where the bound is infinite.
    pub z_lower: Vec<f64>,
    pub z_upper: Vec<f64>,
    pub dz_lower: Vec<f64>,
    pub dz_upper: Vec<f64>,
    /// Variables that have a bound.
    bounded: Vec<usize>,
}

/// How far inside its bounds a starting point is moved, absolutely and relative to the width (kappa_1, kappa_2 of IPOPT).
const PUSH: f64 = 1e-2;
/// Multipliers are kept within this factor of mu / distance (kappa_sigma of IPOPT).
const KAPPA_SIGMA: f64 = 1e10;

/// How far multipliers move along their directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DualStep {
    length: f64,
    /// What at least is left of every multiplier.
    least_share: f64,
}

impl DualStep {
    /// Every multiplier by itself as far as it may: a bound that the solution leaves holds no other back.
    pub const SINGLE: Self = Self { length: 1.0, least_share: 0.2 };

    fn moved(self, z: f64, dz: f64) -> f64 {
        (z + self.length * dz).max(self.least_share * z)
    }
}

impl Box {
    /// Forgets all bounds of `n` variables.
    pub fn reset(&mut self, n: usize) {
        for (v, value) in [
            (&mut self.lower, f64::NEG_INFINITY),
            (&mut self.upper, f64::INFINITY),
            (&mut self.z_lower, 0.0),
            (&mut self.z_upper, 0.0),
            (&mut self.dz_lower, 0.0),
            (&mut self.dz_upper, 0.0),
        ] {
            v.clear();
            v.resize(n, value);
        }
    }

    /// To be called when all bounds are set: relaxes finite ones slightly, so that a strict interior exists (IPOPT's
    /// `bound_relax_factor`).
    pub fn relax(&mut self, factor: f64) {
        let bounds = self.lower.iter().zip(&self.upper);
        self.bounded.clear();
        self.bounded
            .extend(bounds.enumerate().filter(|(_, (l, u))| l.is_finite() || u.is_finite()).map(|(i, _)| i));
        for v in &mut self.lower {
            *v -= factor * v.abs().max(1.0);
        }
        for v in &mut self.upper {
            *v += factor * v.abs().max(1.0);
        }
    }

    /// Moves `w` inside the bounds.
    pub fn push_inside(&self, w: &mut [f64], push: f64) {
        for i in 0..w.len() {
            let (l, u) = (self.lower[i], self.upper[i]);
            let width = u - l;
            let margin = |bound: f64| {
                let absolute = push * bound.abs().max(1.0);
                if width.is_finite() { absolute.min(push * width) } else { absolute }
            };
            if l.is_finite() {
                w[i] = w[i].max(l + margin(l));
            }
            if u.is_finite() {
                w[i] = w[i].min(u - margin(u));
            }
        }
    }

    /// Sets multipliers to `mu / distance`.
    pub fn start_multipliers(&mut self, w: &[f64], mu: f64) {
        for i in 0..w.len() {
            self.z_lower[i] = if self.lower[i].is_finite() { mu / (w[i] - self.lower[i]) } else { 0.0 };
            self.z_upper[i] = if self.upper[i].is_finite() { mu / (self.upper[i] - w[i]) } else { 0.0 };
        }
    }

    /// Curvature of the barrier, `z / distance`, of variable `i`.
    #[inline]
    pub fn sigma(&self, w: &[f64], i: usize) -> f64 {
        self.z_lower[i] / (w[i] - self.lower[i]) + self.z_upper[i] / (self.upper[i] - w[i])
    }

    /// Gradient of the barrier term.
    #[inline]
    pub fn gradient(&self, w: &[f64], i: usize, mu: f64) -> f64 {
        mu / (self.upper[i] - w[i]) - mu / (w[i] - self.lower[i])
    }

    /// `-mu` times the sum of logarithms; infinite outside.
    pub fn value(&self, w: &[f64], mu: f64) -> f64 {
        // products of a few distances at a time: logarithms are the dearest part of a trial point
        let mut product = 1.0;
        let mut sum = 0.0;
        for &i in &self.bounded {
            for d in [w[i] - self.lower[i], self.upper[i] - w[i]] {
                if d.is_nan() || d <= 0.0 {
                    return f64::INFINITY;
                }
                if d < f64::INFINITY {
                    product *= d;
                    if !(1e-100..=1e100).contains(&product) {
                        sum += product.ln();
                        product = 1.0;
                    }
                }
            }
        }
        -mu * (sum + product.ln())
    }

    /// Newton directions of the multipliers for the direction `dw`.
    pub fn directions(&mut self, w: &[f64], dw: &[f64], mu: f64) {
        for &i in &self.bounded {
            if self.lower[i].is_finite() {
                let d = w[i] - self.lower[i];
                self.dz_lower[i] = (mu - self.z_lower[i] * dw[i]) / d - self.z_lower[i];
            }
            if self.upper[i].is_finite() {
                let d = self.upper[i] - w[i];
                self.dz_upper[i] = (mu + self.z_upper[i] * dw[i]) / d - self.z_upper[i];
            }
        }
    }

    /// Greatest step in `[0, 1]` that keeps `1 - tau` of every distance to a bound.
    pub fn primal_step(&self, w: &[f64], dw: &[f64], tau: f64) -> f64 {
        let mut alpha: f64 = 1.0;
        for &i in &self.bounded {
            if dw[i] < 0.0 {
                let room = tau * (w[i] - self.lower[i]);
                if -dw[i] * alpha > room {
                    alpha = room / -dw[i];
                }
            } else if dw[i] > 0.0 {
                let room = tau * (self.upper[i] - w[i]);
                if dw[i] * alpha > room {
                    alpha = room / dw[i];
                }
            }
        }
        alpha
    }

    /// Greatest step in `[0, 1]` that keeps `1 - tau` of every multiplier.
    pub fn dual_step(&self, tau: f64) -> DualStep {
        let mut alpha: f64 = 1.0;
        for (z, dz) in [(&self.z_lower, &self.dz_lower), (&self.z_upper, &self.dz_upper)] {
            for &i in &self.bounded {
                if -dz[i] * alpha > tau * z[i] {
                    alpha = tau * z[i] / -dz[i];
                }
            }
        }
        DualStep { length: alpha, least_share: 0.0 }
    }

    /// Moves the multipliers and keeps them comparable with `mu / distance` at the new `w`.
    pub fn update_multipliers(&mut self, w: &[f64], step: DualStep, mu: f64) {
        for &i in &self.bounded {
            if self.lower[i].is_finite() {
                let primal = mu / (w[i] - self.lower[i]);
                let z = step.moved(self.z_lower[i], self.dz_lower[i]);
                self.z_lower[i] = z.clamp(primal / KAPPA_SIGMA, primal * KAPPA_SIGMA);
            }
            if self.upper[i].is_finite() {
                let primal = mu / (self.upper[i] - w[i]);
                let z = step.moved(self.z_upper[i], self.dz_upper[i]);
                self.z_upper[i] = z.clamp(primal / KAPPA_SIGMA, primal * KAPPA_SIGMA);
            }
        }
    }

    /// Greatest deviation of `z * distance` from `mu`.
    pub fn complementarity(&self, w: &[f64], mu: f64) -> f64 {
        let mut worst: f64 = 0.0;
        for &i in &self.bounded {
            if self.lower[i].is_finite() {
                worst = worst.max((self.z_lower[i] * (w[i] - self.lower[i]) - mu).abs());
            }
            if self.upper[i].is_finite() {
                worst = worst.max((self.z_upper[i] * (self.upper[i] - w[i]) - mu).abs());
            }
        }
        worst
    }

    /// Sum of all multipliers and number of bounds.
    pub fn multiplier_sum(&self) -> (f64, usize) {
        let side = |z: &[f64], bound: &[f64]| {
            let (mut sum, mut count) = (0.0, 0);
            for &i in &self.bounded {
                sum += z[i];
                count += usize::from(bound[i].is_finite());
            }
            (sum, count)
        };
        let (lower, upper) = (side(&self.z_lower, &self.lower), side(&self.z_upper, &self.upper));
        (lower.0 + upper.0, lower.1 + upper.1)
    }
}

pub(crate) const DEFAULT_PUSH: f64 = PUSH;
