//! Dynamics and running cost at one collocation point, with derivatives.

use crate::autodiff::{
    constant, constant2, gradient, hessian_part, mixed_part, seed, seed_columns, seed_rows, seed2,
};
use crate::dense::Arithmetic;
use crate::{Dynamics, Hessian, Jacobian, Problem};
use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};

/// Running cost with its gradient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Running<const NX: usize, const NU: usize> {
    pub value: f64,
    pub x: SVector<f64, NX>,
    pub u: SVector<f64, NU>,
    pub t: f64,
}

/// Dynamics and running cost with first derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointModel<const NX: usize, const NU: usize> {
    pub f: Jacobian<NX, NU>,
    pub running: Option<Running<NX, NU>>,
}

/// Contribution of a point to the Lagrangian, `h (omega . f + omega_l L)`, differentiated in x, u and the final time p, on
/// which h and t depend. The `objective_*` entries are those of the running cost alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointTerms<const NX: usize, const NU: usize> {
    pub x: SVector<f64, NX>,
    pub u: SVector<f64, NU>,
    pub p: f64,
    pub objective_x: SVector<f64, NX>,
    pub objective_u: SVector<f64, NU>,
    pub objective_p: f64,
    pub xp: SVector<f64, NX>,
    pub up: SVector<f64, NU>,
    pub pp: f64,
}

/// Step length and time of a point and how they depend on the final time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointTime {
    pub time: f64,
    /// Length of the segment (or step).
    pub h: f64,
    /// dh/dp; 0 if the final time is fixed.
    pub h_rate: f64,
    /// dt/dp; 0 if the final time is fixed.
    pub t_rate: f64,
}

/// First derivatives of dynamics and running cost.
#[inline(always)]
pub(crate) fn differentiate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    t: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
) -> PointModel<NX, NU> {
    PointModel { f: problem.dynamics().jacobian(t, x, u), running: running_gradient(problem, t, x, u) }
}

fn running_gradient<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    t: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
) -> Option<Running<NX, NU>> {
    // without a running cost no dual number is even made
    problem.lagrange(t, x, u)?;
    let by_x = problem.lagrange(DualSVec64::from_re(t), &seed(x), &constant::<NU, NX>(u))?;
    let by_u = problem.lagrange(DualSVec64::from_re(t), &constant::<NX, NU>(x), &seed(u))?;
    let by_t = problem.lagrange(
        Dual64::from_re(t).derivative(),
        &x.map(Dual64::from_re),
        &u.map(Dual64::from_re),
    )?;
    Some(Running { value: by_x.re, x: gradient(&by_x), u: gradient(&by_u), t: by_t.eps })
}

/// Second derivatives of `weight . f + weight_l L`.
pub(crate) fn weighted_hessian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    t: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
    weight: &SVector<f64, NX>,
    weight_l: f64,
) -> Hessian<NX, NU> {
    let mut hessian = problem.dynamics().hessian(t, x, u, weight);
    add_running_hessian(problem, t, x, u, weight_l, &mut hessian);
    hessian
}

fn add_running_hessian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    t: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
    weight: f64,
    out: &mut Hessian<NX, NU>,
) -> Option<()> {
    problem.lagrange(t, x, u)?;
    let xx = problem.lagrange(Dual2SVec64::from_re(t), &seed2(x), &constant2::<NU, NX>(u))?;
    let uu = problem.lagrange(Dual2SVec64::from_re(t), &constant2::<NX, NU>(x), &seed2(u))?;
    let xu =
        problem.lagrange(HyperDualSVec64::from_re(t), &seed_rows::<NX, NU>(x), &seed_columns::<NX, NU>(u))?;
    out.state_state += hessian_part(&xx) * weight;
    out.control_control += hessian_part(&uu) * weight;
    out.state_control += mixed_part(&xu) * weight;
    if !problem.is_autonomous() {
        let one = || Derivative::some(SMatrix::<f64, 1, 1>::repeat(1.0));
        let mut tx = HyperDualSVec64::<NX, 1>::from_re(t);
        tx.eps2 = one();
        let xt = problem.lagrange(tx, &seed_rows::<NX, 1>(x), &u.map(HyperDualSVec64::from_re))?;
        let mut tu = HyperDualSVec64::<NU, 1>::from_re(t);
        tu.eps2 = one();
        let ut = problem.lagrange(tu, &x.map(HyperDualSVec64::from_re), &seed_rows::<NU, 1>(u))?;
        let tt = HyperDual64::new(t, 1.0, 1.0, 0.0);
        let tt = problem.lagrange(tt, &x.map(HyperDual64::from_re), &u.map(HyperDual64::from_re))?;
        out.state_time += mixed_part(&xt) * weight;
        out.control_time += mixed_part(&ut) * weight;
        out.time_time += tt.eps1eps2 * weight;
    }
    Some(())
}

/// Second derivatives of a point's contribution to the Lagrangian; zero unless `second`.
#[inline(always)]
pub(crate) fn hessian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    at: &PointTime,
    (x, u, second): (&SVector<f64, NX>, &SVector<f64, NU>, bool),
    omega: &SVector<f64, NX>,
    omega_l: f64,
) -> Hessian<NX, NU> {
    if second {
        weighted_hessian(problem, at.time, x, u, &(omega * at.h), omega_l * at.h)
    } else {
        Hessian::zeros()
    }
}

impl<const NX: usize, const NU: usize> PointTerms<NX, NU> {
    /// Derivatives of `h (omega . f + omega_l L)` at a point, whose second derivatives by state and control are at hand.
    #[inline(always)]
    pub fn new<A: Arithmetic>(
        model: &PointModel<NX, NU>,
        at: &PointTime,
        omega: &SVector<f64, NX>,
        omega_l: f64,
        hessian: &Hessian<NX, NU>,
    ) -> Self {
        let f = &model.f;
        let (h, dh, dt) = (at.h, at.h_rate, at.t_rate);
        let fx = A::tr_mul_vec(&f.state, omega);
        let fu = A::tr_mul_vec(&f.control, omega);
        let ft = f.time.dot(omega);
        let (lx, lu, lt, l) = match &model.running {
            Some(r) => (r.x * omega_l, r.u * omega_l, r.t * omega_l, r.value * omega_l),
            None => (SVector::zeros(), SVector::zeros(), 0.0, 0.0),
        };
        Self {
            x: (fx + lx) * h,
            u: (fu + lu) * h,
            p: dh * (f.value.dot(omega) + l) + h * dt * (ft + lt),
            objective_x: lx * h,
            objective_u: lu * h,
            objective_p: dh * l + h * dt * lt,
            xp: (fx + lx) * dh + hessian.state_time * dt,
            up: (fu + lu) * dh + hessian.control_time * dt,
            pp: 2.0 * dh * dt * (ft + lt) + hessian.time_time * dt * dt,
        }
    }
}
