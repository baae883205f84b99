//! What can be wrong with a vehicle or with what is asked of it.

use std::fmt;

/// The parameter that an [`Error`] is about, printed as it is spelled in the struct that holds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Field {
    Mass,
    InertiaTensor,
    RotorPosition,
    MaxThrust,
    MinThrustShare,
    DragCoefficient,
    MaxBodyRates,
    TorqueToThrust,
    MaxRotorSpeed,
    RotorTimeConstant,
    RotorRadius,
    Efficiency,
    BodyDrag,
    RotorDrag,
    BatteryEnergy,
    UsableShare,
    AvionicsPower,
    Radius,
    ThrustBudget,
    Sweep,
    SpeedLimit,
    BankLimit,
    AccelerationLimit,
    CameraLimit,
    Speed,
    ShapingLimits,
    AngleOfView,
    Period,
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Field::Mass => "mass",
            Field::InertiaTensor => "inertia_tensor",
            Field::RotorPosition => "rotors.position",
            Field::MaxThrust => "max_thrust",
            Field::MinThrustShare => "min_thrust_share",
            Field::DragCoefficient => "drag_coefficient",
            Field::MaxBodyRates => "max_body_rates",
            Field::TorqueToThrust => "torque_to_thrust",
            Field::MaxRotorSpeed => "propulsion.max_rotor_speed",
            Field::RotorTimeConstant => "propulsion.time_constant",
            Field::RotorRadius => "propulsion.rotor_radius",
            Field::Efficiency => "propulsion.efficiency",
            Field::BodyDrag => "aerodynamics.body_drag",
            Field::RotorDrag => "aerodynamics.rotor_drag",
            Field::BatteryEnergy => "battery.energy",
            Field::UsableShare => "battery.usable_share",
            Field::AvionicsPower => "battery.avionics_power",
            Field::Radius => "radius",
            Field::ThrustBudget => "thrust_budget",
            Field::Sweep => "sweep",
            Field::SpeedLimit => "speed_limit",
            Field::BankLimit => "bank_limit",
            Field::AccelerationLimit => "acceleration_limit",
            Field::CameraLimit => "camera_limit",
            Field::Speed => "speed",
            Field::AngleOfView => "angle_of_view",
            Field::Period => "period",
            Field::ShapingLimits => "shaping_limits",
        })
    }
}

/// What a number must satisfy, printed as the remedy in an [`Error`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Requirement {
    /// A finite number.
    Finite,
    /// A finite number above zero.
    Positive,
    /// A finite number, zero or more.
    NonNegative,
    /// A number above `low` and at most `high`.
    Within {
        /// Excluded lower end.
        low: f64,
        /// Included upper end.
        high: f64,
    },
    /// A number strictly between `low` and `high`.
    Between {
        /// Excluded lower end.
        low: f64,
        /// Excluded upper end.
        high: f64,
    },
    /// A number from `low` to below `high`.
    From {
        /// Included lower end.
        low: f64,
        /// Excluded upper end.
        high: f64,
    },
}

impl Requirement {
    /// Whether `value` satisfies it; NaN satisfies none.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Requirement::Finite => value.is_finite(),
            Requirement::Positive => value.is_finite() && value > 0.0,
            Requirement::NonNegative => value.is_finite() && value >= 0.0,
            Requirement::Within { low, high } => value > low && value <= high,
            Requirement::Between { low, high } => value > low && value < high,
            Requirement::From { low, high } => value >= low && value < high,
        }
    }

    /// `Ok` if `value` satisfies it, else the error that names `field`.
    pub(crate) fn check(self, field: Field, value: f64) -> Result<(), Error> {
        if self.holds(value) { Ok(()) } else { Err(Error::OutOfRange { field, value, requirement: self }) }
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Requirement::Finite => write!(f, "a finite number"),
            Requirement::Positive => write!(f, "finite and above zero"),
            Requirement::NonNegative => write!(f, "finite and zero or more"),
            Requirement::Within { low, high } => write!(f, "above {low} and at most {high}"),
            Requirement::Between { low, high } => write!(f, "above {low} and below {high}"),
            Requirement::From { low, high } => write!(f, "at least {low} and below {high}"),
        }
    }
}

