//! `quad-dynamics`: derivatives, Jacobians, loiters, closed-loop simulation.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use quad_dynamics::nalgebra::Vector3;
use quad_dynamics::simulation::{SensorNoise, sample};
use quad_dynamics::*;

fn models(c: &mut Criterion) {
    let vehicle = Vehicle::survey_450();
    let Ok(loiter) = Loiter::new(&vehicle, &LoiterSpec::new(3.0)) else { return };
    let motion = loiter.state(0.7, Direction::Clockwise);
    let mut group = c.benchmark_group("quad_dynamics");
    let rigid = RigidBody::new(&vehicle);
    let (x, u) = (motion.rigid_body_state(), motion.rotor_thrusts);
    group.bench_function("derivative/rigid_body", |b| {
        b.iter(|| rigid.derivative(black_box(&x), black_box(&u)))
    });
    group.bench_function("jacobian/rigid_body", |b| b.iter(|| rigid.jacobian(black_box(&x), black_box(&u))));
    let thrust_rate = ThrustRate::new(&vehicle);
    let (x, u) = (motion.thrust_rate_state(), motion.thrust_rate_control());
    group.bench_function("derivative/thrust_rate", |b| {
        b.iter(|| thrust_rate.derivative(black_box(&x), black_box(&u)))
    });
    group.bench_function("jacobian/thrust_rate", |b| {
        b.iter(|| thrust_rate.jacobian(black_box(&x), black_box(&u)))
    });
    let spec = LoiterSpec::new(3.0);
    group.bench_function("loiter/new", |b| b.iter(|| Loiter::new(black_box(&vehicle), black_box(&spec))));
    group.bench_function("loiter/state", |b| b.iter(|| loiter.state(black_box(0.7), Direction::Clockwise)));
    group.finish();
}

/// One full circle of 3 m, controller and rotors at 500 Hz; throughput in steps.
fn simulation(c: &mut Criterion) {
    let vehicle = Vehicle::survey_450();
    let Ok(loiter) = Loiter::new(&vehicle, &LoiterSpec::new(3.0)) else { return };
    let still = SimulationOptions::default();
    let angle = |t: f64| loiter.angular_speed() * t;
    let plan = sample(|t| loiter.state(angle(t), Direction::CounterClockwise), loiter.duration(), still.step);
    let rough =
        still.with_wind(Vector3::new(4.0, 3.0, 0.0)).with_gusts(5.0, 1.5).with_noise(SensorNoise::typical());
    let mut group = c.benchmark_group("quad_dynamics/closed_loop");
    group.throughput(Throughput::Elements(plan.len() as u64));
    for (name, options) in [("still_air", still), ("gusts_and_noise", rough)] {
        group.bench_function(name, |b| b.iter(|| simulate(&vehicle, black_box(&plan), &options, 1)));
    }
    group.finish();
    let seeds: Vec<u64> = (0..16).collect();
    let mut group = c.benchmark_group("quad_dynamics/batch");
    group.throughput(Throughput::Elements((seeds.len() * plan.len()) as u64));
    group.bench_function("one_by_one", |b| {
        b.iter(|| seeds.iter().filter_map(|&seed| simulate(&vehicle, black_box(&plan), &rough, seed)).count())
    });
    group.bench_function("over_threads", |b| {
        b.iter(|| simulate_batch(&vehicle, black_box(&plan), &rough, &seeds))
    });
    group.finish();
}

criterion_group!(benches, models, simulation);
criterion_main!(benches);
