"""Tours and matchings of this workspace and of other projects on the same instances, as a table."""

import csv
import importlib
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE.parents[1] / "RESULTS.md"
# Seconds that a matching by another program may take.
PATIENCE = 60
BEGIN, END = "<!-- christofides peers: begin -->", "<!-- christofides peers: end -->"


def points_of(file):
    rows = file.read_text().split("NODE_COORD_SECTION")[1].split()
    numbers = []
    for word in rows:
        try:
            numbers.append(float(word))
        except ValueError:
            break
    return [(numbers[k + 1], numbers[k + 2]) for k in range(0, len(numbers) - 2, 3)]


def rounded(points):
    return [[int(math.dist(p, q) + 0.5) for q in points] for p in points]


def length(matrix, tour):
    return sum(matrix[a][b] for a, b in zip(tour, tour[1:] + tour[:1]))


def ours(program, file, seconds):
    command = [program / "tour", file, "--json", "--tsplib-rounding", "--seconds", str(seconds)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def fast_tsp(matrix, seconds):
    return importlib.import_module("fast_tsp").find_tour(matrix, duration_seconds=seconds)


def elkai(matrix, _):
    return importlib.import_module("elkai").DistanceMatrix(matrix).solve_tsp(runs=1)[:-1]


def or_tools(matrix, seconds):
    routing = importlib.import_module("ortools.constraint_solver.pywrapcp")
    enums = importlib.import_module("ortools.constraint_solver.routing_enums_pb2")
    manager = routing.RoutingIndexManager(len(matrix), 1, 0)
    model = routing.RoutingModel(manager)
    node = manager.IndexToNode
    model.SetArcCostEvaluatorOfAllVehicles(
        model.RegisterTransitCallback(lambda a, b: matrix[node(a)][node(b)])
    )
    search = routing.DefaultRoutingSearchParameters()
    search.local_search_metaheuristic = enums.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    search.time_limit.FromMilliseconds(int(1000 * seconds))
    solution = model.SolveWithParameters(search)
    if solution is None:
        raise TimeoutError
    tour, index = [], model.Start(0)
    while not model.IsEnd(index):
        tour.append(node(index))
        index = solution.Value(model.NextVar(index))
    return tour


def tours(program):
    optima = {row["name"]: float(row["optimum_tsplib_rounding"]) for row in csv.DictReader(open(HERE / "data/optima.csv"))}
    lines = ["| instance | budget | ours | bound | fast-tsp | elkai (LKH) | OR-Tools |", "|---|---|---|---|---|---|---|"]
    for name, optimum in sorted(optima.items(), key=lambda item: int("".join(filter(str.isdigit, item[0])))):
        file = HERE / "data" / f"{name}.tsp"
        points = points_of(file)
        seconds = 0.02 if len(points) <= 200 else 0.2 if len(points) <= 450 else 0.3
        own = ours(program, file, seconds)
        gap = lambda value: f"{100 * (value / optimum - 1):.2f} %"
        cells = [name, f"{seconds} s", gap(own["length"]), gap(own["lower_bound"])]
        matrix = rounded(points)
        for peer, allowed in ((fast_tsp, seconds), (elkai, None), (or_tools, max(1.0, seconds))):
            try:
                start = time.perf_counter()
                tour = peer(matrix, allowed)
                spent = time.perf_counter() - start
                ratio = spent / own["seconds"]
                cells.append(f"{gap(length(matrix, tour))} in {spent:.2f} s ({ratio:.1f} x)")
            except ImportError:
                cells.append("not installed")
            except TimeoutError:
                cells.append(f"none in {allowed:.2f} s")
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return lines


def instances():
    """Uniform points, and those that are hostile to matching: clusters, triples, duplicates, nested triples."""
    generator = random.Random(1)
    square = lambda: (generator.uniform(0, 1e6), generator.uniform(0, 1e6))
    near = lambda point, spread: (point[0] + generator.gauss(0, spread), point[1] + generator.gauss(0, spread))
    for n in (100, 300, 1000):
        yield f"uniform, {n}", [square() for _ in range(n)]
    n = 1000
    centres = [square() for _ in range(10)]
    yield "clusters, 1000", [near(centres[k % 10], 3000) for k in range(n)]
    centres = [square() for _ in range(n // 3 + 1)]
    yield "triples, 1000", [near(centres[k // 3], 100) for k in range(n)]
    centres = [square() for _ in range(n // 5)]
    yield "duplicates, 1000", [generator.choice(centres) for _ in range(n)]
    corner = lambda k, depth: 2 * math.pi * (k // 3**depth % 3) / 3
    side = [1e6 / 4**depth for depth in range(7)]
    nested = [
        (sum(s * math.cos(corner(k, d)) for d, s in enumerate(side)), sum(s * math.sin(corner(k, d)) for d, s in enumerate(side)))
        for k in range(n)
    ]
    yield "nested triples, 1000", nested


def by_networkx(points, _):
    networkx = importlib.import_module("networkx")
    if len(points) > 300:
        raise TimeoutError
    graph = networkx.Graph()
    pairs = ((i, j) for i in range(len(points)) for j in range(i))
    graph.add_weighted_edges_from((i, j, math.dist(points[i], points[j])) for i, j in pairs)
    start = time.perf_counter()
    mates = networkx.min_weight_matching(graph)
    return time.perf_counter() - start, sum(math.dist(points[i], points[j]) for i, j in mates)


def by_program(program):
    def run(_, file):
        done = subprocess.run([program, file], capture_output=True, text=True, timeout=PATIENCE)
        if done.returncode:
            raise ImportError
        seconds, weight = map(float, done.stdout.split())
        return seconds, weight
    return run


def build(folder):
    """The two peers that are compiled; one that does not build is left out."""
    subprocess.run(["g++", "-O3", "-std=c++17", HERE / "lemon_matching.cc", "-o", folder / "lemon"], check=False)
    manifest = HERE / "blossom/Cargo.toml"
    command = ["cargo", "build", "--release", "--quiet", "--manifest-path", manifest, "--target-dir", folder]
    subprocess.run(command, check=False)
    return by_program(folder / "lemon"), by_program(folder / "release/blossom-peer")


def matchings(program):
    """Exact matching of complete graphs: our time, and of the others the time as a multiple of ours and the excess of weight."""
    lines = ["| points | ours | LEMON | integer-blossom | networkx |", "|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        peers = (*build(pathlib.Path(folder)), by_networkx)
        for name, points in instances():
            file = pathlib.Path(folder) / "points.csv"
            file.write_text("x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in points))
            run = lambda: json.loads(subprocess.run([program / "matching", file, "--json"], capture_output=True, text=True, check=True).stdout)
            own = min((run() for _ in range(3)), key=lambda result: result["seconds"])
            cells = [name, f"{own['seconds'] * 1e3:.2f} ms" + ("" if own["certified"] else ", not certified")]
            for peer in peers:
                try:
                    spent, weight = peer(points, file)
                    cells.append(f"{spent / own['seconds']:.0f} x, {100 * (weight / own['weight'] - 1):+.1e} %")
                except (ImportError, FileNotFoundError):
                    cells.append("not installed")
                except (TimeoutError, subprocess.TimeoutExpired):
                    cells.append("left out")
            lines.append("| " + " | ".join(cells) + " |")
            print(lines[-1], flush=True)
    return lines


def main():
    program = pathlib.Path(sys.argv[1])
    text = "\n".join(
        [BEGIN, "Written by `python benches/peers/tours/run.py TARGET_FOLDER/release/examples`, in one run. Excess over the optimum (TSPLIB's",
         "rounding); a negative bound is below it. In brackets the time as a multiple of ours, which includes the bound.",
         f"Load of the two cores at the start: {os.getloadavg()[0]:.1f}.", ""]
        + tours(program) + ["", "Minimum-weight perfect matching, complete graph: our time, others as a multiple of it with the excess of their weight over ours",
              f"(left out: more than {PATIENCE} s, networkx above 300 points).", ""] + matchings(program) + [END, ""]
    )
    old = RESULTS.read_text() if RESULTS.exists() else "# Results\n\n"
    if BEGIN in old:
        before, rest = old.split(BEGIN)
        RESULTS.write_text(before + text.rstrip("\n") + rest.split(END)[1])
    else:
        RESULTS.write_text(old.rstrip("\n") + "\n\n" + text)


main()
