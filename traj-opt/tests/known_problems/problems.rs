//! Classic optimal control problems; statements and values from `tests/data/known_problems.md`.
//!
//! Each is a type that implements `Dynamics` and `Problem`; `all` lists them with their reference values.

use super::harness::{Entry, entry};
use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Dynamics, Guess, Problem};

const INF: f64 = f64::INFINITY;

fn c<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

fn v<const N: usize>(values: [f64; N]) -> SVector<f64, N> {
    SVector::from(values)
}

/// Declares a problem: state and control sizes, right-hand side, cost, bounds, guess.
macro_rules! problem {
    ($name:ident<$nx:literal, $nu:literal>, |$t:ident, $x:ident, $u:ident| $f:expr,
     $(lagrange: $lagrange:expr,)? $(mayer: |$xf:ident, $tf:ident| $mayer:expr,)?
     $(path: [$($path:expr),*] in [$($range:expr),*],)?
     bounds: $bounds:expr, guess: $guess:expr) => {
        #[derive(Clone, Copy)]
        pub struct $name;

        impl Dynamics<$nx, $nu> for $name {
            #[allow(unused_variables)]
            fn derivative<T: RealField + Copy>(&self, $t: T, $x: &SVector<T, $nx>, $u: &SVector<T, $nu>) -> SVector<T, $nx> {
                SVector::from($f)
            }
        }

        impl Problem<$nx, $nu> for $name {
            type Dynamics = Self;

            fn dynamics(&self) -> &Self {
                self
            }

            fn bounds(&self) -> Bounds<$nx, $nu> {
                $bounds
            }

            $(fn lagrange<T: RealField + Copy>(&self, $t: T, $x: &SVector<T, $nx>, $u: &SVector<T, $nu>) -> Option<T> {
                let _ = ($t, $x, $u);
                Some($lagrange)
            })?

            $(fn mayer<T: RealField + Copy>(&self, _: &SVector<T, $nx>, $xf: &SVector<T, $nx>, $tf: T) -> T {
                let _ = ($xf, $tf);
                $mayer
            })?

            $(fn n_path(&self) -> usize {
                [$(stringify!($path)),*].len()
            }

            fn path<T: RealField + Copy>(&self, $t: T, $x: &SVector<T, $nx>, $u: &SVector<T, $nu>, out: &mut [T]) {
                let _ = ($t, $x, $u);
                let values = [$($path),*];
                out.copy_from_slice(&values);
            }

            fn path_bounds(&self, index: usize) -> (f64, f64) {
                [$($range),*][index]
            })?
        }

        impl $name {
            fn guess() -> Guess<$nx, $nu> {
                $guess
            }
        }
    };
}

problem!(DoubleIntegrator<2, 1>, |t, x, u| [x[1], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0, 0.0])).with_terminal_state(v([1.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0, 0.0]), v([1.0, 0.0]), v([0.0]), 1.0));

problem!(TripleIntegrator<3, 1>, |t, x, u| [x[1], x[2], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0; 3])).with_terminal_state(v([1.0, 0.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0; 3]), v([1.0, 0.0, 0.0]), v([0.0]), 1.0));

problem!(SCurve<3, 1>, |t, x, u| [x[1], x[2], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-40.0]), v([40.0])).with_state(v([0.0, -2.0, -4.0]), v([4.0, 2.0, 4.0]))
        .with_initial_state(v([0.0; 3])).with_terminal_state(v([4.0, 0.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0; 3]), v([4.0, 0.0, 0.0]), v([0.0]), 2.0));

