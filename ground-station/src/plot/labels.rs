//! Labels that keep out of each other's way.

/// A box on the paper (px).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Left, top.
    pub low: [f64; 2],
    /// Right, bottom.
    pub high: [f64; 2],
}

impl Area {
    /// The box of a size around a middle.
    #[must_use]
    pub fn around(middle: [f64; 2], size: [f64; 2]) -> Self {
        Self {
            low: [middle[0] - size[0] / 2.0, middle[1] - size[1] / 2.0],
            high: [middle[0] + size[0] / 2.0, middle[1] + size[1] / 2.0],
        }
    }

    /// The box without a rim.
    #[must_use]
    pub fn shrunk(&self, rim: f64) -> Self {
        Self { low: self.low.map(|low| low + rim), high: self.high.map(|high| high - rim) }
    }

    /// The area that two boxes share (px^2).
    #[must_use]
    pub fn overlap(&self, other: &Self) -> f64 {
        let side = |axis: usize| {
            let low = self.low[axis].max(other.low[axis]);
            (self.high[axis].min(other.high[axis]) - low).max(0.0)
        };
        side(0) * side(1)
    }

    fn contains(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }
}

/// Places labels one after the other, each where it covers least.
#[derive(Debug, Clone, Default)]
pub struct Labels {
    taken: Vec<Area>,
    lines: Vec<[f64; 2]>,
    paper: Option<Area>,
}

impl Labels {
    /// On a sheet that labels should not leave.
    #[must_use]
    pub fn on(paper: Area) -> Self {
        Self { paper: Some(paper), ..Self::default() }
    }

    /// Marks something that no label should cover.
    pub fn take(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// Marks lines that labels should cover only where nothing else is free: points a few px apart.
    pub fn avoid(&mut self, line: &[[f64; 2]]) {
        for pair in line.windows(2) {
            let length = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            let steps = (length / 3.0).ceil().clamp(1.0, 1000.0) as usize;
            for step in 0..steps {
                let share = step as f64 / steps as f64;
                self.lines.push([0, 1].map(|axis| pair[0][axis] + share * (pair[1][axis] - pair[0][axis])));
            }
        }
    }

    /// The middle of a label of the given size beside a point, `gap` px away from it, and marks it as taken.
    pub fn place(&mut self, point: [f64; 2], gap: f64, size: [f64; 2]) -> [f64; 2] {
        // The customary order of cartographers: upper right first.
        const SIDES: [[f64; 2]; 8] = [
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, -1.0],
            [-1.0, 1.0],
            [1.0, 0.0],
            [-1.0, 0.0],
            [0.0, -1.0],
            [0.0, 1.0],
        ];
        let mut best = (f64::INFINITY, point);
        for side in SIDES {
            let reach = if side[0] * side[1] == 0.0 { gap } else { gap * std::f64::consts::FRAC_1_SQRT_2 };
            let middle = [0, 1].map(|axis| point[axis] + side[axis] * (reach + size[axis] / 2.0));
            let cost = self.cost(&Area::around(middle, size));
            if cost < best.0 {
                best = (cost, middle);
            }
        }
        self.take(Area::around(best.1, size));
        best.1
    }

    fn cost(&self, area: &Area) -> f64 {
        let covered: f64 = self.taken.iter().map(|other| area.overlap(other)).sum();
        let crossed = self.lines.iter().filter(|&&point| area.contains(point)).count();
        let inside = self.paper.map_or(f64::INFINITY, |paper| paper.overlap(area));
        let whole = (area.high[0] - area.low[0]) * (area.high[1] - area.low[1]);
        covered + 2.0 * crossed as f64 + 10.0 * (whole - inside).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_one_point_do_not_overlap() {
        let mut labels = Labels::on(Area { low: [0.0; 2], high: [100.0; 2] });
        let size = [20.0, 10.0];
        let middles: Vec<[f64; 2]> = (0..4).map(|_| labels.place([50.0, 50.0], 4.0, size)).collect();
        for (index, &a) in middles.iter().enumerate() {
            for &b in &middles[..index] {
                assert_eq!(Area::around(a, size).overlap(&Area::around(b, size)), 0.0);
            }
        }
    }

    #[test]
    fn labels_stay_on_the_paper_and_off_lines() {
        let mut labels = Labels::on(Area { low: [0.0; 2], high: [100.0; 2] });
        let middle = labels.place([99.0, 1.0], 3.0, [20.0, 10.0]);
        assert!(middle[0] < 90.0 && middle[1] > 5.0, "{middle:?}");
        labels.avoid(&[[50.0, 50.0], [100.0, 0.0]]);
        let middle = labels.place([50.0, 50.0], 3.0, [20.0, 10.0]);
        assert!(!(middle[0] > 50.0 && middle[1] < 50.0), "{middle:?}");
    }
}
