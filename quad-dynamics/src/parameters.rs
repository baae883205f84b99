//! The vehicle's parameters, as people write them.

use nalgebra::{Matrix3, Vector3};

use crate::equipment::{Aerodynamics, Battery, Propulsion};
use crate::error::{Error, Field, Requirement};
use crate::frames::GRAVITY;
use crate::mixer::Mixer;

/// Turning sense of a rotor seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Spin {
    /// Counter-clockwise from above; its air drag turns the body clockwise (negative yaw torque).
    CounterClockwise,
    /// Clockwise from above; its air drag turns the body counter-clockwise (positive yaw torque).
    Clockwise,
}

impl Spin {
    /// Sign of the yaw torque on the body.
    #[must_use]
    pub fn yaw_sign(self) -> f64 {
        match self {
            Spin::CounterClockwise => -1.0,
            Spin::Clockwise => 1.0,
        }
    }
}

/// One rotor: where it is and how it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rotor {
    /// Place in the body's x-y plane from the centre of mass: forward, left; m.
    pub position: [f64; 2],
    /// Turning sense.
    pub spin: Spin,
}

/// Everything that describes a quadcopter, as plain numbers; [`Vehicle::new`](crate::Vehicle::new) checks them.
///
/// Start from a preset, such as [`VehicleParameters::survey_450`], and change fields or use the `with_` setters.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct VehicleParameters {
    /// Mass in flight, kg.
    pub mass: f64,
    /// Inertia tensor about the centre of mass in body axes, kg m^2, row by row.
    pub inertia_tensor: [[f64; 3]; 3],
    /// The four rotors, in the order of the rotor thrusts.
    pub rotors: [Rotor; 4],
    /// Greatest collective thrust, N; each rotor gives a quarter.
    pub max_thrust: f64,
    /// Least thrust as a share of the greatest, for each rotor and for all: propellers do not stop in flight.
    #[cfg_attr(feature = "serde", serde(default = "default_min_thrust_share"))]
    pub min_thrust_share: f64,
    /// Drag coefficient `c_d`, kg/m: the drag is `c_d/2 |v| v` against the air, air density and area folded in.
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag_coefficient: f64,
    /// Greatest body rates about body x, y and z, rad/s.
    pub max_body_rates: [f64; 3],
    /// Yaw torque of a rotor per newton of its thrust, m.
    pub torque_to_thrust: f64,
    /// Rotor speeds, lag and efficiency: for simulation and energy only.
    #[cfg_attr(feature = "serde", serde(default))]
    pub propulsion: Propulsion,
    /// Drag beyond `drag_coefficient`: for simulation only.
    #[cfg_attr(feature = "serde", serde(default))]
    pub aerodynamics: Aerodynamics,
    /// Battery: for energy only.
    #[cfg_attr(feature = "serde", serde(default))]
    pub battery: Battery,
}

#[cfg(feature = "serde")]
fn default_min_thrust_share() -> f64 {
    VehicleParameters::DEFAULT_MIN_THRUST_SHARE
}

impl VehicleParameters {
    /// Least thrust share where none is given; the value of the reference transitions.
    pub const DEFAULT_MIN_THRUST_SHARE: f64 = 0.05;

    /// The four rotors of an X layout, each `arm` metres from the centre: front right and rear left turn clockwise,
    /// then front left and rear right counter-clockwise.
    #[must_use]
    pub fn x_layout(arm: f64) -> [Rotor; 4] {
        let a = arm * std::f64::consts::FRAC_1_SQRT_2;
        [
            Rotor { position: [a, -a], spin: Spin::Clockwise },
            Rotor { position: [-a, a], spin: Spin::Clockwise },
            Rotor { position: [a, a], spin: Spin::CounterClockwise },
            Rotor { position: [-a, -a], spin: Spin::CounterClockwise },
        ]
    }

    /// The four rotors of a + layout, each `arm` metres from the centre: front and rear turn clockwise, then left and
    /// right counter-clockwise.
    #[must_use]
    pub fn plus_layout(arm: f64) -> [Rotor; 4] {
        [
            Rotor { position: [arm, 0.0], spin: Spin::Clockwise },
            Rotor { position: [-arm, 0.0], spin: Spin::Clockwise },
            Rotor { position: [0.0, arm], spin: Spin::CounterClockwise },
            Rotor { position: [0.0, -arm], spin: Spin::CounterClockwise },
        ]
    }

    /// The same with another mass, kg.
    #[must_use]
    pub fn with_mass(mut self, mass: f64) -> Self {
        self.mass = mass;
        self
    }

    /// The same with a diagonal inertia tensor, kg m^2.
    #[must_use]
    pub fn with_principal_inertia(mut self, moments: [f64; 3]) -> Self {
        self.inertia_tensor = diagonal(moments);
        self
    }

    /// The same with other rotors.
    #[must_use]
    pub fn with_rotors(mut self, rotors: [Rotor; 4]) -> Self {
        self.rotors = rotors;
        self
    }

    /// The same with another greatest collective thrust, N.
    #[must_use]
    pub fn with_max_thrust(mut self, max_thrust: f64) -> Self {
        self.max_thrust = max_thrust;
        self
    }

    /// The same with another drag coefficient, kg/m.
    #[must_use]
    pub fn with_drag_coefficient(mut self, drag_coefficient: f64) -> Self {
        self.drag_coefficient = drag_coefficient;
        self
    }

    /// The same with other greatest body rates, rad/s.
    #[must_use]
    pub fn with_max_body_rates(mut self, max_body_rates: [f64; 3]) -> Self {
        self.max_body_rates = max_body_rates;
        self
    }

    /// The same with other propulsion data.
    #[must_use]
    pub fn with_propulsion(mut self, propulsion: Propulsion) -> Self {
        self.propulsion = propulsion;
        self
    }

