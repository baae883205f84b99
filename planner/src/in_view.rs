//! What the camera sees of the targets while they are circled.

use crate::airs::Airs;
use crate::mission::Mission;
use crate::plan::Plan;
use nalgebra::Vector3;

/// Moments of a loiter that are looked at: the share is known to within a few of them.
const N_MOMENTS: usize = 720;

impl Plan {
    /// For every target the share of the loiter around it during which it is in the picture, by the attitude in which the loiter is
    /// planned: in wind it changes on the way round. 0 for a target that nobody circles; of several loiters the best counts.
    ///
    /// Looked at in 720 moments. `None` if the mission has no camera, or is not the one that was planned.
    #[must_use]
    pub fn shares_in_view(&self, mission: &Mission) -> Option<Vec<f64>> {
        let settings = mission.camera?;
        let airs = Airs::new(self, mission);
        airs.fit(self).then_some(())?;
        let mut shares = vec![0.0_f64; mission.targets.len()];
        for leg in self.vehicles.iter().flat_map(|planned| &planned.legs) {
            let Some(loiter) = leg.loiter else { continue };
            let orbit = airs.at(leg.start_time).orbits.get(loiter.circle)?;
            let step = loiter.duration / N_MOMENTS as f64;
            let moments = (0..N_MOMENTS).map(|i| orbit.after(loiter.entry, (i as f64 + 0.5) * step));
            let motions: Vec<_> = moments.collect();
            for &member in &orbit.circle.members {
                let [east, north] = mission.targets[member].position;
                let target = Vector3::new(east, north, settings.target_height);
                let seen = motions.iter().filter(|motion| settings.camera.view(motion, &target).in_view);
                shares[member] = shares[member].max(seen.count() as f64 / N_MOMENTS as f64);
            }
        }
        Some(shares)
    }
}
