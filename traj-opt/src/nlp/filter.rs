//! The filter of the line search (A. Waechter, L. T. Biegler, *On the implementation of an interior-point filter line-search
//! algorithm for large-scale nonlinear programming*, Math. Program. 106, 2006, section 2.3; constants as there).

/// Fraction by which a new point must reduce violation or barrier cost (gamma_theta, gamma_phi).
const GAMMA_THETA: f64 = 1e-5;
const GAMMA_PHI: f64 = 1e-8;
/// Exponents and factor of the switching condition (s_phi, s_theta, delta).
const S_PHI: f64 = 2.3;
const S_THETA: f64 = 1.1;
/// Fraction of the predicted decrease that counts as sufficient (eta_phi).
const ETA: f64 = 1e-8;
/// Safety factor of the least step (gamma_alpha).
const GAMMA_ALPHA: f64 = 0.05;

/// Line searches in a row that the filter cuts short before it is forgotten, and how often a solve may do so (IPOPT's
/// `filter_reset_trigger` and `max_filter_resets`).
const RESET_TRIGGER: usize = 5;
const MAX_RESETS: usize = 5;

/// Iterations for which memory is set aside; a limit beyond means that there is none.
pub(super) const MOST_RESERVED: usize = 10_000;

/// Pairs of violation and barrier cost that no accepted point may be worse than in both.
#[derive(Clone, Debug, Default)]
pub(crate) struct Filter {
    entries: Vec<(f64, f64)>,
    pub theta_max: f64,
    pub theta_min: f64,
    /// Line searches in a row of which the filter refused a point last.
    refusals: usize,
    resets: usize,
}

/// Violation `theta`, barrier cost `phi` and directional derivative of the cost at the start of a line search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin {
    pub theta: f64,
    pub phi: f64,
    pub slope: f64,
}

/// How a trial point was accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acceptance {
    /// Sufficient decrease of the cost; the filter stays.
    Cost,
    /// Less violation or less cost; the origin enters the filter.
    Filter,
    /// Neither is reduced enough.
    Rejected,
    /// The filter has seen better.
    Forbidden,
}

impl Acceptance {
    pub fn is_accepted(self) -> bool {
        matches!(self, Self::Cost | Self::Filter)
    }
}

impl Filter {
    /// Empties the filter; `theta` is the violation at the first iterate of the solve.
    pub fn start(&mut self, theta: f64) {
        self.entries.clear();
        (self.refusals, self.resets) = (0, 0);
        self.theta_max = 1e4 * theta.max(1.0);
        self.theta_min = 1e-4 * theta.max(1.0);
    }

    /// Makes room for as many entries as a solve can add: one a step and one a restoration, of which an iteration has at most one.
    pub fn reserve(&mut self, max_iterations: usize) {
        self.entries.clear();
        self.entries.reserve(2 * (max_iterations.min(MOST_RESERVED) + 1));
    }

    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Counts a line search that the filter cut short, or that it did not; true if it has done so too often in a row.
    pub fn is_obstinate(&mut self, cut_short: bool) -> bool {
        self.refusals = if cut_short { self.refusals + 1 } else { 0 };
        self.refusals >= RESET_TRIGGER && self.resets < MAX_RESETS
    }

    /// Forgets what it has seen of this barrier problem.
    pub fn reset(&mut self) {
        self.entries.clear();
        self.refusals = 0;
        self.resets += 1;
    }

    pub fn add(&mut self, origin: &Origin) {
        let entry = ((1.0 - GAMMA_THETA) * origin.theta, origin.phi - GAMMA_PHI * origin.theta);
        self.entries.retain(|e| e.0 < entry.0 || e.1 < entry.1);
        self.entries.push(entry);
    }

    /// True if the filter does not forbid the point.
    pub fn admits(&self, theta: f64, phi: f64) -> bool {
        theta.is_finite()
            && phi.is_finite()
            && theta <= self.theta_max
            && self.entries.iter().all(|e| theta < e.0 || phi < e.1)
    }

    /// The least step before the search is given up.
    pub fn least_step(&self, origin: &Origin) -> f64 {
        let mut bound = GAMMA_THETA;
        if origin.slope < 0.0 {
            bound = bound.min(GAMMA_PHI * origin.theta / -origin.slope);
            if origin.theta <= self.theta_min {
                bound = bound.min(origin.theta.powf(S_THETA) / (-origin.slope).powf(S_PHI));
            }
        }
        GAMMA_ALPHA * bound
    }

    /// Judges a trial point at step `alpha`.
    pub fn judge(&self, origin: &Origin, alpha: f64, theta: f64, phi: f64) -> Acceptance {
        if !self.admits(theta, phi) {
            return Acceptance::Forbidden;
        }
        let slope = origin.slope;
        let switching = slope < 0.0 && alpha * (-slope).powf(S_PHI) > origin.theta.powf(S_THETA);
        // rounding of the cost must not refuse a good step
        let slack = 10.0 * f64::EPSILON * origin.phi.abs();
        if switching && origin.theta <= self.theta_min {
            if phi - origin.phi - slack <= ETA * alpha * slope {
                return Acceptance::Cost;
            }
            return Acceptance::Rejected;
        }
        let less_violation = theta <= (1.0 - GAMMA_THETA) * origin.theta;
        let less_cost = phi - slack <= origin.phi - GAMMA_PHI * origin.theta;
        if less_violation || less_cost { Acceptance::Filter } else { Acceptance::Rejected }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_obstinate_after_refusals_in_a_row_and_only_so_often() {
        let mut filter = Filter::default();
        filter.start(1.0);
        for _ in 0..MAX_RESETS {
            assert!((1..RESET_TRIGGER).all(|_| !filter.is_obstinate(true)));
            assert!(!filter.is_obstinate(false), "the row is broken");
            assert!((1..RESET_TRIGGER).all(|_| !filter.is_obstinate(true)));
            assert!(filter.is_obstinate(true));
            filter.reset();
        }
        assert!((0..2 * RESET_TRIGGER).all(|_| !filter.is_obstinate(true)));
    }
}
