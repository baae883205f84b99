//! A fleet under way: targets appear, vanish and move, vehicles join and drop out.
//!
//! Gao, Mandal, Bhattacharya (2020), Algorithm 3. Each vehicle has a cluster of targets and a trip through those that wait. A new target is
//! absorbed by the vehicle with the nearest cluster, or by the cheapest insertion. When its trip ends a vehicle tours its
//! cluster again from where it is, without going home first.

use crate::error::Error;
use christofides::{Ends, Matrix, Path, improve_path};
use std::collections::BTreeMap;

/// Handle of a target; never used twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TargetId(usize);

/// Handle of a vehicle; never used twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VehicleId(usize);

/// What a later round visits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Revisit {
    /// All targets of the cluster again and again: persistent surveillance, as in the paper.
    All,
    /// Only targets not visited yet.
    NewOnly,
}

/// Which vehicle takes a new target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Absorb {
    /// The one whose cluster's centroid is nearest; the target waits for the next trip (Algorithm 3).
    NearestCluster,
    /// The one whose trip grows to the least length; the target joins the trip at once.
    CheapestInsertion,
}

#[derive(Debug, Clone)]
struct Target {
    position: [f64; 2],
    visited: bool,
}

#[derive(Debug, Clone)]
struct Vehicle {
    position: [f64; 2],
    /// All targets that are this vehicle's, ascending.
    cluster: Vec<TargetId>,
    /// Targets of the current trip that are still to be visited, in order.
    trip: Vec<TargetId>,
    /// Sum of the positions of the cluster.
    sum: [f64; 2],
}

/// Vehicles somewhere along their trips, and the targets they look after. Positions in metres in the plane.
///
/// # Guarantee
/// Every target belongs to exactly one vehicle while there is one (else it waits unassigned and is taken by the first that
/// joins). No waiting target is lost: it is in its vehicle's trip or will be in the next one. Under [`Revisit::NewOnly`] no
/// target is visited twice. Events with unknown handles or positions that are not finite change nothing and are errors.
#[derive(Debug, Clone)]
pub struct Fleet {
    revisit: Revisit,
    absorb: Absorb,
    targets: BTreeMap<TargetId, Target>,
    vehicles: BTreeMap<VehicleId, Vehicle>,
    unassigned: Vec<TargetId>,
    next_target: usize,
    next_vehicle: usize,
}

impl Fleet {
    /// A fleet without vehicles and targets.
    #[must_use]
    pub fn new(revisit: Revisit, absorb: Absorb) -> Self {
        let (targets, vehicles) = (BTreeMap::new(), BTreeMap::new());
        Self { revisit, absorb, targets, vehicles, unassigned: vec![], next_target: 0, next_vehicle: 0 }
    }

    /// A vehicle joins at a position; it takes the targets that no vehicle has.
    ///
    /// # Errors
    /// [`Error::NonFinitePosition`].
    pub fn join(&mut self, position: [f64; 2]) -> Result<VehicleId, Error> {
        finite(position)?;
        let id = VehicleId(self.next_vehicle);
        self.next_vehicle += 1;
        self.vehicles.insert(id, Vehicle { position, cluster: vec![], trip: vec![], sum: [0.0; 2] });
        for target in std::mem::take(&mut self.unassigned) {
            self.give(target, id);
        }
        Ok(id)
    }

    /// A vehicle drops out; the others absorb its targets, as new ones.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`].
    pub fn drop_out(&mut self, vehicle: VehicleId) -> Result<(), Error> {
        let lost = self.vehicles.remove(&vehicle).ok_or(Error::UnknownVehicleId { vehicle })?;
        for target in lost.cluster {
            self.absorb(target);
        }
        Ok(())
    }

    /// A target appears and is absorbed.
    ///
    /// # Errors
    /// [`Error::NonFinitePosition`].
    ///
    /// # Complexity
    /// O(m) for the nearest cluster, O(targets in trips) for the cheapest insertion.
    pub fn appear(&mut self, position: [f64; 2]) -> Result<TargetId, Error> {
        finite(position)?;
        let id = TargetId(self.next_target);
        self.next_target += 1;
        self.targets.insert(id, Target { position, visited: false });
        self.absorb(id);
        Ok(id)
    }

    /// A target vanishes, visited or not.
    ///
    /// # Errors
    /// [`Error::UnknownTargetId`].
    pub fn vanish(&mut self, target: TargetId) -> Result<(), Error> {
        if !self.targets.contains_key(&target) {
            return Err(Error::UnknownTargetId { target });
        }
        self.release(target);
        self.targets.remove(&target);
        Ok(())
    }

