//! Minimum-time transitions from a table of start and end states: a row each, then a summary.
//!
//! `cargo run --release -p uav-planner --example transitions -- FILE.csv [--model thrust-rate|rigid-body] [--segments 40]
//! [--transcription hermite-simpson|trapezoidal|runge-kutta] [--substeps 2] [--guess naive|own] [--starts K] [--flyable] [--warm]
//! [--json]`
//!
//! The columns read are `id`, `start_px` to `start_wz`, `end_px` to `end_wz` (SI; quaternions w first, body to world) and, if there,
//! `tfA_hs80` and `tfB_hs80` (reference times) and `c1x`, `c1y` (the end circle's centre). `--starts K` solves from K guesses and keeps the fastest. `--flyable` solves
//! once more with a constant control on each of segments that are short where the controls switch, until the integrated controls
//! reach the target. `--warm` adds the time of a neighbour whose end state is turned by 5 degrees about the circle's axis.
//! Milliseconds are those of this thread on a processor; nothing is counted but reading the table, integrating and printing.

mod problem;

use nalgebra::{Rotation3, SVector, UnitQuaternion, Vector3};
use planner::quad_dynamics::{RigidBody, ThrustRate, Vehicle, VehicleParameters};
use problem::{Rates, Rotors, Transition, attitude, part};
use std::collections::HashMap;
use std::ops::ControlFlow;
use traj_opt::{
    Bounds, Dynamics, Guess, Mesh, Options, Solution, Transcription, Workspace, solve_from, solve_with,
};

/// Scaled KKT residual at which a transition counts as solved: the time is then right to about 0.02 %.
const TOLERANCE: f64 = 3e-6;
/// First barrier parameter for guesses that meet both ends.
const FIRST_MU: f64 = 0.01;
/// The same for a neighbour, whose barrier parameter starts at a third of it and so decides how right the time is.
const NEIGHBOUR_TOLERANCE: f64 = 1e-5;
/// What a flyable transition may miss: m, m/s, degrees.
const FLYABLE: [f64; 3] = [0.01, 0.01, 0.5];

type Failure = Box<dyn std::error::Error>;

/// A mesh on which the controls of a solution change by as much in one segment as in the other, as far as they change.
fn gathered<const NX: usize>(solution: &Solution<NX, 4>, bounds: &Bounds<NX, 4>, n: usize) -> Mesh {
    const LOOKS: usize = 400;
    let (t0, length) = (solution.initial_time(), solution.final_time() - solution.initial_time());
    let control = |i: usize| solution.control_at(t0 + length * i as f64 / LOOKS as f64);
    let mut reached = vec![0.0];
    for i in 0..LOOKS {
        let change = (control(i + 1) - control(i)).abs();
        let share = change.component_div(&(bounds.control_upper - bounds.control_lower)).sum();
        reached.push(reached[i] + (1.0 / LOOKS as f64) + share.min(1.0) * GATHER);
    }
    let whole = reached[LOOKS];
    let mut fractions = vec![0.0];
    for k in 1..n {
        let wanted = whole * k as f64 / n as f64;
        let i = reached.partition_point(|r| *r < wanted).clamp(1, LOOKS);
        let within = (wanted - reached[i - 1]) / (reached[i] - reached[i - 1]);
        fractions.push((i as f64 - 1.0 + within) / LOOKS as f64);
    }
    fractions.push(1.0);
    Mesh::from_fractions(fractions).unwrap_or_else(|_| Mesh::uniform(n))
}

/// Share of the mesh that one change of a control over its whole range attracts.
const GATHER: f64 = 0.05;

/// What the command line asks for.
struct Settings {
    segments: usize,
    transcription: Transcription,
    naive: bool,
    starts: usize,
    flyable: bool,
    warm: bool,
    json: bool,
}

/// One row of the answer.
struct Row {
    id: String,
    status: String,
    solved: bool,
    time: f64,
    iterations: usize,
    milliseconds: f64,
    miss: [f64; 3],
    reference: Option<f64>,
    neighbour: Option<(bool, usize, f64)>,
}

