//! Closed-loop flight: the controller, rotors with lag, noisy sensors and wind.

mod dryden;
mod metrics;
mod noise;

pub use dryden::Dryden;
pub use metrics::Tracking;
pub use noise::SensorNoise;

use nalgebra::{SVector, Vector3};

use crate::control::{Gains, Target, TrackingController};
use crate::models::RotorLag;
use crate::motion::Motion;
use crate::rk4::rk4_step_unit;
use crate::vehicle::Vehicle;
use noise::Gaussian;

/// How a flight is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SimulationOptions {
    /// Time step of controller and integration, s. Default 0.002 (500 Hz).
    pub step: f64,
    /// Gains of the controller.
    pub gains: Gains,
    /// How far ahead the attitude is taken from the plan, s; it makes up for the rotors' lag. Default 0.034.
    pub look_ahead: f64,
    /// Time over which jumps of the planned body rates are spread, s: real bodies cannot jump. Default 0.28.
    pub ramp: f64,
    /// Steady wind, m/s, world. Default none.
    pub wind: Vector3<f64>,
    /// Standard deviations of gusts along the wind, across it and vertical, m/s ([`Dryden`]). Default none.
    pub gusts: Vector3<f64>,
    /// Errors of the state estimate that the controller sees. Default none.
    pub noise: SensorNoise,
    /// Every how many steps a state is recorded. Default 10.
    pub record_every: usize,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self {
            step: 0.002,
            gains: Gains::default(),
            look_ahead: 0.034,
            ramp: 0.28,
            wind: Vector3::zeros(),
            gusts: Vector3::zeros(),
            noise: SensorNoise::default(),
            record_every: 10,
        }
    }
}

impl SimulationOptions {
    /// The same in a steady wind, m/s, world.
    #[must_use]
    pub fn with_wind(mut self, wind: Vector3<f64>) -> Self {
        self.wind = wind;
        self
    }

    /// The same in gusts with the standard deviations of MIL-F-8785C near the ground for a wind of `speed` m/s at 6 m:
    /// see [`Dryden::low_altitude_intensity`].
    #[must_use]
    pub fn with_gusts(mut self, speed: f64, height: f64) -> Self {
        self.gusts = Dryden::low_altitude_intensity(speed, height);
        self
    }

    /// The same with other sensor noise.
    #[must_use]
    pub fn with_noise(mut self, noise: SensorNoise) -> Self {
        self.noise = noise;
        self
    }

    /// The same with other gains.
    #[must_use]
    pub fn with_gains(mut self, gains: Gains) -> Self {
        self.gains = gains;
        self
    }

    /// The same with jumps of the planned body rates spread over another time, s.
    #[must_use]
    pub fn with_ramp(mut self, ramp: f64) -> Self {
        self.ramp = ramp;
        self
    }

    /// The same with another look ahead, s.
    #[must_use]
    pub fn with_look_ahead(mut self, look_ahead: f64) -> Self {
        self.look_ahead = look_ahead;
        self
    }
}

/// A simulated flight.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Flight {
    /// Time between recorded states, s.
    pub interval: f64,
    /// Recorded states of [`RotorLag`]: p, v, q, w, rotor speeds.
    pub states: Vec<SVector<f64, 17>>,
    /// The state at the end.
    pub end: SVector<f64, 17>,
    /// How well the plan was followed.
    pub tracking: Tracking,
}

/// Samples a motion every `step` seconds from 0 to `duration`, both ends included, as [`simulate`] wants it.
///
/// A step or duration that is not positive gives the start only, and so do those that ask for more than 2^24 motions (9 hours at
/// 500 Hz, 5 GB).
#[must_use]
pub fn sample(motion: impl Fn(f64) -> Motion, duration: f64, step: f64) -> Vec<Motion> {
    const MOST_STEPS: f64 = (1_u32 << 24) as f64;
    let n_steps = (duration / step).round();
    let n_steps = if step > 0.0 && (0.0..=MOST_STEPS).contains(&n_steps) { n_steps as usize } else { 0 };
    (0..=n_steps).map(|i| motion(i as f64 * step)).collect()
}