/// Why a vehicle, a loiter or a conversion is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is outside the range in which it means anything.
    #[error("`{field}` is {value} but must be {requirement}")]
    OutOfRange {
        /// The parameter.
        field: Field,
        /// What it was set to.
        value: f64,
        /// What it must be.
        requirement: Requirement,
    },
    /// The inertia tensor differs from its transpose.
    #[error(
        "`inertia_tensor` is not symmetric: entries ({row}, {column}) and ({column}, {row}) differ; make them equal"
    )]
    InertiaNotSymmetric {
        /// Row of the first entry that differs.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// No body has this inertia tensor: a principal moment is not positive or exceeds the sum of the other two.
    #[error(
        "`inertia_tensor` belongs to no rigid body: its principal moments are {moments:?} kg m^2, and each must be \
         positive and at most the sum of the other two"
    )]
    InertiaNotPhysical {
        /// Principal moments, ascending, kg m^2.
        moments: [f64; 3],
    },
    /// The rotors cannot produce three independent torques and a thrust.
    #[error(
        "the four rotors cannot produce roll, pitch and yaw torque independently; check `rotors` (positions not on one \
         line, two rotors of each spin) and `torque_to_thrust`"
    )]
    RotorsDependent,
    /// The vehicle cannot hover: full thrust does not exceed its weight.
    #[error(
        "`max_thrust` is {max_thrust} N but the weight is {weight} N; a quadcopter needs more thrust than weight"
    )]
    ThrustBelowWeight {
        /// Greatest collective thrust, N.
        max_thrust: f64,
        /// Weight, N.
        weight: f64,
    },
    /// The vehicle cannot descend: its least thrust is not below its weight.
    #[error("`min_thrust_share` gives at least {min_thrust} N, not below the weight of {weight} N; lower it")]
    LeastThrustAboveWeight {
        /// Least collective thrust, N.
        min_thrust: f64,
        /// Weight, N.
        weight: f64,
    },
    /// A loiter's thrust budget does not even carry the weight.
    #[error(
        "`thrust_budget` {thrust_budget} gives {thrust:.3} N, {shortfall:.3} N short of the weight of {weight:.3} N; \
         it must be above {least_budget:.4}",
        shortfall = weight - thrust
    )]
    BudgetBelowWeight {
        /// The budget, a fraction of the greatest thrust.
        thrust_budget: f64,
        /// The thrust that it allows, N.
        thrust: f64,
        /// The weight, N.
        weight: f64,
        /// The budget at which the vehicle would just hover.
        least_budget: f64,
    },
    /// Hovering already needs more from a rotor than it can give, or less than its least thrust.
    #[error(
        "hovering needs {thrust:.3} N from rotor {rotor}, outside its range {min:.3} to {max:.3} N; check `rotors`"
    )]
    HoverImbalance {
        /// Index of the rotor, from 0.
        rotor: usize,
        /// Thrust that it would need, N.
        thrust: f64,
        /// Its least thrust, N.
        min: f64,
        /// Its greatest thrust, N.
        max: f64,
    },
    /// The wanted loiter speed exceeds what the limits allow.
    #[error(
        "a loiter speed of {speed:.3} m/s is above the {allowed:.3} m/s that the {limit} limit allows; lower it"
    )]
    SpeedAboveLimit {
        /// The wanted speed, m/s.
        speed: f64,
        /// The greatest speed allowed, m/s.
        allowed: f64,
        /// The limit that sets it.
        limit: crate::Limit,
    },
    /// Hovering in this wind already needs the whole thrust budget.
    #[error(
        "hovering in a wind of {wind:.2} m/s needs {thrust:.3} N, and the thrust budget is {budget:.3} N; raise \
         `thrust_budget` or wait for less wind"
    )]
    WindTooStrong {
        /// Wind, m/s.
        wind: f64,
        /// Thrust that hovering needs, N.
        thrust: f64,
        /// Thrust that the budget allows, N.
        budget: f64,
    },
    /// The thrust vanishes, or points along the axis to the left of the yaw: flat outputs define no attitude here.
    #[error(
        "acceleration {acceleration:?} m/s^2 with yaw {yaw} rad defines no attitude: the thrust vanishes or points sideways"
    )]
    FlatnessSingular {
        /// Acceleration, m/s^2, world.
        acceleration: [f64; 3],
        /// Yaw, rad.
        yaw: f64,
    },
    /// Body x is vertical and has no yaw.
    #[error("body x is vertical, so the yaw is not defined")]
    YawUndefined,
    /// At a roll of a quarter turn yaw and pitch are one rotation.
    #[error("a roll of {roll:.6} rad is a quarter turn, where yaw and pitch are not defined separately")]
    EulerSingular {
        /// Roll, rad.
        roll: f64,
    },
}
