//! Numbers at the edge of what `f64` holds: a mission is refused with all that is wrong, or answered; nothing panics.

use planner::quad_dynamics::{Camera, Vehicle};
use planner::{
    CameraSettings, Direction, Entries, Error, Event, LoiterYaw, Mission, Model, Objective, Options,
    Pipeline, Plan, Problem, Replanner, ShapingLimits, Target, Tolerances, Transcription, plan,
};
use proptest::prelude::*;
use quad_dynamics::SimulationOptions;
use std::sync::LazyLock;

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        5e-324,
        -1e-310,
        1e-160,
        1e154,
        1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ]);
    prop_oneof![4 => special, 1 => prop::num::f64::NORMAL, 2 => -3.0..3.0_f64]
}

fn count() -> impl Strategy<Value = usize> {
    prop::sample::select(vec![0, 1, 2, 1000, 1001, 1 << 40, usize::MAX])
}

fn sound() -> Mission {
    let mut mission =
        Mission::new(Vehicle::survey_450(), 2, [[14.0, 3.0], [-3.0, 12.0]].map(Target::at).to_vec());
    mission.transition.entries = Entries::Sampled(2);
    mission.transition.segments = 8;
    mission
}

/// A sound mission with one number, or several, changed to anything.
fn any_mission() -> impl Strategy<Value = Mission> {
    (prop::collection::vec((0..30_usize, extreme()), 0..4), count()).prop_map(|(mut changes, n)| {
        let mut mission = sound();
        // The targets go after all that is changed in them.
        changes.sort_by_key(|(field, _)| *field);
        for (field, value) in changes {
            change(&mut mission, field, value, n);
        }
        mission
    })
}

fn change(mission: &mut Mission, field: usize, value: f64, n: usize) {
    let (loiter, transition) = (&mut mission.loiter, &mut mission.transition);
    match field {
        0 => mission.depot[0] = value,
        1 => mission.fleet.vehicles = n,
        2 => mission.fleet.separation = value,
        3 => mission.fleet.endurance = value,
        4 => loiter.radius = value,
        5 => loiter.height = value,
        6 => loiter.sweep = value,
        7 => loiter.thrust_budget = value,
        8 => loiter.yaw = LoiterYaw::AtTarget,
        9 => loiter.speed_limit = value,
        10 => loiter.acceleration_limit = value,
        11 => transition.segments = n,
        12 => transition.entries = Entries::Sampled(n),
        13 => transition.model = Model::JerkLimited,
        14 => transition.thrust_budget = value,
        15 => transition.safe_distance = value,
        16 => transition.heights[0] = value,
        17 => transition.heights[1] = value,
        18 => transition.shaping = ShapingLimits::arducopter().with_speed(value).with_jerk(value),
        19 => mission.swap_time = Some(value),
        20 => mission.environment.wind[1] = value,
        21 => mission.targets[1].position[0] = value,
        22 => mission.targets[0].radius = Some(value),
        23 => mission.targets[0].height = Some(value),
        24 => mission.targets[1].safe_distance = Some(value),
        25 => mission.merge_within = value,
        26 => (mission.objective, mission.pipeline) = (Objective::Total, Pipeline::Paper),
        27 => transition.transcription = Transcription::Trapezoidal,
        28 => mission.targets.clear(),
        _ => {
            let camera = Camera::new(1.0, 0.8).expect("angles in range").with_mount(value, value);
            mission.camera = Some(CameraSettings { camera, target_height: value });
        }
    }
}

/// A plan of the sound mission, made once.
static PLANNED: LazyLock<Plan> =
    LazyLock::new(|| plan(&sound(), &Options::default()).expect("a sound mission"));