/// Flies a plan, sampled every `options.step` seconds, from its first motion on.
///
/// The vehicle is [`RotorLag`]; the controller sees the state with the sensors' noise. Equal plan, options and seed give
/// equal flights, to the bit. A flight whose state leaves the finite numbers ends there. `None` for an empty plan.
///
/// # Complexity
/// A few hundred nanoseconds a step; allocates only for the record.
#[must_use]
pub fn simulate(
    vehicle: &Vehicle,
    plan: &[Motion],
    options: &SimulationOptions,
    seed: u64,
) -> Option<Flight> {
    let first = plan.first()?;
    let step = options.step;
    let mut model = RotorLag::new(vehicle).with_wind(options.wind);
    let mut controller = TrackingController::new(vehicle, options.gains);
    let mut gusts = gust_model(plan, options, seed);
    let mut random = Gaussian::new(seed);
    let mut state = at_rest_on(vehicle, first);
    let record_every = options.record_every.max(1);
    let mut states = Vec::with_capacity(plan.len() / record_every + 1);
    let ahead = (options.look_ahead / step).round().max(0.0) as usize;
    let half_ramp = (0.5 * options.ramp / step).round().max(1.0) as usize;
    let last = plan.len() - 1;
    let inverse_coefficient = vehicle.thrust_coefficient().recip();
    for (i, now) in plan.iter().enumerate() {
        if i % record_every == 0 {
            states.push(state);
        }
        if i == last || !state.iter().all(|x| x.is_finite()) {
            break;
        }
        if let Some(gusts) = &mut gusts {
            model.set_wind(gusts.advance());
        }
        let centre = i.saturating_add(ahead);
        let [before, middle, after] =
            [centre.saturating_sub(half_ramp), centre, centre.saturating_add(half_ramp)]
                .map(|k| &plan[k.min(last)]);
        let target = Target::between(before, middle, after, 2.0 * half_ramp as f64 * step);
        let measured = options.noise.measure(&state, &mut random);
        let thrusts = controller.update(&measured, now, &target, step);
        let speeds = thrusts.map(|thrust| (thrust * inverse_coefficient).sqrt());
        state = rk4_step_unit(|x| model.derivative(x, &speeds), &state, step, 6);
    }
    let tracking = Tracking::new(plan, &states, record_every, step);
    Some(Flight { interval: step * record_every as f64, states, end: state, tracking })
}

/// The first motion, rotors turning as it needs them.
fn at_rest_on(vehicle: &Vehicle, first: &Motion) -> SVector<f64, 17> {
    let rigid = first.rigid_body_state();
    let coefficient = vehicle.thrust_coefficient();
    SVector::from_fn(|row, _| match row {
        0..13 => rigid[row],
        _ => (first.rotor_thrusts[row - 13].max(0.0) / coefficient).sqrt(),
    })
}

fn gust_model(plan: &[Motion], options: &SimulationOptions, seed: u64) -> Option<Dryden> {
    if options.gusts.norm() == 0.0 {
        return None;
    }
    let n = plan.len().max(1) as f64;
    let mean_height = plan.iter().map(|motion| motion.position.z).sum::<f64>() / n;
    let mean_speed = plan.iter().map(|motion| (motion.velocity - options.wind).norm()).sum::<f64>() / n;
    Some(Dryden::new(options.wind, options.gusts, mean_height, mean_speed, options.step, seed))
}

/// Flies the same plan once per seed; with the feature `rayon` on all cores, with the same results.
#[must_use]
pub fn simulate_batch(
    vehicle: &Vehicle,
    plan: &[Motion],
    options: &SimulationOptions,
    seeds: &[u64],
) -> Vec<Tracking> {
    let fly = |seed: &u64| simulate(vehicle, plan, options, *seed).map(|flight| flight.tracking);
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        seeds.par_iter().filter_map(fly).collect()
    }
    #[cfg(not(feature = "rayon"))]
    seeds.iter().filter_map(fly).collect()
}
