//! From targets to circles: close targets are merged, and each circle gets the fastest loiter that its limits allow.

use crate::mission::{Mission, Model};
use crate::plan::Circle;
use crate::round::Round;
use quad_dynamics::LoiterSpec;

/// A circle with the loiter flown on it.
#[derive(Debug, Clone)]
pub(crate) struct Orbit {
    pub circle: Circle,
    pub loiter: Round,
}

/// The fastest loiter on a circle of `radius` (m) within the mission's limits.
pub(crate) fn loiter_of(mission: &Mission, radius: f64) -> Result<Round, quad_dynamics::Error> {
    let settings = &mission.loiter;
    let shaping = &mission.transition.shaping;
    // An autopilot that shapes transitions shapes circles too.
    let (speed, acceleration) = match mission.transition.model {
        Model::JerkLimited => (shaping.speed, shaping.acceleration),
        _ => (f64::INFINITY, f64::INFINITY),
    };
    let mut spec = LoiterSpec::new(radius)
        .with_thrust_budget(settings.thrust_budget)
        .with_yaw(settings.yaw)
        .with_sweep(settings.sweep);
    let finite = |limit: f64| limit.is_finite().then_some(limit);
    spec.speed_limit = finite(settings.speed_limit.min(speed));
    spec.acceleration_limit = finite(settings.acceleration_limit.min(acceleration));
    Round::new(&mission.fleet.vehicle, &spec, &mission.environment)
}

/// Groups of targets that are circled as one, by first member or as the mission gives them; without merging every target is a group of
/// its own.
///
/// Complete linkage cut at `merge_within`, so no group is wider than that.
pub(crate) fn groups(mission: &Mission) -> Vec<Vec<usize>> {
    if let Some(groups) = &mission.groups {
        return groups.clone();
    }
    let positions: Vec<[f64; 2]> = mission.targets.iter().map(|target| target.position).collect();
    let alone = || (0..positions.len()).map(|i| vec![i]).collect();
    if mission.merge_within == 0.0 {
        return alone();
    }
    cluster::merge_within(&positions, mission.merge_within)
        .map_or_else(|_| alone(), |partition| partition.clusters)
}

/// Centre, radius and height of the circle around a group: centred on the group's smallest enclosing circle, and so large
/// that it is at least a member's own circle radius away from that member, hence outside every safe distance.
pub(crate) fn geometry(mission: &Mission, members: &[usize]) -> ([f64; 2], f64, f64) {
    let positions: Vec<[f64; 2]> = members.iter().map(|&i| mission.targets[i].position).collect();
    let centre = match positions.as_slice() {
        [only] => *only,
        several => cluster::smallest_enclosing_circle(several).map_or(several[0], |ball| ball.centre),
    };
    let reach = |&i: &usize| {
        let [x, y] = mission.targets[i].position;
        (x - centre[0]).hypot(y - centre[1]) + mission.radius(i)
    };
    let radius = members.iter().map(reach).fold(0.0, f64::max);
    let height = members.iter().map(|&i| mission.height(i)).fold(0.0, f64::max);
    (centre, radius, height)
}

/// All circles of a mission with their loiters.
pub(crate) fn orbits(mission: &Mission) -> Result<Vec<Orbit>, quad_dynamics::Error> {
    // In wind a loiter takes milliseconds to find, and most circles are alike.
    let mut known: Vec<(f64, Round)> = Vec::new();
    let orbit = |members: Vec<usize>| {
        let (centre, radius, height) = geometry(mission, &members);
        let loiter = match known.iter().find(|(alike, _)| *alike == radius) {
            Some((_, loiter)) => loiter.clone(),
            None => loiter_of(mission, radius)?,
        };
        if mission.environment.is_windy() {
            known.push((radius, loiter.clone()));
        }
        let circle = Circle {
            members,
            centre,
            radius,
            height,
            sweep: mission.loiter.sweep,
            speed: loiter.speed(),
            limit: loiter.limit(),
            duration: loiter.duration(),
        };
        Ok(Orbit { circle, loiter })
    };
    groups(mission).into_iter().map(orbit).collect()
}
