//! A vehicle's trajectory as a table: one row per sample.

use planner::{Circle, Phase, Sample};
use std::fmt::Write;

/// The header: quantity, component and unit of every column.
const HEADER: &str = "time_s,east_m,north_m,up_m,velocity_east_m_s,velocity_north_m_s,velocity_up_m_s,\
    acceleration_east_m_s2,acceleration_north_m_s2,acceleration_up_m_s2,attitude_w,attitude_x,attitude_y,attitude_z,\
    body_rate_x_rad_s,body_rate_y_rad_s,body_rate_z_rad_s,collective_thrust_N,target,phase\n";

/// The samples as CSV. `target` holds the number of the target that is flown to or around, several joined by `+` where
/// they are circled as one, nothing on the way back; `phase` is `pad`, `transition` or `loiter`.
#[must_use]
pub fn trajectory_csv(samples: &[Sample], circles: &[Circle]) -> String {
    let mut text = HEADER.to_owned();
    for sample in samples {
        let numbers = [sample.time].into_iter().chain(sample.position).chain(sample.velocity);
        let numbers = numbers.chain(sample.acceleration).chain(sample.attitude).chain(sample.body_rates);
        for number in numbers.chain([sample.collective_thrust]) {
            // Adding zero turns a negative zero into a plain one.
            let rounded = (number * 1e6).round() / 1e6 + 0.0;
            let _ = write!(text, "{rounded},");
        }
        let circle = sample.circle.and_then(|circle| circles.get(circle));
        let _ = writeln!(text, "{},{}", circle.map(members).unwrap_or_default(), phase_word(sample.phase));
    }
    text
}

/// The numbers of the targets that a circle serves.
#[must_use]
pub fn members(circle: &Circle) -> String {
    circle.members.iter().map(|member| (member + 1).to_string()).collect::<Vec<_>>().join("+")
}

fn phase_word(phase: Phase) -> &'static str {
    match phase {
        Phase::Transition => "transition",
        Phase::Loiter => "loiter",
        Phase::Pad => "pad",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_columns_of_the_header() {
        let sample = Sample {
            time: 0.05,
            position: [1.0, -2.0, 1.5],
            velocity: [-1e-9, 0.0, 0.25],
            acceleration: [0.0; 3],
            attitude: [1.0, 0.0, 0.0, 0.0],
            body_rates: [0.0; 3],
            collective_thrust: 14.715,
            phase: Phase::Pad,
            circle: None,
        };
        let text = trajectory_csv(&[sample], &[]);
        let mut lines = text.lines();
        assert_eq!(lines.next().map(|line| line.split(',').count()), Some(20));
        assert_eq!(lines.next(), Some("0.05,1,-2,1.5,0,0,0.25,0,0,0,1,0,0,0,0,0,0,14.715,,pad"));
    }
}