/// Processor time of this thread, s.
fn processor_time() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn proceed(_: &traj_opt::Iteration) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The fastest solution from as many guesses as asked for, and all iterations.
fn best<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    transition: &Transition<D, NX>,
    settings: &Settings,
) -> Result<(Solution<NX, 4>, usize), Failure> {
    let mesh = Mesh::uniform(settings.segments);
    let options = Options::default().with_tolerance(TOLERANCE);
    let variations = [(1.0, 0.0), (1.0, 3.0), (1.0, -3.0), (1.6, 0.0), (1.6, 3.0), (1.6, -3.0), (2.5, 0.0)];
    let (mut best, mut iterations): (Option<Solution<NX, 4>>, usize) = (None, 0);
    for start in 0..settings.starts.clamp(1, variations.len() + 1) {
        let use_naive = settings.naive == (start == 0) && (settings.naive || start == 1);
        let (guess, mu) = if use_naive {
            (transition.naive(), 0.1)
        } else {
            let (stretch, spin) = variations[start.saturating_sub(1)];
            (transition.own(stretch, spin), FIRST_MU)
        };
        let options = options.clone().with_initial_mu(mu);
        let found =
            solve_with(workspace, transition, &mesh, settings.transcription, &guess, &options, proceed)?;
        iterations += found.iterations;
        let better = best.as_ref().is_none_or(|b| {
            found.status.is_success() && (!b.status.is_success() || found.objective < b.objective)
        });
        if better {
            best = Some(found);
        }
    }
    Ok((best.ok_or("no start")?, iterations))
}

/// Solves with constant controls on a mesh gathered at the switches until the integrated controls reach the target.
fn fly<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    transition: &Transition<D, NX>,
    first: &Solution<NX, 4>,
    segments: usize,
) -> Result<(Solution<NX, 4>, usize), Failure> {
    // constant controls on half as many segments again cost up to 0.06 % of time more than on these
    let mesh = gathered(first, &transition.bounds, segments * 7 / 4);
    let options =
        Options::default().with_tolerance(TOLERANCE).with_initial_mu(1e-4).with_warm_mu(TOLERANCE / 3.0);
    let guess = Guess::from_solution(first, 4);
    let once = Transcription::RungeKutta { substeps: 1 };
    let mut solution = solve_with(workspace, transition, &mesh, once, &guess, &options, proceed)?;
    let mut iterations = solution.iterations;
    for substeps in [2, 4] {
        if transition.miss(&solution).iter().zip(FLYABLE).all(|(miss, limit)| *miss <= limit) {
            break;
        }
        let finer = Transcription::RungeKutta { substeps };
        solution = solve_from(workspace, transition, &solution, finer, &options, proceed)?;
        iterations += solution.iterations;
    }
    Ok((solution, iterations))
}

/// The same flight to an end state that is turned by 5 degrees about the vertical through `centre`.
fn turned<'a, D, const NX: usize>(t: &Transition<'a, D, NX>, centre: Vector3<f64>) -> Transition<'a, D, NX> {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 5f64.to_radians());
    let mut end = t.end;
    end.fixed_rows_mut::<3>(0).copy_from(&(turn * (part(&t.end, 0) - centre) + centre));
    end.fixed_rows_mut::<3>(3).copy_from(&(turn * part(&t.end, 3)));
    let q = UnitQuaternion::from_rotation_matrix(&turn) * attitude(&t.end);
    end.fixed_rows_mut::<4>(6).copy_from(&SVector::from([q.w, q.i, q.j, q.k]));
    Transition { end, ..*t }
}

