"""Runs this workspace beside every other project that can be had here, and writes benches/RESULTS.md afresh between its marks.

    python3 benches/peers/run.py [--only tours clusters routes trajectories vehicle] [--data DATA] [--target TARGET_FOLDER]

Builds the programs that are measured, makes a virtual environment a peer in TARGET_FOLDER/peers from its requirements.txt, and runs each. A peer
whose packages cannot be installed is named and left out, with its old table in place. DATA holds the instances of `routes` (its README
says which); without it `routes` is left out.
"""

import argparse
import os
import pathlib
import platform
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = HERE.parent / "RESULTS.md"
# Peer: the package and example that it measures, the arguments of its run.py, and whether that writes its table itself.
PEERS = {
    "tours": ("christofides", ["tour", "matching"], lambda examples, data: [examples], True),
    "clusters": ("cluster", ["measure"], lambda examples, data: [examples / "measure"], False),
    "routes": ("mtsp", ["routes"], lambda examples, data: [data, "--binary", examples / "routes"], False),
    "trajectories": ("uav-planner", ["transitions"], lambda examples, data: [examples], True),
    "vehicle": ("quad-dynamics", ["open_loop"], lambda examples, data: [examples.parents[1] / "peers" / "open_loop.csv"], True),
}


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines() if os.path.exists("/proc/cpuinfo") else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def machine(versions):
    """What the tables below were measured on, without a date: the commit has one."""
    rows = [
        ("processor", f"{processor()}, {os.cpu_count()} cores"),
        ("system", f"{platform.system()} {platform.release()}"),
        ("compiler", output("rustc", "--version")),
        ("load at the start", f"{os.getloadavg()[0]:.1f}"),
    ]
    rows += [(name, ", ".join(packages)) for name, packages in versions.items()]
    return "| | |\n|---|---|\n" + "".join(f"| {name} | {value} |\n" for name, value in rows)


def write(name, table):
    """Puts a table between its marks; appended with marks of its own where there are none yet."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
    text = RESULTS.read_text()
    if begin not in text:
        text = text.rstrip("\n") + f"\n\n{begin}{end}\n"
    head, rest = text.split(begin, 1)
    RESULTS.write_text(head + begin + table.rstrip("\n") + "\n" + end + rest.split(end, 1)[1])


def environment(name, target):
    """The peer's own Python, with its packages; and their versions."""
    folder = target / "peers" / name
    python = folder / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    requirements = HERE / name / "requirements.txt"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", requirements], check=True)
    return python, requirements.read_text().split()


def measure(name, python, target, data):
    package, examples, arguments, writes_itself = PEERS[name]
    subprocess.run(["cargo", "build", "--release", "--package", package] + [f"--example={e}" for e in examples], cwd=ROOT, check=True)
    folder = target / "release" / "examples"
    if name == "vehicle":
        (target / "peers" / "open_loop.csv").write_text(output(folder / "open_loop"))
    run = [python, HERE / name / "run.py"] + arguments(folder, data)
    if writes_itself:
        subprocess.run(run, cwd=ROOT, check=True)
    else:
        write(f"{name} peers", subprocess.run(run, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--only", nargs="+", choices=PEERS, default=list(PEERS))
    arguments.add_argument("--data", type=pathlib.Path)
    arguments.add_argument("--target", type=pathlib.Path, default=pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")))
    a = arguments.parse_args()
    target = a.target.resolve()
    os.environ["CARGO_TARGET_DIR"] = str(target)
    (target / "peers").mkdir(parents=True, exist_ok=True)
    data = a.data.resolve() if a.data else None
    done, left_out = {}, {}
    for name in a.only:
        if name == "routes" and data is None:
            left_out[name] = "no --data"
            continue
        try:
            python, packages = environment(name, target)
            measure(name, python, target, data)
            done[name] = packages
        except (subprocess.CalledProcessError, OSError) as error:
            left_out[name] = str(error)
    if done:
        write("machine", machine(done))
    for name, reason in left_out.items():
        print(f"left out: {name}: {reason}", file=sys.stderr)
    print(f"{len(done)} of {len(a.only)} peers run; tables in {RESULTS}")


if __name__ == "__main__":
    main()