problem!(BlockMove<2, 1>, |t, x, u| [x[1], u[0]],
    lagrange: u[0] * u[0],
    bounds: Bounds::free().with_initial_state(v([0.0, 0.0])).with_terminal_state(v([1.0, 0.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([0.0, 0.0]), v([1.0, 0.0]), v([0.0]), 1.0));

problem!(Brachistochrone<3, 1>, |t, x, u| [x[2] * u[0].sin(), -x[2] * u[0].cos(), c::<T>(9.80665) * u[0].cos()],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([0.0]), v([3.2])).with_initial_state(v([0.0, 10.0, 0.0]))
        .with_terminal_component(0, 10.0).with_terminal_component(1, 5.0).with_final_time(0.1, 50.0),
    guess: Guess::line(v([0.0, 10.0, 0.0]), v([10.0, 5.0, 10.0]), v([1.0]), 2.0));

problem!(BrysonDenham<2, 1>, |t, x, u| [x[1], u[0]],
    lagrange: c::<T>(0.5) * u[0] * u[0],
    bounds: Bounds::free().with_state(v([-INF, -INF]), v([1.0 / 9.0, INF])).with_initial_state(v([0.0, 1.0]))
        .with_terminal_state(v([0.0, -1.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([0.0, 1.0]), v([0.0, -1.0]), v([0.0]), 1.0));

problem!(PlanarTwoAxis<4, 2>, |t, x, u| [x[2], x[3], u[0], u[1]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0; 2]), v([1.0; 2])).with_initial_state(v([0.0; 4]))
        .with_terminal_state(v([-100.0, 100.0, 0.0, 0.0])).with_final_time(0.1, 500.0),
    guess: Guess::line(v([0.0; 4]), v([-100.0, 100.0, 0.0, 0.0]), v([0.0; 2]), 15.0));

problem!(MoonLanding<3, 1>, |t, x, u| [x[1], u[0] / x[2] - T::one(), -u[0] / c(2.349)],
    mayer: |xf, tf| -xf[2],
    bounds: Bounds::free().with_control(v([0.0]), v([1.227])).with_state(v([-INF, -INF, 1e-3]), v([INF; 3]))
        .with_initial_state(v([1.0, -0.783, 1.0])).with_terminal_component(0, 0.0).with_terminal_component(1, 0.0).with_final_time(0.1, 20.0),
    guess: Guess::line(v([1.0, -0.783, 1.0]), v([0.0, 0.0, 0.5]), v([0.6]), 1.5));

problem!(Dubins<3, 1>, |t, x, u| [x[2].cos(), x[2].sin(), u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0; 3]))
        .with_terminal_state(v([4.0, 4.0, std::f64::consts::FRAC_PI_2])).with_final_time(0.1, 100.0),
    guess: Guess::line(v([0.0; 3]), v([4.0, 4.0, std::f64::consts::FRAC_PI_2]), v([0.0]), 6.0));

problem!(LinearTangent<4, 1>, |t, x, u| [x[2], x[3], c::<T>(100.0) * u[0].cos(), c::<T>(100.0) * u[0].sin()],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-std::f64::consts::FRAC_PI_2]), v([std::f64::consts::FRAC_PI_2])).with_initial_state(v([0.0; 4]))
        .with_terminal_component(1, 5.0).with_terminal_component(2, 45.0).with_terminal_component(3, 0.0).with_final_time(0.01, 10.0),
    guess: Guess::line(v([0.0; 4]), v([10.0, 5.0, 45.0, 0.0]), v([0.0]), 0.6));

problem!(VanDerPol<2, 1>, |t, x, u| [(T::one() - x[1] * x[1]) * x[0] - x[1] + u[0], x[0]],
    lagrange: x[0] * x[0] + x[1] * x[1] + u[0] * u[0],
    bounds: Bounds::free().with_control(v([-0.3]), v([1.0])).with_initial_state(v([0.0, 1.0])).with_final_time(5.0, 5.0),
    guess: Guess::line(v([0.0, 1.0]), v([0.0, 0.0]), v([0.0]), 5.0));

/// Acceleration of cart and pole: masses m1, m2, length l.
fn cart_pole<T: RealField + Copy>(x: &SVector<T, 4>, u: T, m1: f64, m2: f64, l: f64) -> [T; 4] {
    let (sin, cos) = (x[1].sin(), x[1].cos());
    let d = c::<T>(m1) + c::<T>(m2) * (T::one() - cos * cos);
    let (m2, l, g, total) = (c::<T>(m2), c::<T>(l), c::<T>(9.81), c::<T>(m1 + m2));
    let rate = x[3] * x[3];
    let cart = (l * m2 * sin * rate + u + m2 * g * cos * sin) / d;
    let pole = -(l * m2 * cos * sin * rate + u * cos + total * g * sin) / (l * d);
    [x[2], x[3], cart, pole]
}

fn swing_up(distance: f64, force: f64, track: f64, angle: f64) -> Bounds<4, 1> {
    Bounds::free()
        .with_control(v([-force]), v([force]))
        .with_state(v([-track, -angle, -INF, -INF]), v([track, angle, INF, INF]))
        .with_initial_state(v([0.0; 4]))
        .with_terminal_state(v([distance, std::f64::consts::PI, 0.0, 0.0]))
}

fn swing_guess(distance: f64) -> Guess<4, 1> {
    Guess::line(v([0.0; 4]), v([distance, std::f64::consts::PI, 0.0, 0.0]), v([0.0]), 2.0)
}