fn event() -> impl Strategy<Value = Event> {
    let target = [extreme(), extreme()].prop_map(Target::at);
    prop_oneof![
        target.prop_map(Event::TargetAppears),
        count().prop_map(Event::TargetVanishes),
        (count(), [extreme(), extreme()]).prop_map(|(target, position)| Event::TargetMoves(target, position)),
        count().prop_map(Event::VehicleFails),
        count().prop_map(Event::VehicleReturns),
        [extreme(), extreme()].prop_map(Event::WindChanges),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn missions_of_any_numbers_are_refused_or_fit(mission in any_mission()) {
        let problems = mission.problems();
        prop_assert!(mission.pads().len() <= 1000);
        prop_assert!(problems.iter().all(|problem| !problem.to_string().is_empty() && !problem.field().is_empty()));
        // Where nothing is wrong planning is tried elsewhere; here that what is wrong is found before any work.
        if !problems.is_empty() {
            let refused = matches!(plan(&mission, &Options::default()), Err(Error::Mission { .. }));
            prop_assert!(refused);
            prop_assert!(Replanner::new(mission.clone(), PLANNED.clone()).is_err());
        }
        // A plan asked with a mission that is not its own.
        let plan = &*PLANNED;
        let _ = (plan.sampler(&mission).is_some(), plan.energy(&mission, 0), plan.shares_in_view(&mission));
        let _ = (plan.sample(&mission, 0, 1.0), plan.motions(&mission, 1, 0.5));
    }

    #[test]
    fn plans_asked_for_any_moment(vehicle in count(), numbers in prop::array::uniform4(extreme())) {
        let (mission, plan) = (sound(), &*PLANNED);
        let [a, b, c, d] = numbers;
        let _ = (plan.sample(&mission, vehicle, a), plan.energy(&mission, vehicle));
        let _ = (plan.samples(&mission, vehicle, b), plan.motions(&mission, vehicle, c));
        if let Some(sampler) = plan.sampler(&mission) {
            let _ = (sampler.sample(vehicle, d), sampler.samples(vehicle, d).take(50).count());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn events_of_any_numbers(events in prop::collection::vec((extreme(), event()), 1..4), step in extreme()) {
        let Ok(mut replanner) = Replanner::new(sound(), PLANNED.clone()) else { return Err(TestCaseError::fail("not replannable")) };
        for (time, event) in &events {
            let before = replanner.plan().vehicles.len();
            let _ = replanner.apply(*time, event);
            prop_assert_eq!(replanner.plan().vehicles.len(), before);
        }
        let mut options = SimulationOptions::default();
        options.step = step;
        let _ = PLANNED.fly(&sound(), &options.with_ramp(step), 1);
    }

    #[test]
    fn tolerances_of_any_numbers(numbers in prop::array::uniform3(extreme())) {
        let mut tolerances = Tolerances::default();
        (tolerances.miss.position, tolerances.miss.velocity, tolerances.bound) = (numbers[0], numbers[1], numbers[2]);
        let checked = PLANNED.verify(&sound(), &tolerances);
        prop_assert!(!checked.worst_miss().position.is_nan());
        let _ = checked.passed();
    }

    /// What planning accepts it answers, whatever the budgets.
    #[test]
    fn budgets_of_any_size(search in prop::sample::select(vec![0, 1, 50]), solver in 0..3_usize, direction in any::<bool>()) {
        let _ = if direction { Direction::Clockwise } else { Direction::CounterClockwise };
        let options = Options::default().with_search_iterations(search).with_solver_iterations(solver);
        if let Ok(plan) = plan(&sound(), &options) {
            prop_assert!(plan.certificate.makespan.is_finite());
        }
        let stop = || true;
        prop_assert!(plan(&sound(), &options.with_should_stop(&stop)).is_err());
    }
}

#[test]
fn groups_must_share_out_the_targets() {
    for (groups, wrong) in [
        (vec![vec![0], vec![1]], vec![Problem::NotGrouped { target: 2, groups: 0 }]),
        (vec![vec![0, 1], vec![1, 2]], vec![Problem::NotGrouped { target: 1, groups: 2 }]),
        (vec![vec![0, 1, 2], vec![]], vec![Problem::BadGroup { group: 1 }]),
        (
            vec![vec![0, 7], vec![1, 2]],
            vec![Problem::BadGroup { group: 0 }, Problem::NotGrouped { target: 0, groups: 0 }],
        ),
    ] {
        let mut mission = sound();
        mission.targets = [[15.0, 0.0], [-15.0, 0.0], [0.0, 20.0]].map(Target::at).to_vec();
        mission.groups = Some(groups);
        assert_eq!(mission.problems(), wrong);
    }
}
