//! A lower bound that knows gravity and how fast the thrust axis turns.
//!
//! **Claim.** No admissible motion from one end to the other is faster than [`Agility::least_time`].
//!
//! *Proof.* The velocity obeys `v' = u - g z - k |v| v` with `u = f e`, where `f` lies in `[f_min, f_max]` and the unit vector
//! `e` (the thrust axis) turns at most `w` radians per second. Let `q = T - t` be the time to go. Choose any vector `n` and any
//! continuous costate `lambda(q)`, and write `a = n - d lambda/dq`. Then `d/dt [n . p + lambda . v] = a . v + lambda . v'`, and
//! integrating from start to end gives
//!
//! ```text
//!     n . (p_1 - p_0) + lambda(0) . v_1 - lambda(T) . v_0
//!         =  integral of lambda . (u - g z) + a . v - k |v| lambda . v  dq
//!         <= integral of S(q, lambda) - g lambda_z + R(V, a, lambda)  dq,
//! ```
//!
//! where `S` is the greatest `f lambda . e` over axes `e` within `w (T - q)` of the first axis and within `w q` of the last
//! (others cannot be reached from the one, or cannot reach the other, in time), and `R` the greatest `a . v - k |v| lambda . v`
//! over velocities up to `V`. At the speed `r` that is `r |a - k r lambda|`, the square of which is a quartic in `r`: it is
//! greatest at the first root of its derivative, of a quadratic, or at `V`. A `T` for which the inequality fails is impossible. The
//! bound is the end of an interval `[0, T)` whose every `T` is proved impossible, each part of it by some `lambda`; `costate.rs` finds
//! good ones, but any would do.
//!
//! *The speed*: `V(q)` is the least of what can be reached from the first velocity in `T - q`, what can be slowed down to the
//! last velocity in `q`, and what no thrust exceeds: see `speeds.rs`.
//!
//! *The costate* of the linearised drag, `d lambda/dq = n - C lambda` from `lambda(0) = mu`: for a cruise at the speed `s`,
//! `C = 2 k s` along it and `k s` across it loses nothing, since `R` is then attained by the cruise itself.
//!
//! *Wind*: in the frame that moves with a steady wind `w` the air is still and thrust, gravity and attitude are what they are.
//! All of the above holds there, with `v - w` for both velocities and `p_1 - p_0 - w T` for the offset, which is linear in `T`.
//!
//! *Between grid points in `q`*: in a cell `lambda` moves on a straight line and `a` is constant. `S` with its two cones held as
//! wide as anywhere in the cell and `R` with the greatest `V` are convex in `lambda`, as suprema of linear functions. So their
//! mean over a cell is at most that of the values at its ends.
//!
//! *Between grid points in `T`*: for all `T` in `[T_a, T_b]` the cones and speeds are those of `T_b`, where they are widest,
//! the last cell `[T_a, T_b]` counts only if it is positive, and `lambda(T) . v_0` is linear in `T` there, as the wind's part of
//! the offset is: their greatest values are at one of the ends.

use super::costate::Costate;
use super::speeds::Speeds;
use nalgebra::Vector3;
use quad_dynamics::Motion;

/// What a vehicle's thrust can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Agility {
    /// Least and greatest thrust over mass (m/s^2).
    pub thrust: [f64; 2],
    /// Drag coefficient over twice the mass (1/m).
    pub drag: f64,
    /// How fast the thrust axis turns at most (rad/s); infinite if it may jump.
    pub turn_rate: f64,
    /// Velocity of the air (m/s, east-north-up).
    pub wind: [f64; 3],
}

/// A flight from one motion to another, as far as the bound knows it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    /// Over the ground (m).
    offset: Vector3<f64>,
    /// Of the air (m/s).
    wind: Vector3<f64>,
    /// Through the air (m/s).
    pub velocities: [Vector3<f64>; 2],
    pub axes: [Vector3<f64>; 2],
}

impl Passage {
    /// Offset through the air in a flight of `time` (s).
    pub(super) fn offset(&self, time: f64) -> Vector3<f64> {
        self.offset - self.wind * time
    }

    /// A length (m) to which no offset in a flight of up to `time` (s) is large.
    pub(super) fn size(&self, time: f64) -> f64 {
        1.0 + self.offset.norm() + self.wind.norm() * time
    }
}

/// Rounding must never lift a bound above the truth.
const ROUND_DOWN: f64 = 1.0 - 1e-9;
/// How far beyond the proved interval a costate is sought, search by search; more of them gain little.
const AHEAD: [f64; 4] = [0.06, 0.02, 0.005, 0.0];
/// First share by which the proved interval is stretched at once, and the share at which a costate counts as used up.
const STRETCH: [f64; 2] = [0.04, 0.002];

impl Agility {
    /// A time (s) in which no admissible motion leads from one motion to the other, nor in any shorter one; `proved` is such a
    /// time already known, from which the search starts.
    pub(crate) fn least_time(&self, from: &Motion, to: &Motion, proved: f64) -> f64 {
        let wind = Vector3::from(self.wind);
        let passage = Passage {
            offset: to.position - from.position,
            wind,
            velocities: [from.velocity - wind, to.velocity - wind],
            axes: [from, to].map(|motion| motion.attitude * Vector3::z()),
        };
        if passage.offset.norm() <= 1e-9 {
            return proved;
        }
        let mut bound = proved.max(1e-3);
        let speeds = Speeds::new(self, &passage, 1.5 * bound);
        let Some(mut costate) = Costate::first(&passage, bound) else { return proved };
        for ahead in AHEAD {
            costate.improve(self, &passage, &speeds, bound * (1.0 + ahead));
            let before = bound;
            bound = self.stretched(&passage, &speeds, &costate, bound);
            if bound < before * (1.0 + STRETCH[1]) {
                break;
            }
        }
        proved.max(bound * ROUND_DOWN)
    }

