//! The four models of the vehicle with their limits.

use super::flight::{Flight, real};
use crate::bound::Agility;
use crate::circles::Orbit;
use crate::mission::{Model, TransitionSettings};
use nalgebra::{RealField, SVector, Vector3};
use quad_dynamics::{Heading, JerkLimited, Motion, PointMass, RigidBody, ShapingLimits, ThrustRate, Vehicle};
use traj_opt::{Dynamics, Hessian, Jacobian};

/// Lets `traj-opt` see a model of `quad-dynamics`; the two crates do not know each other. The hessian takes of state,
/// control and weight what the model needs.
macro_rules! dynamics {
    ($flight:ty, $nx:literal, $nu:literal, |$model:ident, $state:ident, $control:ident, $weight:ident| $hessian:expr) => {
        impl Dynamics<$nx, $nu> for $flight {
            fn derivative<T: RealField + Copy>(
                &self,
                _time: T,
                state: &SVector<T, $nx>,
                control: &SVector<T, $nu>,
            ) -> SVector<T, $nx> {
                self.model.derivative(state, control)
            }

            fn is_autonomous(&self) -> bool {
                true
            }

            fn jacobian(
                &self,
                _time: f64,
                state: &SVector<f64, $nx>,
                control: &SVector<f64, $nu>,
            ) -> Jacobian<$nx, $nu> {
                let found = self.model.jacobian(state, control);
                Jacobian {
                    value: found.value,
                    state: found.state,
                    control: found.control,
                    time: SVector::zeros(),
                }
            }

            fn hessian(
                &self,
                _time: f64,
                $state: &SVector<f64, $nx>,
                $control: &SVector<f64, $nu>,
                $weight: &SVector<f64, $nx>,
            ) -> Hessian<$nx, $nu> {
                let $model = &self.model;
                let found = $hessian;
                Hessian {
                    state_state: found.state_state,
                    state_control: found.state_control,
                    ..Hessian::zeros()
                }
            }
        }
    };
}

/// The agility of a vehicle with thrust between two values (N) and a thrust axis that turns at most so fast (rad/s).
fn agility(vehicle: &Vehicle, thrust: [f64; 2], turn_rate: f64, wind: Vector3<f64>) -> Agility {
    let mass = vehicle.mass();
    let drag = vehicle.drag_coefficient() / (2.0 * mass);
    Agility { thrust: thrust.map(|f| f / mass), drag, turn_rate, wind: wind.into() }
}

/// The thrust force (N, world) that holds a hover.
fn hover_force(vehicle: &Vehicle, wind: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(0.0, 0.0, vehicle.weight()) - vehicle.drag(&-wind)
}

/// Position and velocity under a bounded thrust vector.
#[derive(Debug, Clone)]
pub(crate) struct PointMassFlight {
    model: PointMass,
    hover: Vector3<f64>,
    max_thrust: f64,
    agility: Agility,
}

dynamics!(PointMassFlight, 6, 3, |model, state, _control, weight| model.hessian(state, weight));

impl PointMassFlight {
    pub(crate) fn new(vehicle: &Vehicle, settings: &TransitionSettings, wind: Vector3<f64>) -> Self {
        let max_thrust = settings.thrust_budget * vehicle.max_thrust();
        let agility = agility(vehicle, [0.0, max_thrust], f64::INFINITY, wind);
        let model = PointMass::new(vehicle).with_wind(wind);
        Self { model, hover: hover_force(vehicle, wind), max_thrust, agility }
    }
}

impl Flight<6, 3> for PointMassFlight {
    const MODEL: Model = Model::PointMass;
    const ATTITUDE: Option<usize> = None;

    fn agility(&self) -> Option<Agility> {
        Some(self.agility)
    }

    fn state(&self, motion: &Motion) -> SVector<f64, 6> {
        motion.point_mass_state()
    }

    fn hover_control(&self) -> SVector<f64, 3> {
        self.hover
    }

    fn control_bounds(&self) -> (SVector<f64, 3>, SVector<f64, 3>) {
        (SVector::repeat(-self.max_thrust), SVector::repeat(self.max_thrust))
    }

