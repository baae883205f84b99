//! The problem: who starts and ends where, what a route costs, who may serve whom.

use crate::error::{Error, List};
use christofides::Metric;

/// Where a vehicle's route ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum End {
    /// At this node, for a closed route the node where it starts.
    At(usize),
    /// At its last target: an open route.
    Open,
}

/// A problem with several salesmen.
///
/// The nodes of the metric that are no vehicle's start or end are the targets. The length of a route through targets
/// t1, .., tk is
///
/// ```text
/// d(start, t1) + sum d(tj, tj+1) + sum service(tj) [+ d(tk, end)]
/// ```
///
/// and 0 for a vehicle that stays at home. All legs are called as `distance(from, to)`. Units are the metric's (metres or seconds).
#[derive(Debug)]
pub struct Problem<'a, M: Metric> {
    metric: &'a M,
    service: Vec<f64>,
    starts: Vec<usize>,
    ends: Vec<End>,
    limits: Vec<f64>,
    targets: Vec<usize>,
    /// Vehicles that must not serve a target, by node; empty when there are no such pairs at all.
    forbidden: Vec<Vec<usize>>,
}

impl<M: Metric> Clone for Problem<'_, M> {
    fn clone(&self) -> Self {
        Self {
            metric: self.metric,
            service: self.service.clone(),
            starts: self.starts.clone(),
            ends: self.ends.clone(),
            limits: self.limits.clone(),
            targets: self.targets.clone(),
            forbidden: self.forbidden.clone(),
        }
    }
}

/// Numbers beyond any instance that can be solved, but within memory.
const MOST_VEHICLES: usize = 1 << 20;
const MOST_NODES: usize = 1 << 24;

impl<'a, M: Metric> Problem<'a, M> {
    /// `vehicles` vehicles that start at node 0, the depot, and return to it; all other nodes are targets.
    ///
    /// # Errors
    /// [`Error::NoVehicles`], [`Error::NoDepot`]; [`Error::TooManyVehicles`], [`Error::TooManyNodes`] for more than a million vehicles or
    /// sixteen million nodes, before memory is asked for; [`Error::InvalidDistance`] if a leg between the depot and a target is
    /// not finite or is negative (legs between targets are checked by the functions that read them all).
    pub fn new(metric: &'a M, vehicles: usize) -> Result<Self, Error> {
        if vehicles == 0 {
            return Err(Error::NoVehicles);
        }
        check_fleet(vehicles)?;
        if metric.is_empty() {
            return Err(Error::NoDepot);
        }
        let nodes = metric.len();
        if nodes > MOST_NODES {
            return Err(Error::TooManyNodes { nodes, limit: MOST_NODES });
        }
        let service = vec![0.0; nodes];
        let (starts, ends) = (vec![0; vehicles], vec![End::At(0); vehicles]);
        let limits = vec![f64::INFINITY; vehicles];
        let mut problem = Self { metric, service, starts, ends, limits, targets: vec![], forbidden: vec![] };
        problem.find_targets();
        for &target in &problem.targets {
            problem.leg(0, target)?;
            problem.leg(target, 0)?;
        }
        Ok(problem)
    }

    /// The same problem, but routes end at their last target.
    #[must_use]
    pub fn with_open_routes(mut self) -> Self {
        self.ends.fill(End::Open);
        self.find_targets();
        self
    }

    /// Sets the cost of serving each node (loitering there), one a node; the depot's is ignored.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::InvalidService`].
    pub fn with_service(mut self, service: Vec<f64>) -> Result<Self, Error> {
        expect_length(List::ServiceCosts, self.metric.len(), service.len())?;
        if let Some(node) = service.iter().position(|s| !(s.is_finite() && *s >= 0.0)) {
            return Err(Error::InvalidService { node, service: service[node] });
        }
        self.service = service;
        Ok(self)
    }