    /// Stretches the proved interval as far as one costate allows.
    fn stretched(&self, passage: &Passage, speeds: &Speeds, costate: &Costate, mut bound: f64) -> f64 {
        let [mut share, least] = STRETCH;
        while share >= least {
            if costate.excludes(self, passage, speeds, [bound, bound * (1.0 + share)]) {
                bound *= 1.0 + share;
            } else {
                share *= 0.5;
            }
        }
        bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::Envelope;
    use nalgebra::{Quaternion, Unit, UnitQuaternion};
    use proptest::prelude::*;
    use quad_dynamics::{GRAVITY, Vehicle, VehicleParameters};

    const VEHICLE: Agility =
        Agility { thrust: [0.981, 19.62], drag: 0.05, turn_rate: 8.485_281_374_238_571, wind: [0.0; 3] };

    fn motion(position: Vector3<f64>, velocity: Vector3<f64>, attitude: UnitQuaternion<f64>) -> Motion {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let mut motion = Motion::hover(&vehicle, position, 0.0);
        (motion.velocity, motion.attitude) = (velocity, attitude);
        motion
    }

    /// Fifty transitions solved by others on fine meshes, with both models.
    #[test]
    fn no_reference_transition_is_faster_than_its_bound_and_most_bounds_are_close() {
        let table = include_str!("../../tests/data/transitions.csv");
        let mut lines = table.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let mut shares = Vec::new();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let at =
                |name: &str| cells[header.iter().position(|h| *h == name).unwrap()].parse::<f64>().unwrap();
            let vector = |what: &str| Vector3::from(["x", "y", "z"].map(|axis| at(&format!("{what}{axis}"))));
            let attitude = |what: &str| {
                let [w, x, y, z] = ["w", "x", "y", "z"].map(|part| at(&format!("{what}{part}")));
                UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
            };
            let [from, to] = ["start", "end"].map(|end| {
                motion(
                    vector(&format!("{end}_p")),
                    vector(&format!("{end}_v")),
                    attitude(&format!("{end}_q")),
                )
            });
            let envelope = Envelope::of_thrust(29.43, 1.5, 0.15, GRAVITY, from.velocity.norm());
            let bound = VEHICLE.least_time(&from, &to, envelope.least_time_between(&from, &to));
            let best = at("tfA_hs80").min(at("tfB_hs80"));
            assert!(bound > 0.0 && bound <= best, "id {}: {bound} against {best}", cells[0]);
            shares.push(bound / best);
        }
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        assert!(mean > 0.88, "{mean}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Any flight with thrust and turning within the limits takes at least its own bound.
        #[test]
        fn no_flight_is_faster_than_its_bound(
            velocity in prop::array::uniform3(-9.0..9.0),
            axis in prop::array::uniform3(-1.0..1.0),
            pushes in prop::collection::vec((prop::array::uniform3(-1.0..1.0), 0.0..1.0), 1..8),
            pause in 0.02..0.5,
            drag in prop::sample::select(vec![0.0, 0.05, 0.3]),
            proved in 0.0..1.0,
            turn_rate in prop::sample::select(vec![0.5, 8.0, f64::INFINITY]),
            wind in prop::sample::select(vec![[0.0; 3], [4.0, -3.0, 0.0], [-9.0, 1.0, 0.5]]),
        ) {
            let agility = Agility { drag, turn_rate, wind, ..VEHICLE };
            let wind = Vector3::from(wind);
            let unit = |v: [f64; 3]| Unit::try_new(Vector3::from(v), 1e-6).unwrap_or(Vector3::z_axis());
            let attitude = |axis: &Unit<Vector3<f64>>| {
                UnitQuaternion::rotation_between(&Vector3::z(), axis)
                    .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI))
            };
            let (mut axis, mut v) = (unit(axis), Vector3::from(velocity));
            let from = motion(Vector3::zeros(), v, attitude(&axis));
            let (mut p, mut time) = (Vector3::zeros(), 0.0);
            let step = 2e-4;
            for (direction, share) in pushes {
                let wanted = unit(direction);
                let thrust = agility.thrust[0] * (1.0 - share) + agility.thrust[1] * share;
                for _ in 0..(pause / step) as usize {
                    let apart = axis.angle(&wanted);
                    if apart > 1e-9 {
                        let turned = (turn_rate * step / apart).min(1.0);
                        axis = axis.try_slerp(&wanted, turned, 1e-12).unwrap_or(axis);
                    }
                    let a = *axis * thrust - Vector3::z() * GRAVITY - (v - wind) * (drag * (v - wind).norm());
                    p += step * (v + a * (0.5 * step));
                    v += a * step;
                    time += step;
                }
            }
            let bound = agility.least_time(&from, &motion(p, v, attitude(&axis)), proved * time);
            // The simulation's own steps are off by a few of them.
            prop_assert!(bound <= time + 10.0 * step, "{bound} against {time}");
        }
    }
}
