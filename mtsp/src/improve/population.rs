//! A population of annealed solutions that exchange whole routes.
//!
//! One annealing settles which region of the map belongs together, and no string taken out changes that any more. A child
//! takes neighbouring routes of one parent and the routes of the other that fit best beside them; what is left is put
//! back greedily, and a short annealing repairs the seam.

use super::anneal::{Annealer, Clock, Setting, Value, better};
use super::arcs::Arcs;
use super::energy::Shape;
use super::options::Options;
use super::random::Random;
use super::state::State;

/// Most solutions kept.
const KEPT: usize = 20;

/// Iterations of one annealing for each target. Short ones, so that there are many children: on the instances of the literature
/// this does as well in 1 s as annealings thirty times as long do in 10 s.
const STRETCH: u64 = 16;
const LEAST_STRETCH: u64 = 1000;

/// More targets than this get one annealing as long as the horizon: it is not long enough for more.
const MANY: usize = 2000;

/// Temperatures in mean arcs: of new solutions, of new ones when there is time for a few only, and of children.
const HOT: f64 = 3.0;
const HURRIED: f64 = 0.5;
const WARM: f64 = 0.1;

/// How a horizon is divided.
struct Schedule {
    stretch: u64,
    kept: usize,
    hot: f64,
}

impl Schedule {
    fn new(options: &Options, n: usize) -> Self {
        let horizon = options.horizon.unwrap_or(options.iterations).min(options.iterations).max(1);
        let stretch = if n > MANY { horizon } else { (STRETCH * n as u64).max(LEAST_STRETCH) };
        let annealings = (horizon / stretch).max(1);
        let hot = if annealings < 4 && n <= MANY { HURRIED } else { HOT };
        let kept = (annealings / 2).clamp(2, KEPT as u64) as usize;
        Self { stretch: horizon / annealings, kept, hot }
    }
}

/// Relative difference in value below which two solutions count as the same one.
const ALIKE: f64 = 1e-7;

/// Shapes of the energy: powers 128, 64, 256, and a knee. No single one is best on all instances, so a child mostly inherits that of a
/// parent and those that do well here spread.
const SHAPES: [Shape; 4] = [Shape::Power(7), Shape::Power(6), Shape::Knee, Shape::Power(8)];
const INHERITED: f64 = 0.75;

struct Member {
    value: Value,
    routes: Vec<Vec<u32>>,
    /// The shape of the energy with which it was annealed.
    shape: Shape,
}

/// Improves `state` until the budget is spent; never ends with a worse one.
pub(crate) fn evolve<A: Arcs>(
    setting: &Setting<'_, A>,
    state: &mut State,
    options: &Options,
    clock: &mut Clock<'_>,
) {
    let schedule = Schedule::new(options, state.n);
    let mut annealer = Annealer::new(setting, Random::new(options.seed), state);
    let start = state.lists();
    let mut best = Member { value: setting.value(state), routes: start.clone(), shape: SHAPES[0] };
    clock.note(state);
    let mut pool: Vec<Member> = Vec::with_capacity(schedule.kept + 1);
    let mut round = 0;
    while !clock.stopped && !setting.is_good_enough(best.value) {
        let mut shape = SHAPES[round % SHAPES.len()];
        round += 1;
        if pool.len() < schedule.kept {
            annealer.energy.set_shape(shape);
            *state = if pool.len().is_multiple_of(2) {
                State::new(state.n, &start, setting.arcs)
            } else {
                scratch(&mut annealer, state.n, setting.limits.len())
            };
            annealer.run(state, schedule.stretch, schedule.hot, best.value, clock);
        } else {
            let (first, second) = parents(&mut annealer.random, pool.len());
            if annealer.random.unit() < INHERITED {
                shape = pool[first].shape;
            }
            annealer.energy.set_shape(shape);
            *state = child(&mut annealer, &pool[first], &pool[second], state.n);
            annealer.run(state, schedule.stretch, WARM, best.value, clock);
        }
        let member = Member { value: setting.value(state), routes: state.lists(), shape };
        if better(member.value, best.value) {
            best = Member { value: member.value, routes: member.routes.clone(), shape };
        }
        admit(&mut pool, member, schedule.kept);
    }
    *state = State::new(state.n, &best.routes, setting.arcs);
    clock.note(state);
    clock.report();
}