    /// A target moves and is absorbed anew; whether it was visited stays.
    ///
    /// # Errors
    /// [`Error::UnknownTargetId`], [`Error::NonFinitePosition`].
    pub fn shift(&mut self, target: TargetId, position: [f64; 2]) -> Result<(), Error> {
        finite(position)?;
        if !self.targets.contains_key(&target) {
            return Err(Error::UnknownTargetId { target });
        }
        self.release(target);
        if let Some(moved) = self.targets.get_mut(&target) {
            moved.position = position;
        }
        self.absorb(target);
        Ok(())
    }

    /// The vehicle flies to the next target of its trip and visits it; a new trip is made first if the last one has ended.
    /// None if nothing waits for this vehicle.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`]; [`Error::Tour`] if positions are so far apart that their distance overflows.
    pub fn visit_next(&mut self, vehicle: VehicleId) -> Result<Option<TargetId>, Error> {
        if self.trip(vehicle)?.is_empty() {
            self.retour(vehicle)?;
        }
        let flying = self.vehicles.get_mut(&vehicle).ok_or(Error::UnknownVehicleId { vehicle })?;
        if flying.trip.is_empty() {
            return Ok(None);
        }
        let next = flying.trip.remove(0);
        if let Some(target) = self.targets.get_mut(&next) {
            flying.position = target.position;
            target.visited = true;
        }
        Ok(Some(next))
    }

