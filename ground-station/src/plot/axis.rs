//! Round numbers for axes and scale bars.

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is at least `length`.
#[must_use]
pub fn round_step(length: f64) -> f64 {
    if !(length.is_finite() && length > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(length.log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0];
    // A hair of slack, so that a length that is itself round stays.
    steps
        .into_iter()
        .map(|step| step * power)
        .find(|step| *step >= length * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Ticks from `low` to `high`, about `count` of them, at multiples of a round step.
#[must_use]
pub fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    if !(low.is_finite() && high.is_finite() && high > low) {
        return Vec::new();
    }
    let step = round_step((high - low) / count.max(1) as f64);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|index| index as f64 * step).collect()
}

/// A tick's number with the decimals that its step needs and no more.
#[must_use]
pub fn tick_label(value: f64, ticks: &[f64]) -> String {
    let step = ticks.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(1.0);
    let decimals = (0..6).find(|&digits| {
        let scaled = step * 10f64.powi(digits);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
    });
    let text = format!("{value:.*}", decimals.unwrap_or(6) as usize);
    if text.trim_start_matches('-').chars().all(|digit| matches!(digit, '0' | '.')) {
        "0".into()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_ticks_cover() {
        for (length, step) in
            [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (2.2, 2.5), (3.0, 5.0), (7.0, 10.0), (0.03, 0.05)]
        {
            assert!((round_step(length) - step).abs() < 1e-12, "{length}");
        }
        assert_eq!(ticks(0.0, 10.0, 5), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-3.0, 3.0, 6), [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]);
        assert!(ticks(1.0, 1.0, 5).is_empty() && ticks(f64::NAN, 1.0, 5).is_empty());
        assert_eq!(round_step(0.0), 1.0);
    }

    #[test]
    fn labels_have_the_decimals_of_the_step() {
        let fine = ticks(0.0, 1.0, 4);
        assert_eq!(
            fine.iter().map(|&tick| tick_label(tick, &fine)).collect::<Vec<_>>(),
            ["0", "0.25", "0.50", "0.75", "1.00"]
        );
        assert_eq!(tick_label(20.0, &[0.0, 10.0, 20.0]), "20");
    }
}
