"""Flies the same open-loop rotor commands in RotorPy and compares with the CSV of the example `open_loop`.

    pip install -r requirements.txt
    cargo run --release -p quad-dynamics --example open_loop -- hummingbird 5 > ours.csv
    python run.py ours.csv

Physics switched on in both: gravity, thrust, torques, first-order rotor lag, parasitic drag per axis, rotor drag, steady wind.
Off in both (or absent): translational lift, flapping, motor noise, ground.
"""

import pathlib
import sys
import time

import numpy as np
from rotorpy.vehicles.multirotor import Multirotor

TAU = 2 * np.pi / 60
K_ETA = 6.11e-8 / TAU**2
K_M = 1.5e-9 / TAU**2
ARM = 0.17

# The preset `hummingbird` of quad-dynamics, in RotorPy's terms; drag there is c v^2, here c/2 v^2.
PARAMS = {
    "mass": 0.5,
    "Ixx": 3.65e-3, "Iyy": 3.68e-3, "Izz": 7.03e-3, "Ixy": 0.0, "Iyz": 0.0, "Ixz": 0.0,
    "num_rotors": 4,
    "rotor_pos": {
        "r1": np.array([ARM, 0, 0]), "r2": np.array([-ARM, 0, 0]),
        "r3": np.array([0, ARM, 0]), "r4": np.array([0, -ARM, 0]),
    },
    "rotor_directions": np.array([1, 1, -1, -1]),
    "rI": np.zeros(3),
    "c_Dx": 0.005, "c_Dy": 0.005, "c_Dz": 0.01,
    "k_eta": K_ETA, "k_m": K_M, "k_d": 1.19e-4, "k_z": 2.32e-4, "k_h": 0.0, "k_flap": 0.0,
    "tau_m": 0.05, "rotor_speed_min": 0.0, "rotor_speed_max": 7800 * TAU, "motor_noise_std": 0.0,
}


def main():
    ours = np.genfromtxt(sys.argv[1], delimiter=",", names=True)
    hover = np.sqrt(0.5 * 9.81 / 4 / K_ETA)
    state = {
        "x": np.zeros(3), "v": np.zeros(3), "q": np.array([0.0, 0.0, 0.0, 1.0]), "w": np.zeros(3),
        "wind": np.array([1.0, -0.5, 0.2]), "rotor_speeds": np.full(4, hover),
    }
    vehicle = Multirotor(PARAMS, state, integrator_kwargs={"method": "RK45", "rtol": 1e-10, "atol": 1e-12})
    step = 0.01
    rows = []
    for k in range(len(ours)):
        t = k * step
        rows.append(np.concatenate([state["x"], state["v"]]))
        wobble = 0.004 * np.sin(2.0 * t + np.arange(4)) + 0.01 * np.sin(0.7 * t)
        state = vehicle.step(state, {"cmd_motor_speeds": hover * (1 + wobble)}, step)
    theirs = np.array(rows)
    mine = np.column_stack([ours[n] for n in ("x", "y", "z", "vx", "vy", "vz")])
    distance = np.linalg.norm(theirs[:, :3] - mine[:, :3], axis=1)
    rows = [
        ("distance flown to the end", f"{np.linalg.norm(theirs[-1, :3]):.2f} m in {t:.1f} s"),
        ("greatest difference in position", f"{distance.max():.1e} m"),
        ("greatest difference in velocity", f"{np.abs(theirs[:, 3:] - mine[:, 3:]).max():.1e} m/s"),
    ]

    # Rate with RotorPy's own default integrator settings at 500 Hz, dynamics only.
    vehicle = Multirotor(PARAMS, state)
    n = 1000
    begin = time.perf_counter()
    for _ in range(n):
        state = vehicle.step(state, {"cmd_motor_speeds": np.full(4, hover)}, 0.002)
    seconds = time.perf_counter() - begin
    rate = f"{n / seconds:.0f} steps/s, {n * 0.002 / seconds:.2f} times real time"
    rows.append(("RotorPy 2.1.3, dynamics alone at 500 Hz", rate))
    table = "".join(f"| {name} | {value} |\n" for name, value in rows)
    write("| open-loop rotor commands, preset `hummingbird` | ours against RotorPy |\n|---|---|\n" + table)


def write(table):
    """Prints the table and puts it between its marks in RESULTS.md, if they are there."""
    print(table, end="")
    path = pathlib.Path(__file__).parents[2] / "RESULTS.md"
    begin, end = "<!-- quad-dynamics peers: begin -->\n", "<!-- quad-dynamics peers: end -->"
    text = path.read_text() if path.exists() else ""
    if begin in text and end in text:
        head, rest = text.split(begin, 1)
        path.write_text(head + begin + table + end + rest.split(end, 1)[1])


if __name__ == "__main__":
    main()