fn solve_row<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    transition: &Transition<D, NX>,
    settings: &Settings,
    row: &HashMap<&str, &str>,
    reference: &str,
) -> Result<Row, Failure> {
    let number = |name: &str| row.get(name).and_then(|text| text.parse::<f64>().ok());
    let begin = processor_time();
    let (mut solution, mut iterations) = best(workspace, transition, settings)?;
    if settings.flyable && solution.status.is_success() {
        let (flown, more) = fly(workspace, transition, &solution, settings.segments)?;
        solution = flown;
        iterations += more;
    }
    let milliseconds = 1e3 * (processor_time() - begin);
    let neighbour = match (settings.warm, number("c1x"), number("c1y")) {
        (true, Some(x), Some(y)) => {
            let next = turned(transition, Vector3::new(x, y, 0.0));
            let options = Options::default().with_tolerance(NEIGHBOUR_TOLERANCE);
            let begin = processor_time();
            let found = solve_from(workspace, &next, &solution, solution.transcription(), &options, proceed)?;
            Some((found.status.is_success(), found.iterations, 1e3 * (processor_time() - begin)))
        }
        _ => None,
    };
    let miss = transition.miss(&solution);
    let flyable = miss.iter().zip(FLYABLE).all(|(miss, limit)| *miss <= limit);
    let solved = solution.status.is_success();
    let status = match (settings.flyable, solved && flyable) {
        (true, true) => "flyable".to_string(),
        (true, false) => format!("{}, not flyable", solution.status),
        _ => solution.status.to_string(),
    };
    Ok(Row {
        id: row.get("id").unwrap_or(&"?").to_string(),
        status,
        solved: solved && (flyable || !settings.flyable),
        time: solution.objective,
        iterations,
        milliseconds,
        miss,
        reference: number(reference),
        neighbour,
    })
}

