"""Runs OR-Tools, PyVRP, VROOM and this workspace on the same min-max instances, in the same run, and prints a table.

    pip install -r requirements.txt
    python run.py DATA [--seconds 1 10] [--names pm lib large] [--out FILE]

DATA is a folder with `mtsp/` (CSV instances and best_known.csv) and `tsplib/`. None of the three has the objective natively: OR-Tools gets
a span cost on the distance dimension and a cap on it, PyVRP and VROOM a bisection on the distance limit of each vehicle. Distances are scaled to
integers for them (1/1000 of the unit); every answer is measured again here with plain Euclidean distances.
"""

import argparse, csv, datetime, json, math, pathlib, subprocess, sys, time

SCALE = 1000
LEVEL = 1  # VROOM's exploration: an attempt takes 0.2 s, so that there is time for several limits


def read_nodes(path):
    nodes = []
    for line in path.read_text().splitlines():
        words = line.replace(",", " ").split()
        try:
            numbers = [float(w) for w in words]
        except ValueError:
            continue
        if len(numbers) >= 2:
            nodes.append(tuple(numbers[-2:]))
    return nodes


def distances(nodes):
    return [[math.dist(a, b) for b in nodes] for a in nodes]


def makespan(d, routes, n):
    assert sorted(t for r in routes for t in r) == list(range(1, n)), "not every target once"
    length = lambda r: sum(d[a][b] for a, b in zip([0] + r, r + [0])) if r else 0.0
    return max(map(length, routes))


def integers(d):
    return [[round(SCALE * x) for x in row] for row in d]


def ours(path, nodes, d, m, seconds, binary):
    command = [binary, str(path), "--vehicles", str(m), "--seconds", str(seconds), "--json"]
    return json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)["routes"]


def likely(d, m):
    """A length that all routes can keep: the farthest target's with some way around, or a share of the tour (its length for uniform points)."""
    radius = max(d[0])
    tour = 0.7124 * len(d) ** 0.5 * 2 * radius / 2**0.5
    return max(2.6 * radius, radius + 1.3 * tour / m)


def ortools(path, nodes, d, m, seconds, _):
    from ortools.constraint_solver import pywrapcp, routing_enums_pb2 as enums

    # Coarser, and with a cap on the length: 2 s on pm_s1 give 2960 m, without the cap 7338 m, capped on the finer scale 3023 m.
    scale = 1 if max(d[0]) > 500 else SCALE
    matrix = [[round(scale * x) for x in row] for row in d]
    manager = pywrapcp.RoutingIndexManager(len(nodes), m, 0)
    routing = pywrapcp.RoutingModel(manager)
    leg = routing.RegisterTransitMatrix(matrix)
    routing.SetArcCostEvaluatorOfAllVehicles(leg)
    routing.AddDimension(leg, 0, int(1.2 * scale * likely(d, m)), True, "length")
    routing.GetDimensionOrDie("length").SetGlobalSpanCostCoefficient(100)
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    parameters.first_solution_strategy = enums.FirstSolutionStrategy.PARALLEL_CHEAPEST_INSERTION
    parameters.local_search_metaheuristic = enums.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    parameters.time_limit.FromMilliseconds(int(1000 * seconds))
    found = routing.SolveWithParameters(parameters)
    routes = []
    for vehicle in range(m):
        route, index = [], found.Value(routing.NextVar(routing.Start(vehicle)))
        while not routing.IsEnd(index):
            route.append(manager.IndexToNode(index))
            index = found.Value(routing.NextVar(index))
        routes.append(route)
    return routes


def bisect(d, m, seconds, attempt):
    """The routes of the least limit that `attempt(limit, seconds)` meets, in eight attempts."""
    low = 2 * max(d[0])
    high = likely(d, m)
    best, end = None, time.monotonic() + seconds
    share = seconds / 8
    while time.monotonic() + share / 2 < end or (best is None and time.monotonic() < end + 5 * seconds):
        limit = high if best is None else (low + high) / 2
        routes = attempt(limit, share)
        if routes is not None:
            n = len(d)
            value = makespan(d, routes, n)
            if best is None or value < best[0]:
                best = (value, routes)
            high = min(value, limit)
        elif best is None:
            high *= 1.3
        else:
            low = limit
        if high - low < 1e-4 * high:
            break
    return best[1]


