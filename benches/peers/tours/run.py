"""Tours and matchings of this workspace and of other projects on the same instances, as a table."""

import csv
import importlib
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE.parents[1] / "RESULTS.md"
BEGIN, END = "<!-- christofides: begin -->", "<!-- christofides: end -->"


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
                cells.append(f"{gap(length(matrix, tour))} in {spent:.2f} s")
            except ImportError:
                cells.append("not installed")
            except TimeoutError:
                cells.append(f"none in {allowed:.2f} s")
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return lines


def matchings(program):
    """Exact matching of uniform points; networkx is the exact general matching that pip gives."""
    lines = ["| points | ours | networkx | ratio of time | weights differ by |", "|---|---|---|---|---|"]
    for n in (50, 100, 200):
        generator = random.Random(n)
        points = [(generator.randrange(10**6), generator.randrange(10**6)) for _ in range(n)]
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("x,y\n" + "".join(f"{x},{y}\n" for x, y in points))
            file.flush()
            run = subprocess.run([program / "matching", file.name, "--json"], capture_output=True, text=True, check=True)
        own = json.loads(run.stdout)
        try:
            networkx = importlib.import_module("networkx")
        except ImportError:
            continue
        graph = networkx.Graph()
        graph.add_weighted_edges_from((i, j, math.dist(points[i], points[j])) for i in range(n) for j in range(i))
        start = time.perf_counter()
        mates = networkx.min_weight_matching(graph)
        spent = time.perf_counter() - start
        weight = sum(math.dist(points[i], points[j]) for i, j in mates)
        cells = [n, f"{own['seconds'] * 1e3:.3f} ms", f"{spent * 1e3:.0f} ms", f"{spent / own['seconds']:.0f}", f"{own['weight'] / weight - 1:.1e}"]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
        print(lines[-1], flush=True)
    return lines


def main():
    program = pathlib.Path(sys.argv[1])
    text = "\n".join(
        [BEGIN, "## christofides", "", "Excess over the optimum (TSPLIB's rounding); a negative bound is below it. One run, written by",
         "`benches/peers/tours/run.py`; the times are of whatever else the machine did.", ""]
        + tours(program) + ["", "Minimum-weight perfect matching, complete graph:", ""] + matchings(program) + [END, ""]
    )
    old = RESULTS.read_text() if RESULTS.exists() else "# Results\n\n"
    if BEGIN in old:
        before, rest = old.split(BEGIN)
        old = before + rest.split(END)[1].lstrip("\n")
    RESULTS.write_text(old.rstrip("\n") + "\n\n" + text)


main()