fn state(row: &HashMap<&str, &str>, prefix: &str) -> Result<SVector<f64, 13>, Failure> {
    let names = ["px", "py", "pz", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz"];
    let mut out = SVector::zeros();
    for (i, name) in names.iter().enumerate() {
        let column = format!("{prefix}_{name}");
        out[i] = row.get(column.as_str()).ok_or_else(|| format!("no column {column}"))?.parse()?;
    }
    Ok(out)
}

/// Solves every row with the model of that name.
fn solve_all(text: &str, model: &str, settings: &Settings) -> Result<Vec<Row>, Failure> {
    let vehicle = &Vehicle::new(VehicleParameters::survey_450())?;
    let rates = vehicle.max_body_rates();
    let (thrust_rate, rigid_body) = (Rates(ThrustRate::new(vehicle)), Rotors(RigidBody::new(vehicle)));
    let (mut of_rates, mut of_rotors) = (Workspace::new(), Workspace::new());
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().ok_or("an empty table")?.split(',').collect();
    let mut rows = vec![];
    for line in lines.filter(|line| !line.trim().is_empty()) {
        let row: HashMap<&str, &str> = header.iter().copied().zip(line.split(',')).collect();
        let (start, end) = (state(&row, "start")?, state(&row, "end")?);
        rows.push(if model == "thrust-rate" {
            let low = SVector::from([vehicle.min_thrust(), -rates.x, -rates.y, -rates.z]);
            let high = SVector::from([vehicle.max_thrust(), rates.x, rates.y, rates.z]);
            let transition = Transition {
                dynamics: &thrust_rate,
                start: start.fixed_rows::<10>(0).into_owned(),
                end: end.fixed_rows::<10>(0).into_owned(),
                bounds: Bounds::free().with_control(low, high),
                hover: SVector::from([vehicle.weight(), 0.0, 0.0, 0.0]),
                vehicle,
            };
            solve_row(&mut of_rates, &transition, settings, &row, "tfA_hs80")?
        } else {
            let mut most = SVector::<f64, 13>::repeat(f64::INFINITY);
            most.fixed_rows_mut::<3>(10).copy_from(&rates);
            let rotor = [vehicle.min_rotor_thrust(), vehicle.max_rotor_thrust()].map(SVector::repeat);
            let bounds = Bounds::free().with_state(-most, most).with_control(rotor[0], rotor[1]);
            let hover = SVector::repeat(0.25 * vehicle.weight());
            let transition = Transition { dynamics: &rigid_body, start, end, bounds, hover, vehicle };
            solve_row(&mut of_rotors, &transition, settings, &row, "tfB_hs80")?
        });
    }
    Ok(rows)
}

fn print_json(rows: &[Row]) {
    let number = |v: f64| if v.is_finite() { v.to_string() } else { "null".to_string() };
    let entry = |r: &Row| {
        format!(
            "  {{\"id\": \"{}\", \"status\": \"{}\", \"t_f\": {}, \"iterations\": {}, \"milliseconds\": {}, \
             \"position_error\": {}, \"velocity_error\": {}}}",
            r.id,
            r.status,
            number(r.time),
            r.iterations,
            number(r.milliseconds),
            number(r.miss[0]),
            number(r.miss[1])
        )
    };
    println!("[\n{}\n]", rows.iter().map(entry).collect::<Vec<_>>().join(",\n"));
}

/// Middle and 95th percentile.
fn percentiles(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = |share: usize| values.get(values.len() * share / 100).copied().unwrap_or(f64::NAN);
    [at(50), at(95)]
}

fn print_table(rows: &[Row]) {
    println!(" id  status          t_f s  against reference  iterations     ms   miss m   m/s    deg");
    for r in rows {
        let against = r.reference.map_or(f64::NAN, |reference| 100.0 * (r.time / reference - 1.0));
        print!(
            "{:>3}  {:12} {:8.5}        {:+8.3} %   {:9} {:7.2}",
            r.id, r.status, r.time, against, r.iterations, r.milliseconds
        );
        println!("   {:.4} {:.4} {:.3}", r.miss[0], r.miss[1], r.miss[2]);
    }
    let [median, high] = percentiles(rows.iter().map(|r| r.milliseconds));
    let solved = rows.iter().filter(|r| r.solved).count();
    println!("{solved} of {} solved; {median:.2} ms median, {high:.2} ms 95th percentile", rows.len());
    let excess = |r: &Row| r.reference.map(|reference| r.time / reference - 1.0);
    let good = rows.iter().filter_map(excess).filter(|e| *e <= 1e-3).count();
    let [miss, most] = percentiles(rows.iter().map(|r| r.miss[0]));
    println!(
        "within 0.1 % of the reference or better: {good}; miss {miss:.4} m median, {most:.4} m 95th percentile"
    );
    if rows.iter().any(|r| r.neighbour.is_some()) {
        let solved = rows.iter().filter_map(|r| r.neighbour).filter(|n| n.0).count();
        let [median, high] = percentiles(rows.iter().filter_map(|r| r.neighbour).map(|n| n.2));
        let [middle, _] = percentiles(rows.iter().filter_map(|r| r.neighbour).map(|n| n.1 as f64));
        println!(
            "neighbours: {solved} solved, {middle} iterations, {median:.2} ms median, {high:.2} ms 95th percentile"
        );
    }
}

fn main() -> Result<(), Failure> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str, default: &str| {
        let at = words.iter().position(|word| word == name);
        at.and_then(|i| words.get(i + 1)).cloned().unwrap_or_else(|| default.to_string())
    };
    let flag = |name: &str| words.iter().any(|word| word == name);
    let file = words.first().filter(|word| !word.starts_with("--")).ok_or("which table?")?;
    let settings = Settings {
        segments: option("--segments", "40").parse()?,
        transcription: match option("--transcription", "hermite-simpson").as_str() {
            "hermite-simpson" => Transcription::HermiteSimpson,
            "trapezoidal" => Transcription::Trapezoidal,
            "runge-kutta" => Transcription::RungeKutta { substeps: option("--substeps", "2").parse()? },
            other => return Err(format!("no transcription {other}").into()),
        },
        naive: match option("--guess", "own").as_str() {
            "naive" => true,
            "own" => false,
            other => return Err(format!("no guess {other}").into()),
        },
        starts: option("--starts", "1").parse()?,
        flyable: flag("--flyable"),
        warm: flag("--warm"),
        json: flag("--json"),
    };
    let model = option("--model", "thrust-rate");
    if !["thrust-rate", "rigid-body"].contains(&model.as_str()) {
        return Err(format!("no model {model}").into());
    }
    let rows = solve_all(&std::fs::read_to_string(file)?, &model, &settings)?;
    if settings.json {
        print_json(&rows)
    } else {
        print_table(&rows)
    }
    Ok(())
}