    /// Sets where each vehicle starts and ends; every other node is a target.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::UnknownNode`].
    pub fn with_depots(mut self, starts: Vec<usize>, ends: Vec<End>) -> Result<Self, Error> {
        expect_length(List::Starts, self.vehicles(), starts.len())?;
        expect_length(List::Ends, self.vehicles(), ends.len())?;
        let nodes = self.metric.len();
        let named = ends.iter().filter_map(|e| if let End::At(node) = e { Some(node) } else { None });
        if let Some(&node) = starts.iter().chain(named).find(|&&node| node >= nodes) {
            return Err(Error::UnknownNode { node, nodes });
        }
        (self.starts, self.ends) = (starts, ends);
        self.find_targets();
        Ok(self)
    }

    /// Sets the greatest route length of each vehicle (its battery); infinity means none.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::InvalidLimit`].
    pub fn with_limits(mut self, limits: Vec<f64>) -> Result<Self, Error> {
        expect_length(List::Limits, self.vehicles(), limits.len())?;
        if let Some(vehicle) = limits.iter().position(|l| l.is_nan() || *l < 0.0) {
            return Err(Error::InvalidLimit { vehicle, limit: limits[vehicle] });
        }
        self.limits = limits;
        Ok(self)
    }

    /// Forbids `vehicle` to serve `target`.
    ///
    /// # Errors
    /// [`Error::UnknownVehicle`], [`Error::UnknownNode`], [`Error::NoVehicleAllowed`] if it was the last one allowed.
    pub fn forbidding(mut self, vehicle: usize, target: usize) -> Result<Self, Error> {
        self.forbid(vehicle, target)?;
        Ok(self)
    }

    /// Requires that `vehicle` serves `target`.
    ///
    /// # Errors
    /// Those of [`forbidding`](Self::forbidding).
    pub fn requiring(mut self, vehicle: usize, target: usize) -> Result<Self, Error> {
        let vehicles = self.vehicles();
        if vehicle >= vehicles {
            return Err(Error::UnknownVehicle { vehicle, vehicles });
        }
        for other in (0..vehicles).filter(|&v| v != vehicle) {
            self.forbid(other, target)?;
        }
        if !self.allows(vehicle, target) {
            return Err(Error::NoVehicleAllowed { target });
        }
        Ok(self)
    }

    fn forbid(&mut self, vehicle: usize, target: usize) -> Result<(), Error> {
        let (vehicles, nodes) = (self.vehicles(), self.metric.len());
        if vehicle >= vehicles {
            return Err(Error::UnknownVehicle { vehicle, vehicles });
        }
        if target >= nodes {
            return Err(Error::UnknownNode { node: target, nodes });
        }
        self.forbidden.resize(nodes, vec![]);
        let list = &mut self.forbidden[target];
        if !list.contains(&vehicle) {
            list.push(vehicle);
        }
        if list.len() == vehicles { Err(Error::NoVehicleAllowed { target }) } else { Ok(()) }
    }

    fn find_targets(&mut self) {
        let mut is_depot = vec![false; self.metric.len()];
        for &start in &self.starts {
            is_depot[start] = true;
        }
        for end in &self.ends {
            if let End::At(node) = end {
                is_depot[*node] = true;
            }
        }
        self.targets = (0..is_depot.len()).filter(|&i| !is_depot[i]).collect();
    }

    /// A leg's length, refused unless finite and not negative.
    pub(crate) fn leg(&self, from: usize, to: usize) -> Result<f64, Error> {
        let distance = self.metric.distance(from, to);
        if distance.is_finite() && distance >= 0.0 {
            Ok(distance)
        } else {
            Err(Error::InvalidDistance { from, to, distance })
        }
    }