problem!(CartPoleKelly<4, 1>, |t, x, u| cart_pole(x, u[0], 1.0, 0.3, 0.5),
    lagrange: u[0] * u[0],
    bounds: swing_up(1.0, 20.0, 2.0, INF).with_final_time(2.0, 2.0),
    guess: swing_guess(1.0));

problem!(CartPoleForce<4, 1>, |t, x, u| cart_pole(x, u[0], 2.0, 0.5, 0.5),
    lagrange: u[0] * u[0],
    bounds: swing_up(0.8, 100.0, 1.6, 2.0 * std::f64::consts::PI).with_final_time(2.0, 2.0),
    guess: swing_guess(0.8));

problem!(CartPoleTime<4, 1>, |t, x, u| cart_pole(x, u[0], 2.0, 0.5, 0.5),
    mayer: |xf, tf| tf,
    bounds: swing_up(1.0, 50.0, 2.0, 2.0 * std::f64::consts::PI).with_final_time(0.1, 10.0),
    guess: swing_guess(1.0));

problem!(Goddard<3, 1>, |t, x, u| {
        let drag = c::<T>(310.0) * x[1] * x[1] * (c::<T>(-500.0) * (x[0] - T::one())).exp();
        [x[1], (u[0] - drag) / x[2] - T::one() / (x[0] * x[0]), -u[0] / c(0.5)]
    },
    mayer: |xf, tf| -xf[0],
    bounds: Bounds::free().with_control(v([0.0]), v([3.5])).with_state(v([1.0, 0.0, 0.6]), v([INF, INF, 1.0]))
        .with_initial_state(v([1.0, 0.0, 1.0])).with_terminal_component(2, 0.6).with_final_time(0.01, 1.0),
    guess: Guess::line(v([1.0, 0.0, 1.0]), v([1.01, 0.05, 0.6]), v([1.0]), 0.2));

problem!(CatalystMixing<2, 1>, |t, x, u| {
        let flow = u[0] * (c::<T>(10.0) * x[1] - x[0]);
        [flow, -flow - (T::one() - u[0]) * x[1]]
    },
    mayer: |xf, tf| xf[0] + xf[1] - T::one(),
    bounds: Bounds::free().with_control(v([0.0]), v([1.0])).with_initial_state(v([1.0, 0.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([1.0, 0.0]), v([0.9, 0.05]), v([0.5]), 1.0));

fn glider<T: RealField + Copy>(x: &SVector<T, 4>, lift: T, g: f64) -> [T; 4] {
    let r = (x[0] / c(100.0) - c(2.5)) * (x[0] / c(100.0) - c(2.5));
    let updraft = c::<T>(2.5) * (T::one() - r) * (-r).exp();
    let w = x[3] - updraft;
    let speed = (x[2] * x[2] + w * w).sqrt();
    let pressure = c::<T>(0.5 * 1.13 * 14.0) * speed * speed;
    let (lift_force, drag) = (lift * pressure, (c::<T>(0.034) + c::<T>(0.069_662) * lift * lift) * pressure);
    let (sin, cos) = (w / speed, x[2] / speed);
    [
        x[2],
        x[3],
        (-lift_force * sin - drag * cos) / c(100.0),
        (lift_force * cos - drag * sin) / c(100.0) - c(g),
    ]
}

fn glider_bounds(start: [f64; 4], end: [f64; 3]) -> Bounds<4, 1> {
    Bounds::free()
        .with_control(v([0.0]), v([1.4]))
        .with_state(v([0.0, -INF, 0.0, -INF]), v([INF; 4]))
        .with_initial_state(v(start))
        .with_terminal_component(1, end[0])
        .with_terminal_component(2, end[1])
        .with_terminal_component(3, end[2])
        .with_final_time(1.0, 300.0)
}

problem!(HangGlider<4, 1>, |t, x, u| glider(x, u[0], 9.81),
    mayer: |xf, tf| -xf[0],
    bounds: glider_bounds([0.0, 1000.0, 13.23, -1.288], [900.0, 13.23, -1.288]),
    guess: Guess::line(v([0.0, 1000.0, 13.23, -1.288]), v([1250.0, 900.0, 13.23, -1.288]), v([0.7]), 100.0));

problem!(HangGliderBetts<4, 1>, |t, x, u| glider(x, u[0], 9.80665),
    mayer: |xf, tf| -xf[0],
    bounds: glider_bounds([0.0, 1000.0, 13.2275675, -1.28750052], [900.0, 13.2275675, -1.28750052]),
    guess: Guess::line(v([0.0, 1000.0, 13.2275675, -1.28750052]), v([1250.0, 900.0, 13.2275675, -1.28750052]), v([0.7]), 100.0));

problem!(FreeFlyingRobot<6, 4>, |t, x, u| {
        let thrust = u[0] - u[1] + u[2] - u[3];
        let turn = c::<T>(0.2) * (u[0] - u[1] - u[2] + u[3]);
        [x[3], x[4], x[5], thrust * x[2].cos(), thrust * x[2].sin(), turn]
    },
    lagrange: u[0] + u[1] + u[2] + u[3],
    path: [u[0] + u[1], u[2] + u[3]] in [(-INF, 1.0), (-INF, 1.0)],
    bounds: Bounds::free().with_control(v([0.0; 4]), v([INF; 4]))
        .with_initial_state(v([-10.0, -10.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0])).with_terminal_state(v([0.0; 6])).with_final_time(12.0, 12.0),
    guess: Guess::line(v([-10.0, -10.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0]), v([0.0; 6]), v([0.0; 4]), 12.0));

problem!(RobotArm<6, 3>, |t, x, u| {
        let l = c::<T>(5.0);
        let (a, b) = (l - x[0], x[0]);
        let cubes = a * a * a + b * b * b;
        let sin = x[2].sin();
        [x[3], x[4], x[5], u[0] / l, c::<T>(3.0) * u[1] / (cubes * sin * sin), c::<T>(3.0) * u[2] / cubes]
    },
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0; 3]), v([1.0; 3])).with_initial_state(v([4.5, 0.0, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]))
        .with_state(v([0.0, -3.2, 0.01, -INF, -INF, -INF]), v([5.0, 3.2, 3.13, INF, INF, INF]))
        .with_terminal_state(v([4.5, 2.0 * std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0])).with_final_time(0.1, 100.0),
    guess: Guess::line(v([4.5, 0.0, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]), v([4.5, 2.0 * std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]), v([0.0; 3]), 8.0));

