//! A fleet under way: targets appear, vanish and move, vehicles join and drop out.
//!
//! Gao, Mandal, Bhattacharya (2020), Algorithm 3. Each vehicle has a cluster of targets and a trip through those that wait. A new target is
//! absorbed by the vehicle with the nearest cluster, or by the cheapest insertion. When its trip ends a vehicle tours its
//! cluster again from where it is, without going home first.

mod absorb;
mod space;
mod trip;

pub use absorb::Absorb;
pub use space::{Euclidean, Nodes, Space};

use crate::error::Error;
use std::collections::BTreeMap;
use trip::open_trip;

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

#[derive(Debug, Clone)]
struct Target<P> {
    place: P,
    visited: bool,
}

#[derive(Debug, Clone)]
struct Vehicle<P> {
    position: P,
    /// All targets that are this vehicle's, ascending.
    cluster: Vec<TargetId>,
    /// Targets of the current trip that are still to be visited, in order.
    trip: Vec<TargetId>,
}

/// Vehicles somewhere along their trips, and the targets they look after: points of the plane, or places of any other [`Space`], as
/// [`Nodes`] of a [`Metric`](christofides::Metric).
///
/// # Guarantee
/// Every target belongs to exactly one vehicle while there is one (else it waits unassigned and is taken by the first that
/// joins). No waiting target is lost: it is in its vehicle's trip or will be in the next one. Under [`Revisit::NewOnly`] no
/// target is visited twice. Events with unknown handles or places that the space refuses change nothing and are errors.
///
/// # Examples
/// ```
/// use christofides::FromFn;
/// use mtsp::{Absorb, Fleet, Nodes, Revisit};
///
/// let street = FromFn::metric(100, |a, b| a.abs_diff(b) as f64);
/// let mut fleet = Fleet::over(Nodes(street), Revisit::NewOnly, Absorb::CheapestInsertion);
/// let vehicle = fleet.join(50)?;
/// let (near, far) = (fleet.appear(45)?, fleet.appear(20)?);
/// assert_eq!(fleet.visit_next(vehicle)?, Some(near));
/// assert_eq!(fleet.trip(vehicle)?, [far]);
/// # Ok::<(), mtsp::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fleet<S: Space = Euclidean<2>> {
    space: S,
    revisit: Revisit,
    absorb: Absorb,
    targets: BTreeMap<TargetId, Target<S::Place>>,
    vehicles: BTreeMap<VehicleId, Vehicle<S::Place>>,
    unassigned: Vec<TargetId>,
    next_target: usize,
    next_vehicle: usize,
}

impl Fleet {
    /// A fleet in the plane without vehicles and targets.
    #[must_use]
    pub fn new(revisit: Revisit, absorb: Absorb) -> Self {
        Self::over(Euclidean, revisit, absorb)
    }
}

impl<S: Space> Fleet<S> {
    /// A fleet in any space without vehicles and targets.
    #[must_use]
    pub fn over(space: S, revisit: Revisit, absorb: Absorb) -> Self {
        let (targets, vehicles) = (BTreeMap::new(), BTreeMap::new());
        Self {
            space,
            revisit,
            absorb,
            targets,
            vehicles,
            unassigned: vec![],
            next_target: 0,
            next_vehicle: 0,
        }
    }

    /// A vehicle joins at a position; it takes the targets that no vehicle has.
    ///
    /// # Errors
    /// Those of [`Space::check`]: [`Error::NonFinitePosition`] for points.
    pub fn join(&mut self, position: S::Place) -> Result<VehicleId, Error> {
        self.space.check(&position)?;
        let id = VehicleId(self.next_vehicle);
        self.next_vehicle += 1;
        self.vehicles.insert(id, Vehicle { position, cluster: vec![], trip: vec![] });
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
    /// Those of [`Space::check`]: [`Error::NonFinitePosition`] for points.
    ///
    /// # Complexity
    /// O(targets), for the cheapest insertion O(targets in trips).
    pub fn appear(&mut self, place: S::Place) -> Result<TargetId, Error> {
        self.space.check(&place)?;
        let id = TargetId(self.next_target);
        self.next_target += 1;
        self.targets.insert(id, Target { place, visited: false });
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
    /// [`Error::UnknownTargetId`]; those of [`Space::check`].
    pub fn shift(&mut self, target: TargetId, place: S::Place) -> Result<(), Error> {
        self.space.check(&place)?;
        if !self.targets.contains_key(&target) {
            return Err(Error::UnknownTargetId { target });
        }
        self.release(target);
        if let Some(moved) = self.targets.get_mut(&target) {
            moved.place = place;
        }
        self.absorb(target);
        Ok(())
    }

    /// The vehicle flies to the next target of its trip and visits it; a new trip is made first if the last one has ended.
    /// None if nothing waits for this vehicle.
    ///
    /// # Errors
    /// [`Error::UnknownVehicleId`]; [`Error::Tour`] if a distance is not finite or differs by direction.
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
            flying.position = target.place.clone();
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
    /// [`Error::UnknownVehicleId`]; [`Error::Tour`] if a distance is not finite or differs by direction.
    pub fn retour(&mut self, vehicle: VehicleId) -> Result<(), Error> {
        let flying = self.vehicles.get(&vehicle).ok_or(Error::UnknownVehicleId { vehicle })?;
        let again = self.revisit == Revisit::All && flying.trip.is_empty();
        let waits = |t: &&TargetId| {
            let visited = self.targets.get(t).is_some_and(|target| target.visited);
            again || !visited || flying.trip.contains(t)
        };
        let waiting: Vec<TargetId> = flying.cluster.iter().filter(waits).copied().collect();
        let mut places = vec![flying.position.clone()];
        places.extend(self.places(&waiting));
        let order = open_trip(&self.space, &places)?;
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
    pub fn position(&self, vehicle: VehicleId) -> Result<S::Place, Error> {
        self.vehicles.get(&vehicle).map(|v| v.position.clone()).ok_or(Error::UnknownVehicleId { vehicle })
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

    /// The places of targets.
    fn places<'a>(&'a self, targets: &'a [TargetId]) -> impl Iterator<Item = S::Place> + 'a {
        targets.iter().filter_map(|t| self.targets.get(t)).map(|t| t.place.clone())
    }
}
