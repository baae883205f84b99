"""Minimum-time transitions by this workspace's `traj-opt` and by CasADi with IPOPT and with FATROP, as a table."""

import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import time

os.environ["OMP_NUM_THREADS"] = "1"

import casadi as ca

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE.parents[2] / "planner/tests/data/transitions.csv"
RESULTS = HERE.parents[1] / "RESULTS.md"
BEGIN, END = "<!-- traj-opt peers: begin -->\n", "<!-- traj-opt peers: end -->"
SEGMENTS = 40
OURS = "traj-opt, naive guess, "
TRANSCRIPTIONS = ("Hermite-Simpson", "trapezoidal", "Runge-Kutta")
TOLERANCE = 1e-6
MASS, GRAVITY, DRAG = 1.5, 9.81, 0.15
MOST = 2 * MASS * GRAVITY
INERTIA = ca.DM([0.015, 0.015, 0.028])
ARM, YAW = 0.225 / math.sqrt(2), 0.016
RATES = [6.0, 6.0, 2.0]
AXES = ["px", "py", "pz", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz"]
# What of the state is fixed at the end as it is; the attitude is by three equations of its own.
FIXED = {10: [0, 1, 2, 3, 4, 5], 13: [0, 1, 2, 3, 4, 5, 10, 11, 12]}


def dynamics(nx):
    """x' = f(x, u): collective thrust and body rates (nx = 10) or rotor thrusts (nx = 13), as in the table's README."""
    x, u = ca.SX.sym("x", nx), ca.SX.sym("u", 4)
    v, q = x[3:6], x[6:10]
    w, a, b, c = ca.vertsplit(q)
    up = ca.vertcat(2 * (a * c + w * b), 2 * (b * c - w * a), w * w - a * a - b * b + c * c) / ca.sumsqr(q)
    thrust, rates = (u[0], u[1:4]) if nx == 10 else (ca.sum1(u), x[10:13])
    # the square root has no second derivative at rest
    speed = ca.sqrt(ca.sumsqr(v) + 1e-12)
    acceleration = up * thrust / MASS - ca.DM([0, 0, GRAVITY]) - 0.5 * DRAG / MASS * speed * v
    p, r, s = ca.vertsplit(rates)
    turn = 0.5 * ca.vertcat(-a * p - b * r - c * s, w * p + b * s - c * r, w * r + c * p - a * s, w * s + a * r - b * p)
    parts = [v, acceleration, turn]
    if nx == 13:
        f = ca.vertsplit(u)
        torque = ca.vertcat(
            ARM * (-f[0] + f[1] + f[2] - f[3]), ARM * (-f[0] + f[1] - f[2] + f[3]), YAW * (f[0] + f[1] - f[2] - f[3])
        )
        parts.append((torque - ca.cross(rates, INERTIA * rates)) / INERTIA)
    return ca.Function("f", [x, u], [ca.vertcat(*parts)])


def bounds(nx):
    """Lower and upper bounds of controls and of states between the ends."""
    if nx == 10:
        return [0.05 * MOST] + [-r for r in RATES], [MOST] + RATES, [-ca.inf] * nx, [ca.inf] * nx
    free = [ca.inf] * 10
    return [0.05 * MOST / 4] * 4, [MOST / 4] * 4, [-f for f in free] + [-r for r in RATES], free + RATES


def attitude_error(q, target):
    """Vector part of the rotation from the target: three equations, blind to the sign."""
    w, a, b, c = ca.vertsplit(q)
    tw, tx, ty, tz = ca.vertsplit(target)
    return ca.vertcat(
        tw * a - tx * w - ty * c + tz * b, tw * b - ty * w - tz * a + tx * c, tw * c - tz * w - tx * b + ty * a
    )


def end_error(nx, x, end):
    return ca.vertcat(x[FIXED[nx]] - end[FIXED[nx]], attitude_error(x[6:10], end[6:10]))


def runge_kutta(nx):
    f = dynamics(nx)
    x, u, h = ca.SX.sym("x", nx), ca.SX.sym("u", 4), ca.SX.sym("h")
    k1 = f(x, u)
    k2 = f(x + h / 2 * k1, u)
    k3 = f(x + h / 2 * k2, u)
    k4 = f(x + h * k3, u)
    return ca.Function("step", [x, u, h], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])


