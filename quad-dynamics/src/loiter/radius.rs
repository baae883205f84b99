//! Choosing the radius.

use super::{Loiter, LoiterSpec};
use crate::error::{Error, Field, Requirement};
use crate::vehicle::Vehicle;

impl Loiter {
    /// The loiter on the smallest circle that can be flown at a wanted speed (m/s) within the limits of `spec`, whose own
    /// radius is ignored.
    ///
    /// The greatest speed grows with the radius under every limit but the speed's own, so a bisection over radii up to 1e6 m
    /// finds it, to 1e-12 of the radius.
    ///
    /// # Errors
    /// As [`Loiter::new`]; [`Error::SpeedAboveLimit`] if no radius allows the speed (drag or the speed limit).
    pub fn with_speed(vehicle: &Vehicle, spec: &LoiterSpec, speed: f64) -> Result<Self, Error> {
        Requirement::Positive.check(Field::Speed, speed)?;
        let widest = Self::new(vehicle, &at(spec, GREATEST_RADIUS))?;
        if let (true, Some(limit)) = (widest.speed < speed, widest.limit) {
            return Err(Error::SpeedAboveLimit { speed, allowed: widest.speed, limit });
        }
        let enough = |loiter: &Self| loiter.speed >= speed;
        let radius = bisect(vehicle, spec, enough)?;
        Self::at_speed(vehicle, &at(spec, radius), speed)
    }

    /// The largest circle that can be flown once in a wanted period (s) within the limits of `spec`, whose own radius is
    /// ignored; flown in exactly that period.
    ///
    /// # Errors
    /// As [`Loiter::new`]; [`Error::OutOfRange`] for a period so short or so long that no radius from 1 mm to 1000 km has it.
    pub fn with_period(vehicle: &Vehicle, spec: &LoiterSpec, period: f64) -> Result<Self, Error> {
        Requirement::Positive.check(Field::Period, period)?;
        let period_at = |radius: f64| Self::new(vehicle, &at(spec, radius)).map(|loiter| loiter.period());
        // From above: small circles may take longer again, where the yaw rate binds.
        let longest = period_at(GREATEST_RADIUS)?;
        let (mut shortest, mut high, mut low) = (longest, GREATEST_RADIUS, None);
        for i in (0..N_SCAN).rev() {
            let radius = LEAST_RADIUS * (GREATEST_RADIUS / LEAST_RADIUS).powf(i as f64 / N_SCAN as f64);
            let found = period_at(radius)?;
            shortest = shortest.min(found);
            if found <= period {
                low = Some(radius);
                break;
            }
            high = radius;
        }
        let range = Requirement::From { low: shortest, high: longest };
        let Some(mut low) = low.filter(|_| period < longest) else {
            return Err(Error::OutOfRange { field: Field::Period, value: period, requirement: range });
        };
        for _ in 0..N_BISECTIONS {
            let middle = (low * high).sqrt();
            if period_at(middle)? <= period {
                low = middle;
            } else {
                high = middle;
            }
        }
        let speed = (std::f64::consts::TAU * low / period).min(Self::new(vehicle, &at(spec, low))?.speed);
        Self::at_speed(vehicle, &at(spec, low), speed)
    }

    /// The loiter with the shortest period among radii from `low` to `high` (m).
    ///
    /// Small circles are short but slow. A scan of 200 radii in equal ratios, refined by golden section around the best.
    ///
    /// # Errors
    /// As [`Loiter::new`]; [`Error::OutOfRange`] unless `0 < low <= high`.
    pub fn quickest(vehicle: &Vehicle, spec: &LoiterSpec, low: f64, high: f64) -> Result<Self, Error> {
        const N_RADII: usize = 200;
        Requirement::Positive.check(Field::Radius, low)?;
        Requirement::From { low, high: f64::INFINITY }.check(Field::Radius, high)?;
        let radius = |share: f64| low * (high / low).powf(share);
        let period = |share: f64| Self::new(vehicle, &at(spec, radius(share))).map(|loiter| loiter.period());
        let mut best = (f64::INFINITY, 0.0);
        for i in 0..=N_RADII {
            let share = i as f64 / N_RADII as f64;
            let period = period(share)?;
            if period < best.0 {
                best = (period, share);
            }
        }
        let step = 1.0 / N_RADII as f64;
        let (mut left, mut right) = ((best.1 - step).max(0.0), (best.1 + step).min(1.0));
        for _ in 0..60 {
            let third = (right - left) / 3.0;
            if period(left + third)? <= period(right - third)? {
                right -= third;
            } else {
                left += third;
            }
        }
        let refined = 0.5 * (left + right);
        let share = if period(refined)? < best.0 { refined } else { best.1 };
        Self::new(vehicle, &at(spec, radius(share)))
    }
}

const N_SCAN: usize = 400;
const N_BISECTIONS: usize = 80;
const LEAST_RADIUS: f64 = 1e-3;
const GREATEST_RADIUS: f64 = 1e6;

fn at(spec: &LoiterSpec, radius: f64) -> LoiterSpec {
    LoiterSpec { radius, ..*spec }
}

/// The least radius for which `reached` holds, if it holds from there on.
fn bisect(vehicle: &Vehicle, spec: &LoiterSpec, reached: impl Fn(&Loiter) -> bool) -> Result<f64, Error> {
    let (mut low, mut high) = (LEAST_RADIUS, GREATEST_RADIUS);
    for _ in 0..N_BISECTIONS {
        let middle = (low * high).sqrt();
        if reached(&Loiter::new(vehicle, &at(spec, middle))?) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}
