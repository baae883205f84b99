//! Random events: no waiting target is lost, none is visited again that must not be.

use christofides::Points;
use mtsp::{
    Absorb, Error, Euclidean, Fleet, Nodes, Revisit, Space, TargetId, VehicleId, procedure_1, procedure_2,
};
use std::collections::{BTreeMap, BTreeSet};

/// Places are on a coarse grid, so that targets coincide now and then.
const SIDE: u64 = 60;

fn on_grid(node: usize) -> [f64; 2] {
    [(node as u64 / SIDE) as f64, (node as u64 % SIDE) as f64]
}

/// A small generator of its own (SplitMix64): the events must not change with a library's.
struct Random(u64);

impl Random {
    fn next(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % bound
    }

    /// A node of the grid.
    fn node(&mut self) -> usize {
        self.next(SIDE * SIDE) as usize
    }

    fn place(&mut self) -> [f64; 2] {
        on_grid(self.node())
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> Option<T> {
        if from.is_empty() { None } else { Some(from[self.next(from.len() as u64) as usize]) }
    }
}

/// What the fleet should know, kept apart from it: targets with the number of visits.
type Books = BTreeMap<TargetId, usize>;

fn audit<S: Space>(fleet: &Fleet<S>, books: &Books, revisit: Revisit) {
    let mut owned: BTreeSet<TargetId> = fleet.unassigned().iter().copied().collect();
    let mut count = owned.len();
    for vehicle in fleet.vehicles() {
        let cluster = fleet.cluster(vehicle).unwrap();
        count += cluster.len();
        owned.extend(cluster);
        let trip = fleet.trip(vehicle).unwrap();
        assert!(trip.iter().all(|t| cluster.contains(t)), "a trip holds a foreign target");
        assert_eq!(trip.iter().collect::<BTreeSet<_>>().len(), trip.len(), "a trip holds a target twice");
    }
    assert_eq!(count, owned.len(), "a target has two vehicles");
    assert!(owned.iter().eq(books.keys()), "a target is lost");
    for (&target, &visits) in books {
        assert_eq!(fleet.is_visited(target), Some(visits > 0));
        assert!(revisit == Revisit::All || visits <= 1, "visited again");
    }
}

/// Random events; returns who visited what, in order.
fn run<S: Space>(
    space: S,
    place: impl Fn(usize) -> S::Place,
    (revisit, absorb): (Revisit, Absorb),
    seed: u64,
    events: usize,
) -> Vec<(VehicleId, TargetId)> {
    let mut random = Random(seed);
    let mut visits = vec![];
    let mut fleet = Fleet::over(space, revisit, absorb);
    let mut books = Books::new();
    let mut vehicles: Vec<VehicleId> = vec![];
    for event in 0..events {
        let targets: Vec<TargetId> = books.keys().copied().collect();
        match random.next(100) {
            0..22 if targets.len() < 60 => {
                books.insert(fleet.appear(place(random.node())).unwrap(), 0);
            }
            22..30 => {
                if let Some(target) = random.pick(&targets) {
                    fleet.vanish(target).unwrap();
                    books.remove(&target);
                    assert!(matches!(fleet.vanish(target), Err(Error::UnknownTargetId { .. })));
                }
            }
            30..38 => {
                if let Some(target) = random.pick(&targets) {
                    fleet.shift(target, place(random.node())).unwrap();
                }
            }
            38..40 if vehicles.len() < 6 => vehicles.push(fleet.join(place(random.node())).unwrap()),
            40..41 => {
                if let Some(vehicle) = random.pick(&vehicles) {
                    fleet.drop_out(vehicle).unwrap();
                    vehicles.retain(|v| *v != vehicle);
                }
            }
            41..44 => {
                if let Some(vehicle) = random.pick(&vehicles) {
                    fleet.retour(vehicle).unwrap();
                }
            }
            _ => {
                if let Some(vehicle) = random.pick(&vehicles)
                    && let Some(target) = fleet.visit_next(vehicle).unwrap()
                {
                    visits.push((vehicle, target));
                    *books.get_mut(&target).expect("visited a target that is gone") += 1;
                }
            }
        }
        if event % 16 == 0 {
            audit(&fleet, &books, revisit);
        }
    }
    // Nothing that waits is lost: one more round visits every target that has a vehicle.
    if vehicles.is_empty() {
        vehicles.push(fleet.join(place(0)).unwrap());
    }
    let mut seen = BTreeSet::new();
    for &vehicle in &vehicles {
        for _ in 0..3 * books.len() {
            if let Some(target) = fleet.visit_next(vehicle).unwrap() {
                seen.insert(target);
            }
        }
    }
    for (target, visits) in books {
        assert!(seen.contains(&target) || (revisit == Revisit::NewOnly && visits > 0), "waits for ever");
    }
    visits
}

const POLICIES: [(Revisit, Absorb); 4] = [
    (Revisit::All, Absorb::NearestCluster),
    (Revisit::NewOnly, Absorb::NearestCluster),
    (Revisit::All, Absorb::CheapestInsertion),
    (Revisit::NewOnly, Absorb::CheapestInsertion),
];

#[test]
fn a_hundred_thousand_events() {
    for policy in POLICIES {
        run(Euclidean, on_grid, policy, 1, 100_000);
        for seed in 2..12 {
            run(Euclidean, on_grid, policy, seed, 500);
        }
    }
}

#[test]
fn a_metric_without_coordinates_serves_as_well() {
    let nodes: Vec<[f64; 2]> = (0..(SIDE * SIDE) as usize).map(on_grid).collect();
    for policy in POLICIES {
        let visits = run(Nodes(Points(&nodes)), |node| node, policy, 1, 10_000);
        if policy.1 == Absorb::CheapestInsertion {
            assert_eq!(visits, run(Euclidean, on_grid, policy, 1, 10_000));
        }
    }
    let mut fleet = Fleet::over(Nodes(Points(&nodes)), Revisit::All, Absorb::NearestCluster);
    assert!(matches!(fleet.join(nodes.len()), Err(Error::UnknownNode { .. })));
}

#[test]
fn a_trip_starts_where_the_vehicle_is() {
    let mut fleet = Fleet::new(Revisit::NewOnly, Absorb::NearestCluster);
    let vehicle = fleet.join([0.0, 0.0]).unwrap();
    let ids: Vec<TargetId> = [3.0, 1.0, 2.0].map(|x| fleet.appear([x, 0.0]).unwrap()).to_vec();
    assert!(fleet.trip(vehicle).unwrap().is_empty());
    assert_eq!(fleet.visit_next(vehicle).unwrap(), Some(ids[1]));
    assert_eq!(fleet.position(vehicle).unwrap(), [1.0, 0.0]);
    assert_eq!(fleet.trip(vehicle).unwrap(), [ids[2], ids[0]]);
    assert!(fleet.appear([f64::NAN, 0.0]).is_err());
}

#[test]
fn the_second_procedure_saves_flights_home() {
    let mut random = Random(9);
    let mut targets = |n: usize| -> Vec<[f64; 2]> { (0..n).map(|_| random.place()).collect() };
    let rounds = [targets(100), targets(20)];
    let (first, second) = (
        procedure_1([30.0, 30.0], &rounds, 8, 1).unwrap(),
        procedure_2([30.0, 30.0], &rounds, 8, 1).unwrap(),
    );
    assert_eq!(first.rounds[0], second.rounds[0]);
    assert_eq!(second.home[0], 0.0);
    assert!(first.total() > second.total());
    assert!(matches!(
        procedure_1([0.0, 0.0], &rounds, 0, 1),
        Err(Error::LabelOutOfRange { .. } | Error::NoVehicles)
    ));
}