fn bump<T: RealField + Copy>(t: T, at: f64, rate: f64) -> T {
    (c::<T>(-rate) * (t - c(at)) * (t - c(at))).exp()
}

problem!(AlpRider<4, 2>, |t, x, u| [
        c::<T>(-10.0) * x[0] + u[0] + u[1],
        c::<T>(-2.0) * x[1] + u[0] + c::<T>(2.0) * u[1],
        c::<T>(-3.0) * x[2] + c::<T>(5.0) * x[3] + u[0] - u[1],
        c::<T>(5.0) * x[2] - c::<T>(3.0) * x[3] + u[0] + c::<T>(3.0) * u[1]],
    lagrange: c::<T>(100.0) * x.norm_squared() + c::<T>(0.01) * u.norm_squared(),
    path: [x.norm_squared() - c::<T>(3.0) * (bump(t, 3.0, 12.0) + bump(t, 6.0, 10.0) + bump(t, 10.0, 6.0)) - c::<T>(8.0) * bump(t, 15.0, 4.0)] in [(0.01, INF)],
    bounds: Bounds::free().with_initial_state(v([2.0, 1.0, 2.0, 1.0])).with_terminal_state(v([2.0, 3.0, 1.0, -2.0])).with_final_time(20.0, 20.0),
    guess: Guess::line(v([2.0, 1.0, 2.0, 1.0]), v([2.0, 3.0, 1.0, -2.0]), v([0.0; 2]), 20.0));

/// Two-dimensional quadrotor, nondimensional with 10 rad/s.
fn planar<T: RealField + Copy>(x: &SVector<T, 5>, u: &SVector<T, 2>) -> [T; 5] {
    [x[2], x[3], u[0] * x[4].sin(), u[0] * x[4].cos() - T::one(), u[1]]
}

fn planar_bounds(x: f64, z: f64) -> Bounds<5, 2> {
    let length = 100.0 / 9.81;
    Bounds::free()
        .with_control(v([1.0 / 9.81, -1.0]), v([20.0 / 9.81, 1.0]))
        .with_initial_state(v([0.0; 5]))
        .with_terminal_state(v([x * length, z * length, 0.0, 0.0, 0.0]))
        .with_final_time(0.1, 500.0)
}

fn planar_guess(x: f64, z: f64) -> Guess<5, 2> {
    let length = 100.0 / 9.81;
    Guess::line(v([0.0; 5]), v([x * length, z * length, 0.0, 0.0, 0.0]), v([1.0, 0.0]), 12.0)
}