    fn n_limits(&self) -> usize {
        1
    }

    fn limits<T: RealField + Copy>(&self, _: &SVector<T, 6>, control: &SVector<T, 3>, values: &mut [T]) {
        values[0] = control.norm_squared() / real(self.max_thrust * self.max_thrust);
    }

    fn motion(&self, state: &SVector<f64, 6>, control: &SVector<f64, 3>) -> Motion {
        self.model.motion(state, control, Heading::AlongTrack)
    }
}

/// Position, velocity and acceleration under bounded jerk, inside an autopilot's shaping limits.
#[derive(Debug, Clone)]
pub(crate) struct JerkLimitedFlight {
    model: JerkLimited,
    shaping: ShapingLimits,
}

dynamics!(JerkLimitedFlight, 9, 3, |model, _state, _control, _weight| model.hessian());

impl JerkLimitedFlight {
    pub(crate) fn new(vehicle: &Vehicle, settings: &TransitionSettings, wind: Vector3<f64>) -> Self {
        Self { model: JerkLimited::new(vehicle).with_wind(wind), shaping: settings.shaping }
    }
}

impl Flight<9, 3> for JerkLimitedFlight {
    const MODEL: Model = Model::JerkLimited;
    const ACTIVE_BOUNDS: [f64; 2] = [1.2, 1.8];
    const ATTITUDE: Option<usize> = None;

    fn agility(&self) -> Option<Agility> {
        None
    }

    fn state(&self, motion: &Motion) -> SVector<f64, 9> {
        motion.jerk_limited_state()
    }

    fn hover_control(&self) -> SVector<f64, 3> {
        SVector::zeros()
    }

    fn control_bounds(&self) -> (SVector<f64, 3>, SVector<f64, 3>) {
        let bound = SVector::from([self.shaping.jerk, self.shaping.jerk, self.shaping.vertical_jerk]);
        (-bound, bound)
    }

    fn state_bounds(&self) -> (SVector<f64, 9>, SVector<f64, 9>) {
        let (mut lower, mut upper) = (SVector::repeat(f64::NEG_INFINITY), SVector::repeat(f64::INFINITY));
        (lower[5], upper[5]) = (-self.shaping.descent_speed, self.shaping.climb_speed);
        (lower[8], upper[8]) = (-self.shaping.vertical_acceleration, self.shaping.vertical_acceleration);
        (lower, upper)
    }

    fn n_limits(&self) -> usize {
        3
    }

    /// The horizontal limits hold for the length of the vector, as the autopilot applies them.
    fn limits<T: RealField + Copy>(&self, state: &SVector<T, 9>, control: &SVector<T, 3>, values: &mut [T]) {
        let ShapingLimits { speed, acceleration, jerk, .. } = self.shaping;
        let share = |x: T, y: T, limit: f64| (x * x + y * y) / real(limit * limit);
        values[0] = share(state[3], state[4], speed);
        values[1] = share(state[6], state[7], acceleration);
        values[2] = share(control[0], control[1], jerk);
    }

    fn motion(&self, state: &SVector<f64, 9>, control: &SVector<f64, 3>) -> Motion {
        self.model.motion(state, control, Heading::AlongTrack)
    }
}

/// Position, velocity and attitude under collective thrust and body rates.
#[derive(Debug, Clone)]
pub(crate) struct ThrustRateFlight {
    model: ThrustRate,
    hover_thrust: f64,
    thrust: [f64; 2],
    rates: Vector3<f64>,
    agility: Agility,
}

dynamics!(ThrustRateFlight, 10, 4, |model, state, control, weight| model.hessian(state, control, weight));

impl ThrustRateFlight {
    pub(crate) fn new(vehicle: &Vehicle, settings: &TransitionSettings, wind: Vector3<f64>) -> Self {
        let budget = settings.thrust_budget;
        let thrust = [vehicle.min_thrust(), budget * vehicle.max_thrust()];
        let rates = vehicle.max_body_rates() * budget;
        Self {
            model: ThrustRate::new(vehicle).with_wind(wind),
            hover_thrust: hover_force(vehicle, wind).norm(),
            thrust,
            rates,
            agility: agility(vehicle, thrust, rates.xy().norm(), wind),
        }
    }
}