def defects(nx, transcription):
    """Residual of one segment as a function of both nodes and (Hermite-Simpson, compressed) the control in the middle."""
    f = dynamics(nx)
    x, u, y, z, m, h = (ca.SX.sym(n, k) for n, k in zip("xuyzmh", (nx, 4, nx, 4, 4, 1)))
    fx, fy = f(x, u), f(y, z)
    if transcription == "trapezoidal":
        gap = y - x - h / 2 * (fx + fy)
    else:
        middle = (x + y) / 2 + h / 8 * (fx - fy)
        gap = y - x - h / 6 * (fx + 4 * f(middle, m) + fy)
    return ca.Function("gap", [x, u, y, z, m, h], [gap])


COMPILED = {
    "print_time": False, "error_on_fail": False, "jit": True, "compiler": "shell",
    "jit_options": {"flags": ["-O2"], "verbose": False},
}


def ipopt(nx, transcription):
    n, inf = SEGMENTS, ca.inf
    X, U, M, T = ca.MX.sym("X", nx, n + 1), ca.MX.sym("U", 4, n + 1), ca.MX.sym("M", 4, n), ca.MX.sym("T")
    P = ca.MX.sym("P", 2 * nx)
    gap = defects(nx, transcription).map(n)
    gaps = gap(X[:, :-1], U[:, :-1], X[:, 1:], U[:, 1:], M, ca.repmat(T / n, 1, n))
    g = ca.vertcat(X[:, 0] - P[:nx], ca.vec(gaps), end_error(nx, X[:, -1], P[nx:]))
    lu, uu, lx, ux = bounds(nx)
    ends = lambda b, free: [free] * nx + b * (n - 1) + [free] * nx
    low = ends(lx, -inf) + lu * (n + 1) + lu * n + [0.05]
    high = ends(ux, inf) + uu * (n + 1) + uu * n + [500]
    options = {"print_level": 0, "sb": "yes", "tol": TOLERANCE, "max_iter": 1000}
    nlp = {"x": ca.veccat(X, U, M, T), "f": T, "g": g, "p": P}
    solver = ca.nlpsol("s", "ipopt", nlp, {**COMPILED, "ipopt": options})

    def solve(start, end, guess):
        states, control, t = guess
        controls = control * (2 * n + 1)
        x0 = [v for s in states for v in s] + controls + [t]
        begin = time.process_time()
        r = solver(x0=x0, lbx=low, ubx=high, lbg=0, ubg=0, p=start + end)
        return solver.stats(), time.process_time() - begin, float(r["f"])

    return solve


def fatrop(nx, loose):
    """Runge-Kutta steps of constant controls; the final time is a state. Rows in the order that FATROP's structure asks for."""
    n, step = SEGMENTS, runge_kutta(nx)
    P = ca.MX.sym("P", 2 * nx)
    xs = [ca.MX.sym(f"x{k}", nx + 1) for k in range(n + 1)]
    us = [ca.MX.sym(f"u{k}", 4) for k in range(n)]
    lu, uu, _, _ = bounds(nx)
    g, low, high, equality = [], [], [], []

    def add(row, lower, upper):
        g.append(row)
        low.extend(lower)
        high.extend(upper)
        equality.extend(a == b for a, b in zip(lower, upper))

    for k in range(n + 1):
        x, t = xs[k][:nx], xs[k][nx]
        if k < n:
            add(xs[k + 1] - ca.vertcat(step(x, us[k], t / n), t), [0] * (nx + 1), [0] * (nx + 1))
            add(us[k], lu, uu)
        if k == 0:
            add(x - P[:nx], [0] * nx, [0] * nx)
            add(t, [0.05], [500])
        elif k < n and nx == 13:
            add(x[10:13], [-r for r in RATES], RATES)
        elif k == n:
            error = end_error(nx, x, P[nx:])
            add(error, [-loose] * error.numel(), [loose] * error.numel())
    w = [v for k in range(n) for v in (xs[k], us[k])] + [xs[n]]
    nlp = {"x": ca.veccat(*w), "f": xs[n][nx], "g": ca.vertcat(*g), "p": P}
    options = {
        **COMPILED, "structure_detection": "auto", "equality": equality,
        "fatrop": {"print_level": 0, "tol": TOLERANCE, "max_iter": 1000},
    }
    solver = ca.nlpsol("s", "fatrop", nlp, options)

    def solve(start, end, guess):
        states, control, t = guess
        x0 = [v for k in range(n) for v in (*states[k], t, *control)] + [*states[n], t]
        begin = time.process_time()
        r = solver(x0=x0, lbg=low, ubg=high, p=start + end)
        return solver.stats(), time.process_time() - begin, float(r["f"])

    return solve


