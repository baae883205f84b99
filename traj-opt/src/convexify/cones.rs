//! Second-order cones that a user adds to a problem.

use crate::Problem;
use nalgebra::SVector;

/// An affine function `state . x + control . u + constant` of state and control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<const NX: usize, const NU: usize> {
    /// Factors of the states.
    pub state: SVector<f64, NX>,
    /// Factors of the controls.
    pub control: SVector<f64, NU>,
    /// Value at zero.
    pub constant: f64,
}

impl<const NX: usize, const NU: usize> Affine<NX, NU> {
    /// A constant function.
    #[must_use]
    pub fn constant(constant: f64) -> Self {
        Self { state: SVector::zeros(), control: SVector::zeros(), constant }
    }

    /// Component `index` of the state.
    ///
    /// # Panics
    /// If `index >= NX`.
    #[must_use]
    pub fn state(index: usize) -> Self {
        Self::constant(0.0).with_state(index, 1.0)
    }

    /// Component `index` of the control.
    ///
    /// # Panics
    /// If `index >= NU`.
    #[must_use]
    pub fn control(index: usize) -> Self {
        Self::constant(0.0).with_control(index, 1.0)
    }

    /// Sets the factor of a state.
    ///
    /// # Panics
    /// If `index >= NX`.
    #[must_use]
    pub fn with_state(mut self, index: usize, factor: f64) -> Self {
        self.state[index] = factor;
        self
    }

    /// Sets the factor of a control.
    ///
    /// # Panics
    /// If `index >= NU`.
    #[must_use]
    pub fn with_control(mut self, index: usize, factor: f64) -> Self {
        self.control[index] = factor;
        self
    }

    /// Sets the constant.
    #[must_use]
    pub fn with_constant(mut self, constant: f64) -> Self {
        self.constant = constant;
        self
    }

    fn is_finite(&self) -> bool {
        self.constant.is_finite() && self.state.iter().chain(&self.control).all(|factor| factor.is_finite())
    }

    /// Value at a state and control.
    #[must_use]
    pub fn at(&self, x: &SVector<f64, NX>, u: &SVector<f64, NU>) -> f64 {
        self.state.dot(x) + self.control.dot(u) + self.constant
    }
}

/// A second-order cone: the Euclidean norm of `rows` is at most `radius`. Without rows it says `radius >= 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone<const NX: usize, const NU: usize> {
    /// What the norm is taken of.
    pub rows: Vec<Affine<NX, NU>>,
    /// What it may not exceed.
    pub radius: Affine<NX, NU>,
}

impl<const NX: usize, const NU: usize> Cone<NX, NU> {
    pub(super) fn is_finite(&self) -> bool {
        self.radius.is_finite() && self.rows.iter().all(Affine::is_finite)
    }

    /// `norm - radius` at a state and control: positive outside the cone, by how much.
    #[must_use]
    pub fn excess(&self, x: &SVector<f64, NX>, u: &SVector<f64, NU>) -> f64 {
        self.rows.iter().map(|row| row.at(x, u).powi(2)).sum::<f64>().sqrt() - self.radius.at(x, u)
    }
}

/// A [`Problem`] with second-order cones that hold at every collocation point: limits of a thrust vector, glide slopes, cones of view.
/// Unlike a path constraint a cone is never linearised.
pub trait Conic<const NX: usize, const NU: usize>: Problem<NX, NU> {
    /// The cones.
    fn cones(&self) -> Vec<Cone<NX, NU>>;
}
