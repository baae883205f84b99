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
        let (mut shortest, mut before, mut was_falling) = (longest, longest, false);
        let [mut last, mut second_last] = [GREATEST_RADIUS; 2];
        // A radius that is quick enough, and a greater one that is not.
        let mut bracket = None;
        for i in (0..N_SCAN).rev() {
            let radius = LEAST_RADIUS * (GREATEST_RADIUS / LEAST_RADIUS).powf(i as f64 / N_SCAN as f64);
            let here = period_at(radius)?;
            // Where periods begin to rise again, the shortest one lies between two radii of the scan.
            let ((found, place), above) = match here > before && was_falling && here > period {
                true => (least(period_at, radius, second_last)?, second_last),
                false => ((here, radius), last),
            };
            shortest = shortest.min(found);
            if found <= period {
                bracket = Some((place, above));
                break;
            }
            (was_falling, before) = (here < before, here);
            [second_last, last] = [last, radius];
        }
        let range = Requirement::From { low: shortest, high: longest };
        let Some((mut low, mut high)) = bracket.filter(|_| period < longest) else {
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
    /// Small circles are short but slow. A scan of 200 radii in equal ratios, refined by thirds around the best.
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
        let (shortest, refined) = least(period, (best.1 - step).max(0.0), (best.1 + step).min(1.0))?;
        let share = if shortest < best.0 { refined } else { best.1 };
        Self::new(vehicle, &at(spec, radius(share)))
    }
}

const N_SCAN: usize = 400;
const N_BISECTIONS: usize = 80;
const N_THIRDS: usize = 60;
const LEAST_RADIUS: f64 = 1e-3;
const GREATEST_RADIUS: f64 = 1e6;

fn at(spec: &LoiterSpec, radius: f64) -> LoiterSpec {
    LoiterSpec { radius, ..*spec }
}

/// The least value of a function that falls and then rises between two places, and where it has it.
fn least(of: impl Fn(f64) -> Result<f64, Error>, mut left: f64, mut right: f64) -> Result<(f64, f64), Error> {
    for _ in 0..N_THIRDS {
        let third = (right - left) / 3.0;
        if of(left + third)? <= of(right - third)? {
            right -= third;
        } else {
            left += third;
        }
    }
    let place = 0.5 * (left + right);
    Ok((of(place)?, place))
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
