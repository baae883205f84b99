//! Which vehicle takes a target, and the books of who has which.

use super::{Fleet, Space, TargetId, Vehicle, VehicleId};

/// Which vehicle takes a new target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Absorb {
    /// The one whose cluster is nearest (its centroid, where there are coordinates); the target waits for the next trip (Algorithm 3).
    NearestCluster,
    /// The one whose trip grows to the least length; the target joins the trip at once.
    CheapestInsertion,
}

impl<S: Space> Fleet<S> {
    /// Gives a target that has no vehicle to one.
    pub(super) fn absorb(&mut self, target: TargetId) {
        let Some(here) = self.targets.get(&target).map(|t| t.place.clone()) else { return };
        let chosen = match self.absorb {
            Absorb::NearestCluster => self.nearest_cluster(&here).map(|vehicle| (vehicle, None)),
            Absorb::CheapestInsertion => self.cheapest_insertion(&here).map(|(v, place)| (v, Some(place))),
        };
        let Some((vehicle, place)) = chosen else { return self.unassigned.push(target) };
        self.give(target, vehicle);
        let waits = self.targets.get(&target).is_some_and(|t| !t.visited);
        if let (Some(flying), Some(place), true) = (self.vehicles.get_mut(&vehicle), place, waits) {
            flying.trip.insert(place, target);
        }
    }

    /// The vehicle whose cluster (position, while it has no targets) is nearest; the first on ties.
    fn nearest_cluster(&self, here: &S::Place) -> Option<VehicleId> {
        let distance = |vehicle: &Vehicle<S::Place>| {
            let mut members: Vec<S::Place> = self.places(&vehicle.cluster).collect();
            if members.is_empty() {
                members.push(vehicle.position.clone());
            }
            self.space.distance_to_cluster(here, &members)
        };
        let distances = self.vehicles.iter().map(|(id, vehicle)| (distance(vehicle), *id));
        distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|nearest| nearest.1)
    }

    /// The vehicle and place in its trip where the trip grows to the least length.
    fn cheapest_insertion(&self, here: &S::Place) -> Option<(VehicleId, usize)> {
        let mut best: Option<(f64, VehicleId, usize)> = None;
        for (&id, vehicle) in &self.vehicles {
            let path: Vec<S::Place> =
                std::iter::once(vehicle.position.clone()).chain(self.places(&vehicle.trip)).collect();
            let length: f64 = path.windows(2).map(|leg| self.space.distance(&leg[0], &leg[1])).sum();
            for place in 0..path.len() {
                let mut added = self.space.distance(&path[place], here);
                if let Some(next) = path.get(place + 1) {
                    added += self.space.distance(here, next) - self.space.distance(&path[place], next);
                }
                if best.is_none_or(|b| length + added < b.0) {
                    best = Some((length + added, id, place));
                }
            }
        }
        best.map(|(_, id, place)| (id, place))
    }

    pub(super) fn give(&mut self, target: TargetId, vehicle: VehicleId) {
        if let Some(vehicle) = self.vehicles.get_mut(&vehicle) {
            let place = vehicle.cluster.partition_point(|t| *t < target);
            vehicle.cluster.insert(place, target);
        }
    }

    /// Takes a target from its vehicle.
    pub(super) fn release(&mut self, target: TargetId) {
        self.unassigned.retain(|t| *t != target);
        for vehicle in self.vehicles.values_mut() {
            if let Ok(place) = vehicle.cluster.binary_search(&target) {
                vehicle.cluster.remove(place);
                vehicle.trip.retain(|t| *t != target);
            }
        }
    }
}
