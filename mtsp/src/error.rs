//! What can be wrong with a problem, with labels, or with routes.

use crate::fleet::{TargetId, VehicleId};

/// Why an input was refused, or what is wrong with given routes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no vehicle.
    #[error("there is no vehicle")]
    NoVehicles,
    /// The metric has no node, so no depot.
    #[error("there is no node, so no depot")]
    NoDepot,
    /// More vehicles than routes are kept for.
    #[error("there are {vehicles} vehicles, at most {limit} can be planned for")]
    TooManyVehicles {
        /// The number of vehicles.
        vehicles: usize,
        /// The greatest number allowed.
        limit: usize,
    },
    /// More nodes than lists are kept for.
    #[error("there are {nodes} nodes, at most {limit} can be planned for")]
    TooManyNodes {
        /// The number of nodes.
        nodes: usize,
        /// The greatest number allowed.
        limit: usize,
    },
    /// A node index is not below the number of nodes.
    #[error("there is no node {node}: the metric has {nodes}")]
    UnknownNode {
        /// The index found.
        node: usize,
        /// The number of nodes.
        nodes: usize,
    },
    /// A vehicle index is not below the number of vehicles.
    #[error("there is no vehicle {vehicle}: there are {vehicles}")]
    UnknownVehicle {
        /// The index found.
        vehicle: usize,
        /// The number of vehicles.
        vehicles: usize,
    },
    /// A distance is NaN, infinite or negative.
    #[error("the distance from node {from} to node {to} is {distance}, but must be finite and not negative")]
    InvalidDistance {
        /// From this node.
        from: usize,
        /// To this node.
        to: usize,
        /// The value found.
        distance: f64,
    },
    /// A list has the wrong length.
    #[error("expected {expected} {list}, found {found}")]
    WrongLength {
        /// Which list.
        list: List,
        /// The length it must have.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// A service cost is NaN, infinite or negative.
    #[error("the service cost of node {node} is {service}, but must be finite and not negative")]
    InvalidService {
        /// The node.
        node: usize,
        /// The value found.
        service: f64,
    },
    /// A limit is NaN or negative.
    #[error("the limit of vehicle {vehicle} is {limit}, but must be a number that is not negative")]
    InvalidLimit {
        /// The vehicle.
        vehicle: usize,
        /// The value found.
        limit: f64,
    },
    /// No vehicle may serve this target: all are forbidden, or two are required.
    #[error("no vehicle is allowed to serve target {target}")]
    NoVehicleAllowed {
        /// The target.
        target: usize,
    },
    /// A target is beyond the reach of every vehicle that may serve it.
    #[error("target {target} needs a limit of at least {needed} even on a route of its own; {remedy}")]
    TargetOutOfReach {
        /// The target.
        target: usize,
        /// The least length of a route that serves it alone, over the vehicles allowed.
        needed: f64,
        /// What would suffice.
        remedy: Remedy,
    },
    /// The limits together are below what all routes together must cost.
    #[error("the limits sum to {available}, but all routes together cost at least {needed}; {remedy}")]
    LimitsTooSmall {
        /// A certified lower bound on the total cost.
        needed: f64,
        /// The sum of the limits.
        available: f64,
        /// What would suffice.
        remedy: Remedy,
    },
    /// A label names no vehicle.
    #[error("target {target} has label {label}, but there are {vehicles} vehicles")]
    LabelOutOfRange {
        /// The target.
        target: usize,
        /// Its label.
        label: usize,
        /// The number of vehicles.
        vehicles: usize,
    },
    /// A route lists a depot.
    #[error("the route of vehicle {vehicle} lists node {node}, which is a depot")]
    DepotInRoute {
        /// The vehicle.
        vehicle: usize,
        /// The depot.
        node: usize,
    },
    /// A target is in no route.
    #[error("target {target} is in no route")]
    TargetMissing {
        /// The target.
        target: usize,
    },
    /// A target is visited more than once.
    #[error("target {target} is visited more than once, the second time by vehicle {vehicle}")]
    TargetRepeated {
        /// The target.
        target: usize,
        /// The vehicle that repeats it.
        vehicle: usize,
    },
    /// A route is longer than its vehicle's limit.
    #[error("the route of vehicle {vehicle} has length {length}, over its limit {limit}")]
    LimitExceeded {
        /// The vehicle.
        vehicle: usize,
        /// The length of its route.
        length: f64,
        /// Its limit.
        limit: f64,
    },
    /// A vehicle serves a target that it must not serve.
    #[error("vehicle {vehicle} serves target {target}, which it may not")]
    PairForbidden {
        /// The vehicle.
        vehicle: usize,
        /// The target.
        target: usize,
    },
    /// The operation is for closed routes from one depot without limits and forbidden pairs.
    #[error("this needs closed routes from one depot, without limits or forbidden pairs")]
    NotTheBasicVariant,
    /// The operation is for vehicles that are interchangeable: same start, end and limit, no forbidden pairs.
    #[error("this needs interchangeable vehicles: the same start, end and limit, and no forbidden pairs")]
    VehiclesDiffer,
    /// The search found no routes within the limits; there may be some all the same.
    #[error("no routes within the limits were found, the best exceed them by {excess}; {remedy}")]
    LimitsNotMet {
        /// The greatest excess of a route over its limit in the best routes found: limits raised by this are met.
        excess: f64,
        /// What would suffice.
        remedy: Remedy,
    },
    /// A position is NaN or infinite.
    #[error("coordinate {axis} of the position is not finite")]
    NonFinitePosition {
        /// Index of the coordinate.
        axis: usize,
    },
    /// A handle names no target of the fleet.
    #[error("the fleet has no target {target:?}")]
    UnknownTargetId {
        /// The handle.
        target: TargetId,
    },
    /// A handle names no vehicle of the fleet.
    #[error("the fleet has no vehicle {vehicle:?}")]
    UnknownVehicleId {
        /// The handle.
        vehicle: VehicleId,
    },
    /// A tour could not be made.
    #[error("the tour could not be made")]
    Tour(#[from] christofides::Error),
    /// Targets could not be clustered.
    #[error("the targets could not be clustered")]
    Clusters(#[from] cluster::Error),
}

/// What would make limits sufficient: known from routes that were found, so neither number need be the least.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Remedy {
    /// There are routes if every vehicle has at least this limit.
    pub limit: f64,
    /// There are routes for this many vehicles with the limit that they have; none for vehicles that differ, or if a target is out of their
    /// reach. [`least_fleet`](crate::least_fleet) looks for the fewest.
    pub vehicles: Option<usize>,
}

impl std::fmt::Display for Remedy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "limits of {} would suffice", self.limit)?;
        self.vehicles.map_or(Ok(()), |vehicles| write!(f, ", or {vehicles} vehicles"))
    }
}

/// The lists of [`Error::WrongLength`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum List {
    /// Service costs, one a node.
    ServiceCosts,
    /// Limits, one a vehicle.
    Limits,
    /// Labels, one a target.
    Labels,
    /// Routes, one a vehicle.
    Routes,
    /// Starts, one a vehicle.
    Starts,
    /// Ends, one a vehicle.
    Ends,
    /// Targets of a tour to be split.
    TourTargets,
}

impl std::fmt::Display for List {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            List::ServiceCosts => "service costs",
            List::Limits => "limits",
            List::Labels => "labels",
            List::Routes => "routes",
            List::Starts => "starts",
            List::Ends => "ends",
            List::TourTargets => "targets in the tour",
        })
    }
}