    /// Makes the vehicle's trip anew from where it is: all of its cluster, or what is not visited yet, by [`Revisit`].
    /// Done when a trip ends; call it to have waiting targets in the trip at once.
    ///
    /// Nearest neighbours, then 2-opt and Or-opt with the start fixed (an open trip, no return to the depot).
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`]; [`Error::Tour`] if positions are so far apart that their distance overflows.
    pub fn retour(&mut self, vehicle: VehicleId) -> Result<(), Error> {
        let flying = self.vehicles.get(&vehicle).ok_or(Error::UnknownVehicleId { vehicle })?;
        let again = self.revisit == Revisit::All && flying.trip.is_empty();
        let waits = |t: &&TargetId| {
            let visited = self.targets.get(t).is_some_and(|target| target.visited);
            again || !visited || flying.trip.contains(t)
        };
        let waiting: Vec<TargetId> = flying.cluster.iter().filter(waits).copied().collect();
        let mut places = vec![flying.position];
        places.extend(waiting.iter().filter_map(|t| self.targets.get(t)).map(|t| t.position));
        let order = open_trip(&places)?;
        let trip = order[1..].iter().map(|&i| waiting[i - 1]).collect();
        if let Some(flying) = self.vehicles.get_mut(&vehicle) {
            flying.trip = trip;
        }
        Ok(())
    }

    /// The vehicles, in the order in which they joined.
    pub fn vehicles(&self) -> impl Iterator<Item = VehicleId> + '_ {
        self.vehicles.keys().copied()
    }

    /// The targets still to be visited on the vehicle's current trip, in order.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`].
    pub fn trip(&self, vehicle: VehicleId) -> Result<&[TargetId], Error> {
        self.vehicles.get(&vehicle).map(|v| v.trip.as_slice()).ok_or(Error::UnknownVehicleId { vehicle })
    }

    /// The targets that are the vehicle's, ascending.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`].
    pub fn cluster(&self, vehicle: VehicleId) -> Result<&[TargetId], Error> {
        self.vehicles.get(&vehicle).map(|v| v.cluster.as_slice()).ok_or(Error::UnknownVehicleId { vehicle })
    }

    /// Where the vehicle is: at the last target visited, or where it joined.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`].
    pub fn position(&self, vehicle: VehicleId) -> Result<[f64; 2], Error> {
        self.vehicles.get(&vehicle).map(|v| v.position).ok_or(Error::UnknownVehicleId { vehicle })
    }

    /// Targets that no vehicle has, because there is none.
    #[must_use]
    pub fn unassigned(&self) -> &[TargetId] {
        &self.unassigned
    }

    /// Whether a target has been visited; none if it does not exist.
    #[must_use]
    pub fn is_visited(&self, target: TargetId) -> Option<bool> {
        self.targets.get(&target).map(|t| t.visited)
    }

    /// Gives a target that has no vehicle to one.
    fn absorb(&mut self, target: TargetId) {
        let Some(here) = self.targets.get(&target).map(|t| t.position) else { return };
        match self.absorb {
            Absorb::NearestCluster => match self.nearest_cluster(here) {
                Some(vehicle) => self.give(target, vehicle),
                None => self.unassigned.push(target),
            },
            Absorb::CheapestInsertion => match self.cheapest_insertion(here) {
                Some((vehicle, place)) => {
                    self.give(target, vehicle);
                    let waits = self.targets.get(&target).is_some_and(|t| !t.visited);
                    if let Some(flying) = self.vehicles.get_mut(&vehicle).filter(|_| waits) {
                        flying.trip.insert(place, target);
                    }
                }
                None => self.unassigned.push(target),
            },
        }
    }

    /// The vehicle whose centroid (position, while it has no targets) is nearest; the first on ties.
    fn nearest_cluster(&self, here: [f64; 2]) -> Option<VehicleId> {
        let centre = |v: &Vehicle| match v.cluster.len() {
            0 => v.position,
            n => v.sum.map(|x| x / n as f64),
        };
        let nearer = |a: &(&VehicleId, &Vehicle), b: &(&VehicleId, &Vehicle)| {
            distance(centre(a.1), here).total_cmp(&distance(centre(b.1), here))
        };
        self.vehicles.iter().min_by(nearer).map(|(id, _)| *id)
    }

    /// The vehicle and place in its trip where the trip grows to the least length.
    fn cheapest_insertion(&self, here: [f64; 2]) -> Option<(VehicleId, usize)> {
        let mut best: Option<(f64, VehicleId, usize)> = None;
        for (&id, vehicle) in &self.vehicles {
            let stops = vehicle.trip.iter().filter_map(|t| self.targets.get(t)).map(|t| t.position);
            let path: Vec<[f64; 2]> = std::iter::once(vehicle.position).chain(stops).collect();
            let length: f64 = path.windows(2).map(|leg| distance(leg[0], leg[1])).sum();
            for place in 0..path.len() {
                let mut added = distance(path[place], here);
                if let Some(&next) = path.get(place + 1) {
                    added += distance(here, next) - distance(path[place], next);
                }
                if best.is_none_or(|b| length + added < b.0) {
                    best = Some((length + added, id, place));
                }
            }
        }
        best.map(|(_, id, place)| (id, place))
    }

    fn give(&mut self, target: TargetId, vehicle: VehicleId) {
        let Some(here) = self.targets.get(&target).map(|t| t.position) else { return };
        if let Some(vehicle) = self.vehicles.get_mut(&vehicle) {
            let place = vehicle.cluster.partition_point(|t| *t < target);
            vehicle.cluster.insert(place, target);
            vehicle.sum = [vehicle.sum[0] + here[0], vehicle.sum[1] + here[1]];
        }
    }

    /// Takes a target from its vehicle.
    fn release(&mut self, target: TargetId) {
        let Some(here) = self.targets.get(&target).map(|t| t.position) else { return };
        self.unassigned.retain(|t| *t != target);
        for vehicle in self.vehicles.values_mut() {
            if let Ok(place) = vehicle.cluster.binary_search(&target) {
                vehicle.cluster.remove(place);
                vehicle.trip.retain(|t| *t != target);
                vehicle.sum = [vehicle.sum[0] - here[0], vehicle.sum[1] - here[1]];
            }
        }
    }
}

/// A short order through all places that starts at the first.
fn open_trip(places: &[[f64; 2]]) -> Result<Vec<usize>, Error> {
    let n = places.len();
    let mut order = vec![0];
    let mut left: Vec<usize> = (1..n).collect();
    while let Some(&here) = order.last() {
        let nearest = (0..left.len()).min_by(|&a, &b| {
            distance(places[here], places[left[a]]).total_cmp(&distance(places[here], places[left[b]]))
        });
        match nearest {
            Some(position) => order.push(left.remove(position)),
            None => break,
        }
    }
    if n < 4 {
        return Ok(order);
    }
    let distances = places.iter().flat_map(|a| places.iter().map(|b| distance(*a, *b))).collect();
    let matrix = Matrix::symmetric(n, distances)?;
    let path = improve_path(&matrix, Path::new(&matrix, order)?, Ends::Start(0))?;
    Ok(path.into_order())
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn finite(position: [f64; 2]) -> Result<(), Error> {
    match position.iter().position(|x| !x.is_finite()) {
        Some(axis) => Err(Error::NonFinitePosition { axis }),
        None => Ok(()),
    }
}