    /// The metric.
    #[must_use]
    pub fn metric(&self) -> &'a M {
        self.metric
    }

    /// The number of vehicles.
    #[must_use]
    pub fn vehicles(&self) -> usize {
        self.starts.len()
    }

    /// The nodes to visit, ascending.
    #[must_use]
    pub fn targets(&self) -> &[usize] {
        &self.targets
    }

    /// The service cost of each node.
    #[must_use]
    pub fn service(&self) -> &[f64] {
        &self.service
    }

    /// The node where a vehicle starts.
    #[must_use]
    pub fn start(&self, vehicle: usize) -> usize {
        self.starts[vehicle]
    }

    /// Where a vehicle ends.
    #[must_use]
    pub fn end(&self, vehicle: usize) -> End {
        self.ends[vehicle]
    }

    /// The greatest route length of a vehicle.
    #[must_use]
    pub fn limit(&self, vehicle: usize) -> f64 {
        self.limits[vehicle]
    }

    /// Whether the vehicle may serve the target.
    #[must_use]
    pub fn allows(&self, vehicle: usize, target: usize) -> bool {
        self.forbidden.get(target).is_none_or(|list| !list.contains(&vehicle))
    }

    /// The one depot, if all vehicles start at the same node and all return to it.
    #[must_use]
    pub fn closed_depot(&self) -> Option<usize> {
        let depot = self.starts[0];
        let closed =
            self.starts.iter().all(|&s| s == depot) && self.ends.iter().all(|&e| e == End::At(depot));
        closed.then_some(depot)
    }

    /// Whether vehicles are interchangeable: same start, end and limit, and no forbidden pairs.
    #[must_use]
    pub fn is_homogeneous(&self) -> bool {
        self.starts.iter().all(|&s| s == self.starts[0])
            && self.ends.iter().all(|&e| e == self.ends[0])
            && self.limits.iter().all(|&l| l == self.limits[0])
            && self.forbidden.iter().all(Vec::is_empty)
    }

    /// The one depot, if routes are closed, limits infinite and no pairs forbidden.
    pub(crate) fn basic_depot(&self) -> Option<usize> {
        self.closed_depot().filter(|_| self.is_homogeneous() && !self.has_limits())
    }

    /// The same problem without limits and forbidden pairs.
    pub(crate) fn without_restrictions(&self) -> Self {
        let mut free = self.clone();
        free.limits.fill(f64::INFINITY);
        free.forbidden.clear();
        free
    }

    /// The same problem for the first vehicles only; all of them if there are fewer. For interchangeable vehicles, of which one stays.
    pub(crate) fn with_first_vehicles(&self, vehicles: usize) -> Self {
        let mut fewer = self.clone();
        fewer.starts.truncate(vehicles.max(1));
        fewer.ends.truncate(vehicles.max(1));
        fewer.limits.truncate(vehicles.max(1));
        fewer
    }

    /// Whether some vehicle has a finite limit.
    #[must_use]
    pub fn has_limits(&self) -> bool {
        self.limits.iter().any(|l| l.is_finite())
    }

    /// The length of a vehicle's route through the given targets.
    ///
    /// # Panics
    /// If a node is not below the number of nodes, or the vehicle not below the number of vehicles.
    #[must_use]
    pub fn route_length(&self, vehicle: usize, route: &[usize]) -> f64 {
        let (Some(&first), Some(&last)) = (route.first(), route.last()) else { return 0.0 };
        let mut length = self.metric.distance(self.starts[vehicle], first);
        for pair in route.windows(2) {
            length += self.service[pair[0]] + self.metric.distance(pair[0], pair[1]);
        }
        length += self.service[last];
        if let End::At(node) = self.ends[vehicle] {
            length += self.metric.distance(last, node);
        }
        length
    }
}

/// Refuses more vehicles than lists of them would fit the memory.
pub(crate) fn check_fleet(vehicles: usize) -> Result<(), Error> {
    if vehicles > MOST_VEHICLES {
        return Err(Error::TooManyVehicles { vehicles, limit: MOST_VEHICLES });
    }
    Ok(())
}

pub(crate) fn expect_length(list: List, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::WrongLength { list, expected, found }) }
}