impl Flight<10, 4> for ThrustRateFlight {
    const MODEL: Model = Model::ThrustRate;
    const ATTITUDE: Option<usize> = Some(6);

    fn agility(&self) -> Option<Agility> {
        Some(self.agility)
    }

    fn state(&self, motion: &Motion) -> SVector<f64, 10> {
        motion.thrust_rate_state()
    }

    fn hover_control(&self) -> SVector<f64, 4> {
        SVector::from([self.hover_thrust, 0.0, 0.0, 0.0])
    }

    fn control_bounds(&self) -> (SVector<f64, 4>, SVector<f64, 4>) {
        let ([least, greatest], rates) = (self.thrust, self.rates);
        let with = |thrust, rates: Vector3<f64>| SVector::from([thrust, rates.x, rates.y, rates.z]);
        (with(least, -rates), with(greatest, rates))
    }

    fn motion(&self, state: &SVector<f64, 10>, control: &SVector<f64, 4>) -> Motion {
        self.model.motion(state, control)
    }
}

/// Position, velocity, attitude and body rates under four rotor thrusts.
#[derive(Debug, Clone)]
pub(crate) struct RigidBodyFlight {
    model: RigidBody,
    hover_thrust: f64,
    rotor_thrust: [f64; 2],
    rates: Vector3<f64>,
    agility: Agility,
}

dynamics!(RigidBodyFlight, 13, 4, |model, state, control, weight| model.hessian(state, control, weight));

impl RigidBodyFlight {
    /// Body rates are states here: their budget is never below what the loiters at both ends of a transition have.
    pub(crate) fn new(
        vehicle: &Vehicle,
        settings: &TransitionSettings,
        wind: Vector3<f64>,
        orbits: &[Orbit],
    ) -> Self {
        let budget = settings.thrust_budget;
        let mut rates = vehicle.max_body_rates() * budget;
        for orbit in orbits {
            // The slack keeps an interior for the solver when the loiter is limited by the very rate.
            rates = rates.sup(&(orbit.loiter.body_rates() * (1.0 + 1e-6)));
        }
        let rotor_thrust = [vehicle.min_rotor_thrust(), budget * vehicle.max_rotor_thrust()];
        Self {
            model: RigidBody::new(vehicle).with_wind(wind),
            hover_thrust: hover_force(vehicle, wind).norm(),
            rotor_thrust,
            rates,
            agility: agility(vehicle, rotor_thrust.map(|rotor| 4.0 * rotor), rates.xy().norm(), wind),
        }
    }
}

impl Flight<13, 4> for RigidBodyFlight {
    const MODEL: Model = Model::RigidBody;
    const ACTIVE_BOUNDS: [f64; 2] = [3.3, 4.0];
    const ATTITUDE: Option<usize> = Some(6);

    fn agility(&self) -> Option<Agility> {
        Some(self.agility)
    }

    fn state(&self, motion: &Motion) -> SVector<f64, 13> {
        motion.rigid_body_state()
    }

    fn hover_control(&self) -> SVector<f64, 4> {
        SVector::repeat(0.25 * self.hover_thrust)
    }

    fn control_bounds(&self) -> (SVector<f64, 4>, SVector<f64, 4>) {
        (SVector::repeat(self.rotor_thrust[0]), SVector::repeat(self.rotor_thrust[1]))
    }

    fn state_bounds(&self) -> (SVector<f64, 13>, SVector<f64, 13>) {
        let mut upper: SVector<f64, 13> = SVector::repeat(f64::INFINITY);
        upper.fixed_rows_mut::<3>(10).copy_from(&self.rates);
        (-upper, upper)
    }

    fn motion(&self, state: &SVector<f64, 13>, control: &SVector<f64, 4>) -> Motion {
        self.model.motion(state, control)
    }
}