/// All targets put in greedily, in an order of chance.
fn scratch<A: Arcs>(annealer: &mut Annealer<'_, A>, n: usize, vehicles: usize) -> State {
    let setting = annealer.setting;
    let mut state = State::new(n, &vec![vec![]; vehicles], setting.arcs);
    let mut all: Vec<u32> = (0..n as u32).collect();
    setting.places.recreate(&mut state, setting.arcs, &mut annealer.energy, &mut all, &mut annealer.random);
    state.commit();
    state
}

/// Adds a member; beyond the size kept, drops one that is alike or else the worst.
fn admit(pool: &mut Vec<Member>, member: Member, kept: usize) {
    let alike = |m: &Member| {
        let same = |a: f64, b: f64| (a - b).abs() <= ALIKE * b.abs();
        same(m.value.0, member.value.0) && same(m.value.1, member.value.1)
    };
    if let Some(twin) = pool.iter().position(alike) {
        if better(member.value, pool[twin].value) {
            pool[twin] = member;
            return;
        }
        // While the pool fills, twins count, so that filling ends.
        if pool.len() == kept {
            return;
        }
    }
    pool.push(member);
    if pool.len() > kept {
        let worst = (1..pool.len()).fold(0, |w, i| if better(pool[w].value, pool[i].value) { i } else { w });
        pool.swap_remove(worst);
    }
}

/// Two different members by chance.
fn parents(random: &mut Random, n: usize) -> (usize, usize) {
    let first = random.below(n);
    (first, (first + 1 + random.below(n - 1)) % n)
}

/// A child of two members.
fn child<A: Arcs>(annealer: &mut Annealer<'_, A>, first: &Member, second: &Member, n: usize) -> State {
    let setting = annealer.setting;
    let Annealer { random, energy, .. } = annealer;
    let (lists, mut left) = recombine(setting, &first.routes, &second.routes, n, random);
    let mut state = State::new(n, &lists, setting.arcs);
    energy.set_scale(first.value.1.max(second.value.1));
    setting.places.recreate(&mut state, setting.arcs, energy, &mut left, random);
    state.commit();
    state
}

/// Routes around a random target from `a`, the others from `b` without the targets visited already; and the targets left.
fn recombine<A: Arcs>(
    setting: &Setting<'_, A>,
    a: &[Vec<u32>],
    b: &[Vec<u32>],
    n: usize,
    random: &mut Random,
) -> (Vec<Vec<u32>>, Vec<u32>) {
    let m = a.len();
    let mut vehicle_in_a = vec![0; n];
    for (vehicle, list) in a.iter().enumerate() {
        for &target in list {
            vehicle_in_a[target as usize] = vehicle;
        }
    }
    let seed = random.below(n);
    let wanted = 1 + random.below(m.saturating_sub(1).max(1));
    let mut from_a = vec![false; m];
    let around = std::iter::once(seed).chain(setting.near.of(seed).iter().map(|&t| t as usize));
    let mut chosen = 0;
    for target in around {
        if chosen < wanted && !std::mem::replace(&mut from_a[vehicle_in_a[target]], true) {
            chosen += 1;
        }
    }
    let mut lists: Vec<Vec<u32>> = (0..m).map(|v| if from_a[v] { a[v].clone() } else { vec![] }).collect();
    let free = |target: u32| !from_a[vehicle_in_a[target as usize]];
    let mut rest: Vec<(usize, Vec<u32>)> =
        b.iter().map(|list| list.iter().copied().filter(|&t| free(t)).collect()).enumerate().collect();
    if setting.places.alike {
        // The fullest rests keep a vehicle; ties by vehicle.
        rest.sort_by_key(|(vehicle, list)| (std::cmp::Reverse(list.len()), *vehicle));
    } else {
        rest.sort_by_key(|(vehicle, _)| (from_a[*vehicle], *vehicle));
    }
    let vehicles = (0..m).filter(|&v| !from_a[v]);
    let mut left = Vec::new();
    let mut rest = rest.into_iter();
    for (vehicle, (_, list)) in vehicles.zip(rest.by_ref()) {
        lists[vehicle] = list;
    }
    left.extend(rest.flat_map(|(_, list)| list));
    (lists, left)
}