macro_rules! planar_problem {
    ($name:ident, $x:literal, $z:literal) => {
        problem!($name<5, 2>, |t, x, u| planar(x, u),
            mayer: |xf, tf| tf / c(10.0),
            bounds: planar_bounds($x, $z),
            guess: planar_guess($x, $z));
    };
}

planar_problem!(Planar3, 3.0, 0.0);
planar_problem!(Planar6, 6.0, 0.0);
planar_problem!(Planar12, 12.0, 0.0);

// the faster of two local minima turns over to brake with thrust: the guess must turn over too
problem!(PlanarUp<5, 2>, |t, x, u| planar(x, u),
mayer: |xf, tf| tf / c(10.0),
bounds: planar_bounds(0.0, 3.0),
guess: Guess::from_fn(12.0, 20, |s| {
    let turn = (std::f64::consts::PI * s).sin();
    (v([0.0, 30.0 / 0.981 * s, 0.0, 2.5, 3.0 * turn]), v([1.0, 0.0]))
}));

/// Name, problem, reference value, sign of the printed value, relative tolerance of the reference, segments to begin with.
pub fn all() -> Vec<Entry> {
    vec![
        entry("double_integrator", DoubleIntegrator, DoubleIntegrator::guess(), 2.0, 1.0, 1e-6, 20),
        entry("triple_integrator", TripleIntegrator, TripleIntegrator::guess(), 3.174_802_1, 1.0, 1e-6, 40),
        entry("s_curve", SCurve, SCurve::guess(), 2.6, 1.0, 1e-6, 50),
        entry("block_move", BlockMove, BlockMove::guess(), 12.0, 1.0, 1e-6, 20),
        entry("brachistochrone", Brachistochrone, Brachistochrone::guess(), 1.801_603_12, 1.0, 1e-6, 20),
        entry("bryson_denham", BrysonDenham, BrysonDenham::guess(), 4.0, 1.0, 1e-6, 50),
        entry("planar_two_axis", PlanarTwoAxis, PlanarTwoAxis::guess(), 20.0, 1.0, 1e-6, 20),
        entry("moon_landing", MoonLanding, MoonLanding::guess(), 0.395_354_364, -1.0, 1e-6, 40),
        entry("dubins_LSL", Dubins, Dubins::guess(), 5.813_437_01, 1.0, 1e-6, 50),
        entry("linear_tangent", LinearTangent, LinearTangent::guess(), 0.554_570_879, 1.0, 1e-6, 20),
        entry("vanderpol", VanDerPol, VanDerPol::guess(), 2.867_261, 1.0, 1e-6, 50),
        entry("cartpole_kelly", CartPoleKelly, CartPoleKelly::guess(), 58.807_67, 1.0, 1e-6, 50),
        entry("cartpole_optimtraj_force", CartPoleForce, CartPoleForce::guess(), 225.5537, 1.0, 1e-6, 50),
        entry("cartpole_optimtraj_time", CartPoleTime, CartPoleTime::guess(), 1.106_66, 1.0, 1e-4, 50),
        entry("goddard_cops", Goddard, Goddard::guess(), 1.012_837, -1.0, 1e-6, 50),
        entry("catmix", CatalystMixing, CatalystMixing::guess(), -0.048_055_6, 1.0, 1e-3, 100),
        entry("hang_glider", HangGlider, HangGlider::guess(), 1247.99, -1.0, 1e-5, 50),
        entry("hang_glider_betts", HangGliderBetts, HangGliderBetts::guess(), 1_248.031_03, -1.0, 1e-5, 50),
        entry("free_flying_robot", FreeFlyingRobot, FreeFlyingRobot::guess(), 7.910_15, 1.0, 1e-4, 50),
        entry("robot_arm", RobotArm, RobotArm::guess(), 9.140_92, 1.0, 1e-5, 200),
        entry("alp_rider", AlpRider, AlpRider::guess(), 2_030.856_09, 1.0, 1e-4, 100),
        entry("quad2d_x3", Planar3, Planar3::guess(), 0.898_702_7, 1.0, 1e-5, 50),
        entry("quad2d_x6", Planar6, Planar6::guess(), 1.231_318_7, 1.0, 1e-5, 50),
        entry("quad2d_x12", Planar12, Planar12::guess(), 1.704_896_4, 1.0, 1e-5, 50),
        entry("quad2d_z3", PlanarUp, PlanarUp::guess(), 1.084_879_9, 1.0, 1e-4, 50),
    ]
}