    /// The same with other drag beyond the drag coefficient.
    #[must_use]
    pub fn with_aerodynamics(mut self, aerodynamics: Aerodynamics) -> Self {
        self.aerodynamics = aerodynamics;
        self
    }

    /// The same with another battery.
    #[must_use]
    pub fn with_battery(mut self, battery: Battery) -> Self {
        self.battery = battery;
        self
    }

    /// Thrust limits and torque from identified coefficients: thrust `thrust_coefficient * speed^2` (N s^2/rad^2), yaw
    /// torque `torque_coefficient * speed^2` (N m s^2/rad^2), speeds from `min_speed` to `max_speed` (rad/s).
    #[must_use]
    pub fn with_rotor_coefficients(
        mut self,
        thrust_coefficient: f64,
        torque_coefficient: f64,
        min_speed: f64,
        max_speed: f64,
    ) -> Self {
        self.max_thrust = 4.0 * thrust_coefficient * max_speed * max_speed;
        // A negative speed gives a negative share, which is refused.
        self.min_thrust_share = min_speed * min_speed.abs() / (max_speed * max_speed);
        self.torque_to_thrust = torque_coefficient / thrust_coefficient;
        self.propulsion.max_rotor_speed = max_speed;
        self
    }

    /// Everything that is wrong with these numbers; empty if [`Vehicle::new`](crate::Vehicle::new) accepts them.
    #[must_use]
    pub fn problems(&self) -> Vec<Error> {
        let mut problems = self.range_problems();
        problems.extend(inertia_problem(&self.inertia_tensor));
        if problems.is_empty() {
            problems.extend(self.balance_problems());
        }
        problems
    }

    fn range_problems(&self) -> Vec<Error> {
        use Requirement::{Finite, From, NonNegative, Positive, Within};
        let share = From { low: 0.0, high: 1.0 };
        let fraction = Within { low: 0.0, high: 1.0 };
        let single = [
            (Field::Mass, self.mass, Positive),
            (Field::MaxThrust, self.max_thrust, Positive),
            (Field::MinThrustShare, self.min_thrust_share, share),
            (Field::DragCoefficient, self.drag_coefficient, NonNegative),
            (Field::TorqueToThrust, self.torque_to_thrust, Positive),
            (Field::MaxRotorSpeed, self.propulsion.max_rotor_speed, Positive),
            (Field::RotorTimeConstant, self.propulsion.time_constant, Positive),
            (Field::RotorRadius, self.propulsion.rotor_radius, Positive),
            (Field::Efficiency, self.propulsion.efficiency, fraction),
            (Field::BatteryEnergy, self.battery.energy, Positive),
            (Field::UsableShare, self.battery.usable_share, fraction),
            (Field::AvionicsPower, self.battery.avionics_power, NonNegative),
        ];
        let rates = self.max_body_rates.map(|rate| (Field::MaxBodyRates, rate, Positive));
        let places =
            self.rotors.iter().flat_map(|rotor| rotor.position.map(|x| (Field::RotorPosition, x, Finite)));
        let body_drag = self.aerodynamics.body_drag.map(|drag| (Field::BodyDrag, drag, NonNegative));
        let rotor_drag = self.aerodynamics.rotor_drag.map(|drag| (Field::RotorDrag, drag, NonNegative));
        let all = single.into_iter().chain(rates).chain(places).chain(body_drag).chain(rotor_drag);
        all.filter_map(|(field, value, requirement)| requirement.check(field, value).err()).collect()
    }

    /// Whether it can hover and turn; the single numbers are known to be good.
    fn balance_problems(&self) -> Vec<Error> {
        let weight = self.mass * GRAVITY;
        let max_thrust = self.max_thrust;
        let min_thrust = self.min_thrust_share * max_thrust;
        let mut problems = Vec::new();
        if max_thrust <= weight {
            problems.push(Error::ThrustBelowWeight { max_thrust, weight });
        }
        if min_thrust >= weight {
            problems.push(Error::LeastThrustAboveWeight { min_thrust, weight });
        }
        match Mixer::new(&self.rotors, self.torque_to_thrust) {
            Err(error) => problems.push(error),
            Ok(mixer) if problems.is_empty() => {
                let (min, max) = (min_thrust / 4.0, max_thrust / 4.0);
                let hover = mixer.rotor_thrusts(weight, &Vector3::zeros());
                let outside = hover.iter().enumerate().find(|(_, f)| **f < min || **f > max);
                problems.extend(outside.map(|(rotor, f)| Error::HoverImbalance {
                    rotor,
                    thrust: *f,
                    min,
                    max,
                }));
            }
            Ok(_) => {}
        }
        problems
    }
}

pub(crate) fn diagonal(moments: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = moments;
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

fn inertia_problem(rows: &[[f64; 3]; 3]) -> Option<Error> {
    // Principal moments of a flat plate meet the triangle inequality with equality: leave room for rounding.
    const RELATIVE_ROUNDING: f64 = 1e-9;
    for value in rows.iter().flatten() {
        if let Err(error) = Requirement::Finite.check(Field::InertiaTensor, *value) {
            return Some(error);
        }
    }
    let scale = rows.iter().flatten().fold(0.0_f64, |scale, value| scale.max(value.abs()));
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        if (rows[row][column] - rows[column][row]).abs() > RELATIVE_ROUNDING * scale {
            return Some(Error::InertiaNotSymmetric { row, column });
        }
    }
    let mut moments: [f64; 3] = to_matrix(rows).symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [least, middle, greatest] = moments;
    let physical = least > 0.0 && greatest <= (least + middle) * (1.0 + RELATIVE_ROUNDING);
    (!physical).then_some(Error::InertiaNotPhysical { moments })
}

pub(crate) fn to_matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}