def pyvrp(path, nodes, d, m, seconds, _):
    from pyvrp import Model
    from pyvrp.stop import MaxRuntime, FirstFeasible, MultipleCriteria

    matrix = integers(d)

    def attempt(limit, share):
        model = Model()
        places = [model.add_location(int(x * SCALE), int(y * SCALE)) for x, y in nodes]
        depot = model.add_depot(places[0])
        for place in places[1:]:
            model.add_client(place)
        model.add_vehicle_type(m, start_depot=depot, end_depot=depot, max_distance=int(limit * SCALE))
        for i, a in enumerate(places):
            for j, b in enumerate(places):
                if i != j:
                    model.add_edge(a, b, distance=matrix[i][j])
        stop = MultipleCriteria([MaxRuntime(share), FirstFeasible()])
        result = model.solve(stop=stop, display=False)
        if not result.is_feasible():
            return None
        # An activity prints as D0 (depot) or C<position among the clients>.
        names = [[str(activity) for activity in route] for route in result.best.routes()]
        routes = [[int(name[1:]) + 1 for name in route if name[0] == "C"] for route in names]
        return routes + [[]] * (m - len(routes))

    return bisect(d, m, seconds, attempt)


def vroom(path, nodes, d, m, seconds, _):
    import numpy, vroom as v

    # VROOM multiplies durations again inside: a coarser scale keeps them in range.
    scale = SCALE // 100
    matrix = numpy.array([[round(scale * x) for x in row] for row in d], dtype=numpy.uint32)

    def attempt(limit, share):
        problem = v.Input()
        problem.set_distances_matrix("car", matrix)
        problem.set_durations_matrix("car", matrix)
        problem.add_vehicle([v.Vehicle(i, start=0, end=0, max_travel_time=int(limit * scale)) for i in range(m)])
        problem.add_job([v.Job(i, location=i) for i in range(1, len(nodes))])
        found = problem.solve(exploration_level=LEVEL, nb_threads=1, timeout=datetime.timedelta(seconds=share))
        if found.summary.unassigned:
            return None
        routes = [[] for _ in range(m)]
        for _, step in found.routes[found.routes.type == "job"].iterrows():
            routes[int(step.vehicle_id)].append(int(step.id))
        return routes

    return bisect(d, m, seconds, attempt)


SOLVERS = {"ours": ours, "OR-Tools": ortools, "PyVRP": pyvrp, "VROOM": vroom}


def instances(data, names):
    if "pm" in names:
        for seed in range(1, 11):
            yield f"pm_s{seed}", data / "mtsp" / f"pm_s{seed}.csv", 8, None
    for row in csv.DictReader((data / "mtsp" / "best_known.csv").open()):
        name = row["name"]
        group = "lib" if name in ("eil51", "berlin52", "eil76", "rat99") else "large" if name == "rat783" else "set1"
        if group in names:
            path = data / "tsplib" / f"{name}.tsp"
            path = path if path.exists() else data / "mtsp" / f"{name}.csv"
            yield name, path, int(row["vehicles"]), float(row["best_known_min_max"])


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("data", type=pathlib.Path)
    arguments.add_argument("--seconds", type=float, nargs="+", default=[1.0, 10.0])
    arguments.add_argument("--names", nargs="+", default=["pm"])
    arguments.add_argument("--solvers", nargs="+", default=list(SOLVERS))
    arguments.add_argument("--binary", default="target/release/examples/routes")
    a = arguments.parse_args()
    columns = [(s, t) for s in a.solvers for t in a.seconds]
    print("| instance | m | best known | " + " | ".join(f"{s} {t:g} s" for s, t in columns) + " |")
    print("|---" * (3 + len(columns)) + "|")
    sums = {c: [] for c in columns}
    for name, path, m, known in instances(a.data, a.names):
        nodes = read_nodes(path)
        d = distances(nodes)
        cells = []
        for solver, seconds in columns:
            try:
                value = makespan(d, SOLVERS[solver](path, nodes, d, m, seconds, a.binary), len(nodes))
                sums[solver, seconds].append(value)
                cells.append(f"{value:.1f}")
            except Exception as error:
                cells.append("failed")
                print(f"{solver} on {name}: {error!r}", file=sys.stderr)
        print(f"| {name} | {m} | {'' if known is None else known} | " + " | ".join(cells) + " |", flush=True)
    mean = lambda v: f"{sum(v) / len(v):.1f}" if v else "-"
    print("| mean | | | " + " | ".join(mean(sums[c]) for c in columns) + " |")


if __name__ == "__main__":
    main()
