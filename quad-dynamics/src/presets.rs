//! Vehicles that someone measured, each with its source.

use crate::equipment::{Aerodynamics, Battery, Propulsion};
use crate::error::Error;
use crate::parameters::{Rotor, Spin, VehicleParameters, diagonal};
use crate::vehicle::Vehicle;

impl VehicleParameters {
    /// Names that [`VehicleParameters::preset`] knows.
    pub const PRESETS: [&'static str; 4] = ["survey-450", "crazyflie", "hummingbird", "racing"];

    /// A preset by its name, one of [`VehicleParameters::PRESETS`].
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "survey-450" => Some(Self::survey_450()),
            "crazyflie" => Some(Self::crazyflie()),
            "hummingbird" => Some(Self::hummingbird()),
            "racing" => Some(Self::racing()),
            _ => None,
        }
    }

    /// A 450 mm-class survey quadcopter: 1.5 kg, thrust twice its weight.
    ///
    /// The size of vehicle that Gao, Mandal and Bhattacharya (2020) flew; the numbers are those of the reference
    /// transitions in `tests/data/transitions.csv`: inertia diag(0.015, 0.015, 0.028) kg m^2, rotors 0.225 m from the
    /// centre in an X, yaw torque to thrust 0.016 m, drag coefficient 0.15 kg/m. Propulsion and battery are typical of the
    /// class (10-inch propellers, 14.8 V, 5 A h), not identified.
    #[must_use]
    pub fn survey_450() -> Self {
        Self {
            mass: 1.5,
            inertia_tensor: diagonal([0.015, 0.015, 0.028]),
            rotors: Self::x_layout(0.225),
            max_thrust: 29.43,
            min_thrust_share: Self::DEFAULT_MIN_THRUST_SHARE,
            drag_coefficient: 0.15,
            max_body_rates: [6.0, 6.0, 2.0],
            torque_to_thrust: 0.016,
            propulsion: Propulsion::default(),
            aerodynamics: Aerodynamics::default(),
            battery: Battery::default(),
        }
    }

    /// Bitcraze Crazyflie 2.0: 28 g.
    ///
    /// J. Förster, *System Identification of the Crazyflie 2.0 Nano Quadrocopter* (ETH Zürich 2015): mass, full inertia
    /// tensor, thrust at full command (0.0915 + 0.0677 N a rotor), torque to thrust, rotor drag. Motor time constant 72 ms:
    /// J. Eschmann et al. (2024, arXiv:2404.07837). Assumed, not identified: body rates, rotor radius (45 mm propellers), rotor
    /// efficiency, the 240 mA h of the battery as it is sold, avionics power.
    #[must_use]
    pub fn crazyflie() -> Self {
        let inertia_tensor = [
            [16.571_710e-6, 0.830_806e-6, 0.718_277e-6],
            [0.830_806e-6, 16.655_602e-6, 1.800_197e-6],
            [0.718_277e-6, 1.800_197e-6, 29.261_652e-6],
        ];
        Self {
            mass: 0.028,
            inertia_tensor,
            rotors: Self::x_layout(0.046),
            max_thrust: 4.0 * (0.091_492_681 + 0.067_673_604),
            min_thrust_share: Self::DEFAULT_MIN_THRUST_SHARE,
            drag_coefficient: 0.0,
            max_body_rates: [8.0, 8.0, 4.0],
            torque_to_thrust: 0.005_964_552,
            propulsion: Propulsion {
                max_rotor_speed: 2500.0,
                time_constant: 0.072,
                rotor_radius: 0.0225,
                efficiency: 0.3,
            },
            aerodynamics: Aerodynamics {
                body_drag: [0.0; 3],
                rotor_drag: [10.2506e-7, 10.2506e-7, 7.553e-7],
            },
            battery: Battery { energy: 3.7 * 0.24 * 3600.0, usable_share: 0.8, avionics_power: 0.3 },
        }
    }

    /// Ascending Technologies Hummingbird: 0.5 kg, + layout.
    ///
    /// N. Michael, D. Mellinger, Q. Lindsey, V. Kumar, *The GRASP Multiple Micro-UAV Testbed* (IEEE Robotics and
    /// Automation Magazine 2010): mass, arm 0.17 m, thrust 6.11e-8 N/rpm^2, torque 1.5e-9 N m/rpm^2, 1200 to 7800 rpm,
    /// motor gain 20/s. Inertia and drag as in RotorPy 2.1 (Folk, Paulos, Kumar 2023), after J. Svacha et al. (2017). Assumed, not
    /// identified: body rates, rotor radius (8-inch propellers), rotor efficiency, battery (11.1 V, 2.1 A h), avionics power.
    #[must_use]
    pub fn hummingbird() -> Self {
        let per_minute = std::f64::consts::TAU / 60.0;
        let squared = per_minute * per_minute;
        let base = Self {
            mass: 0.5,
            inertia_tensor: diagonal([3.65e-3, 3.68e-3, 7.03e-3]),
            rotors: Self::plus_layout(0.17),
            drag_coefficient: 0.01,
            max_body_rates: [6.0, 6.0, 3.0],
            propulsion: Propulsion { time_constant: 0.05, rotor_radius: 0.1, ..Propulsion::default() },
            aerodynamics: Aerodynamics {
                body_drag: [0.0, 0.0, 0.01],
                rotor_drag: [1.19e-4, 1.19e-4, 2.32e-4],
            },
            battery: Battery { energy: 11.1 * 2.1 * 3600.0, usable_share: 0.8, avionics_power: 5.0 },
            ..Self::survey_450()
        };
        base.with_rotor_coefficients(
            6.11e-8 / squared,
            1.5e-9 / squared,
            1200.0 * per_minute,
            7800.0 * per_minute,
        )
    }

    /// A 5-inch racing quadcopter: 0.752 kg, thrust 4.6 times its weight.
    ///
    /// The vehicle of the Robotics and Perception Group, Zürich: L. Bauersfeld et al., *NeuroBEM* (2021) and P. Foehn et
    /// al., *Agilicious* (2022): mass, inertia diag(2.5, 2.1, 4.3) g m^2, rotors at (±0.075, ±0.10) m, 8.5 N a rotor,
    /// thrust 1.562522e-6 N s^2, torque to thrust 0.022 m, motor lag 33 ms, body rates 10, 10, 4 rad/s. They model
    /// the drag by blade elements and a network, so there is no drag coefficient to take over. Assumed, not identified: least
    /// thrust, rotor radius (5.1-inch propellers), rotor efficiency, battery (14.8 V, 1.5 A h), avionics power.
    #[must_use]
    pub fn racing() -> Self {
        let rotor = |x: f64, y: f64| {
            let spin = if x * y < 0.0 { Spin::CounterClockwise } else { Spin::Clockwise };
            Rotor { position: [x, y], spin }
        };
        Self {
            mass: 0.752,
            inertia_tensor: diagonal([2.5e-3, 2.1e-3, 4.3e-3]),
            rotors: [rotor(0.075, -0.1), rotor(-0.075, 0.1), rotor(0.075, 0.1), rotor(-0.075, -0.1)],
            max_thrust: 4.0 * 8.5,
            min_thrust_share: 0.01,
            drag_coefficient: 0.0,
            max_body_rates: [10.0, 10.0, 4.0],
            torque_to_thrust: 0.022,
            propulsion: Propulsion {
                max_rotor_speed: (8.5_f64 / 1.562_522e-6).sqrt(),
                time_constant: 0.033,
                rotor_radius: 0.0648,
                efficiency: 0.45,
            },
            aerodynamics: Aerodynamics::default(),
            battery: Battery { energy: 14.8 * 1.5 * 3600.0, usable_share: 0.8, avionics_power: 10.0 },
        }
    }
}

impl Vehicle {
    /// A preset by its name, one of [`VehicleParameters::PRESETS`], checked.
    ///
    /// # Errors
    /// None for a preset as it is; the type is that of [`Vehicle::new`].
    ///
    /// ```
    /// use quad_dynamics::{Vehicle, VehicleParameters};
    /// for name in VehicleParameters::PRESETS {
    ///     let vehicle = Vehicle::preset(name).ok_or(name)??;
    ///     assert!(vehicle.max_thrust() > vehicle.weight());
    /// }
    /// assert!(Vehicle::preset("zeppelin").is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn preset(name: &str) -> Option<Result<Self, Error>> {
        VehicleParameters::preset(name).map(Self::new)
    }

    /// The 450 mm-class survey quadcopter, [`VehicleParameters::survey_450`].
    ///
    /// # Panics
    /// Never: the parameters are constants, and a test builds every preset.
    #[must_use]
    #[allow(clippy::expect_used)]
    pub fn survey_450() -> Self {
        Self::new(VehicleParameters::survey_450()).expect("constants that a test has checked")
    }
}
