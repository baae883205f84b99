//! Between rotor thrusts and what they do to the body.

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::error::Error;
use crate::parameters::Rotor;

/// Linear map between four rotor thrusts and (collective thrust, torque).
///
/// A rotor at `(x, y)` with thrust `f` gives the torque `(y f, -x f, ± k f)`, `k` the torque-to-thrust length and the
/// sign its spin's.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixer {
    forward: Matrix4<f64>,
    inverse: Matrix4<f64>,
}

impl Mixer {
    /// The map of four rotors with yaw torque `torque_to_thrust` (m) per newton.
    ///
    /// # Errors
    /// [`Error::RotorsDependent`] if the rotors cannot produce the three torques independently.
    pub fn new(rotors: &[Rotor; 4], torque_to_thrust: f64) -> Result<Self, Error> {
        // Below this determinant of the matrix with rows of length one, the inverse is noise.
        const LEAST_DETERMINANT: f64 = 1e-9;
        let column = |rotor: &Rotor| {
            let [x, y] = rotor.position;
            Vector4::new(1.0, y, -x, rotor.spin.yaw_sign() * torque_to_thrust)
        };
        let forward = Matrix4::from_columns(&rotors.each_ref().map(column));
        let lengths = Vector4::from_fn(|row, _| forward.row(row).norm().recip());
        let scale = Matrix4::from_diagonal(&lengths);
        let normalised = scale * forward;
        let independent = normalised.determinant().abs() > LEAST_DETERMINANT;
        let inverse = normalised.try_inverse().filter(|_| independent).map(|inverse| inverse * scale);
        let inverse = inverse.filter(|m| m.iter().all(|x| x.is_finite())).ok_or(Error::RotorsDependent)?;
        Ok(Self { forward, inverse })
    }

    /// Collective thrust (N) and torque (N m, body axes) of rotor thrusts (N).
    #[must_use]
    pub fn thrust_and_torque(&self, rotor_thrusts: &Vector4<f64>) -> (f64, Vector3<f64>) {
        let wrench = self.forward * rotor_thrusts;
        (wrench[0], wrench.fixed_rows::<3>(1).into_owned())
    }

    /// The rotor thrusts (N) with this collective thrust (N) and torque (N m); they may lie outside what rotors can do.
    #[must_use]
    pub fn rotor_thrusts(&self, collective_thrust: f64, torque: &Vector3<f64>) -> Vector4<f64> {
        self.inverse * Vector4::new(collective_thrust, torque.x, torque.y, torque.z)
    }

    /// Rotor thrusts within `[min, max]` (N each) closest to the wanted thrust (N) and torque (N m), giving up what matters
    /// least first: yaw torque, then collective thrust, then roll and pitch torque.
    ///
    /// Roll and pitch point the thrust, so they come first (M. Faessler, D. Falanga, D. Scaramuzza 2017). A request within
    /// the limits is met exactly. Does not allocate.
    #[must_use]
    pub fn allocate(
        &self,
        collective_thrust: f64,
        torque: &Vector3<f64>,
        min: f64,
        max: f64,
    ) -> Vector4<f64> {
        let lift = self.inverse.column(0).into_owned();
        let tilt = self.inverse.column(1) * torque.x + self.inverse.column(2) * torque.y;
        let yaw = self.inverse.column(3) * torque.z;
        let wanted = tilt + yaw + lift * collective_thrust;
        if wanted.min() >= min && wanted.max() <= max {
            return wanted;
        }
        let tilt = tilt * largest_share(&lift, &tilt, min, max);
        let (low, high) = lift_range(&lift, &tilt, min, max);
        let base = tilt + lift * collective_thrust.min(high).max(low);
        let room = |rotor: usize| match yaw[rotor] {
            change if change > 0.0 => ((max - base[rotor]) / change).max(0.0),
            change if change < 0.0 => ((min - base[rotor]) / change).max(0.0),
            _ => 1.0,
        };
        let share = (0..4).map(room).fold(1.0, f64::min);
        // Rounding may leave the range by one part in 1e16.
        (base + yaw * share).map(|thrust| thrust.max(min).min(max))
    }
}

/// Collective thrusts for which `tilt + lift * thrust` is within the limits; empty if the first exceeds the second.
fn lift_range(lift: &Vector4<f64>, tilt: &Vector4<f64>, min: f64, max: f64) -> (f64, f64) {
    (0..4).filter(|i| lift[*i] > 0.0).fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), i| {
        (low.max((min - tilt[i]) / lift[i]), high.min((max - tilt[i]) / lift[i]))
    })
}

/// The largest share of `tilt`, at most 1, for which some collective thrust keeps all rotors within the limits.
///
/// For rotors i, j: `(min - k tilt_i)/lift_i <= (max - k tilt_j)/lift_j`, linear in the share k.
fn largest_share(lift: &Vector4<f64>, tilt: &Vector4<f64>, min: f64, max: f64) -> f64 {
    let usable = || (0..4).filter(|i| lift[*i] > 0.0);
    let mut share = 1.0_f64;
    for (i, j) in usable().flat_map(|i| usable().map(move |j| (i, j))) {
        let change = tilt[j] / lift[j] - tilt[i] / lift[i];
        if change > 0.0 {
            share = share.min(((max / lift[j] - min / lift[i]) / change).max(0.0));
        }
    }
    share
}