def naive(nx, start, end):
    """Straight line, level attitude, distance over speed: the guess `--guess naive` of the example."""
    p0, p1 = start[:3], end[:3]
    speed = 0.5 * (math.hypot(*start[3:6]) + math.hypot(*end[3:6]))
    t = max(math.dist(p0, p1) / max(speed, 5.0), 0.5)
    v = [(b - a) / t for a, b in zip(p0, p1)]
    at = lambda s: [a + (b - a) * s for a, b in zip(p0, p1)] + v + [1.0, 0.0, 0.0, 0.0] + [0.0] * (nx - 10)
    weight = MASS * GRAVITY
    control = [weight, 0.0, 0.0, 0.0] if nx == 10 else [weight / 4] * 4
    return [at(k / SEGMENTS) for k in range(SEGMENTS + 1)], control, t


def of_table(solve, nx, rows):
    """Seconds of the processor and times of flight, a pair for each row; nothing where it failed."""
    out = []
    for row in rows:
        start, end = ([float(row[f"{side}_{a}"]) for a in AXES[:nx]] for side in ("start", "end"))
        stats, seconds, t = solve(start, end, naive(nx, start, end))
        out.append((1e3 * seconds, t if stats["success"] else None))
    return out


def ours(program, model, *flags):
    command = [program, TABLE, "--json", "--model", model, *flags]
    rows = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    good = ("solved", "flyable")
    return [(r["milliseconds"], r["t_f"] if r["status"] in good else None) for r in rows]


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) * share // 100, len(values) - 1)]


def report(rows, model, column, runs):
    """A line for each run. Ratios to `traj-opt` from the same guess: by Hermite-Simpson, and by the transcription of the run itself."""
    reference = [float(r[column]) for r in rows]
    median = lambda name: statistics.median(ms for ms, _ in runs[name])
    lines = []
    for name, run in runs.items():
        ms = [m for m, _ in run]
        solved = sum(t is not None for _, t in run)
        near = sum(t is not None and t <= r * 1.001 for (_, t), r in zip(run, reference))
        ratio = median(name) / median(OURS + "Hermite-Simpson")
        same = next((t for t in TRANSCRIPTIONS if t in name), None)
        alike = f"{median(name) / median(OURS + same):.1f}" if same else ""
        lines.append(
            f"| {model} | {name} | {solved} of {len(run)} | {near} | {median(name):.1f} | {percentile(ms, 95):.1f} | {ratio:.1f} | {alike} |"
        )
    return lines


def main():
    program = pathlib.Path(sys.argv[1]) / "transitions"
    rows = list(csv.DictReader(open(TABLE)))
    lines = ["| model | solver | solved | within | ms, median | 95 % | ratio | same transcription |", "|---|---|---|---|---|---|---|---|"]
    for model, nx, column in (("thrust-rate", 10, "tfA_hs80"), ("rigid-body", 13, "tfB_hs80")):
        runs = {
            OURS + name: ours(program, model, "--guess", "naive", "--transcription", name.lower(), "--substeps", "1")
            for name in TRANSCRIPTIONS
        }
        runs["traj-opt, own guess"] = ours(program, model)
        runs["traj-opt, own guess, flyable"] = ours(program, model, "--flyable")
        runs["FATROP, Runge-Kutta"] = of_table(fatrop(nx, 0.0), nx, rows)
        runs["FATROP, Runge-Kutta, end within 1e-4"] = of_table(fatrop(nx, 1e-4), nx, rows)
        for transcription in ("trapezoidal", "Hermite-Simpson"):
            runs[f"IPOPT, {transcription}"] = of_table(ipopt(nx, transcription), nx, rows)
        lines += report(rows, model, column, runs)
    table = "\n".join(lines) + "\n"
    print(table, end="")
    text = RESULTS.read_text() if RESULTS.exists() else ""
    if BEGIN in text and END in text:
        head, rest = text.split(BEGIN, 1)
        RESULTS.write_text(head + BEGIN + table + END + rest.split(END, 1)[1])


if __name__ == "__main__":
    main()
