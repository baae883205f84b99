"""Runs scikit-learn, faiss, SciPy, fastcluster and this workspace on the same points, in the same run, and prints two tables.

    pip install -r requirements.txt
    cargo build --release -p cluster --example measure
    python run.py TARGET_FOLDER/release/examples/measure

One thread. k-means with the same number of restarts for all (faiss seeds at random and stops after 25 iterations: its own defaults), inertia and
time as means over SEEDS seeds; inertia is computed here, in double precision. Linkage: the least time of RUNS runs.
"""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import pathlib, subprocess, sys, tempfile, time

import faiss, fastcluster, numpy
from scipy.cluster.hierarchy import linkage
from scipy.spatial import cKDTree
from sklearn.cluster import KMeans

RUNS = 3
SEEDS = 10


def least_time(run):
    times = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        value = run()
        times.append(time.perf_counter() - begin)
    return value, min(times)


def inertia(points, centroids):
    return float((cKDTree(centroids).query(points)[0] ** 2).sum())


def ours(binary, points, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "points.csv"
        file.write_text("".join(f"{x!r},{y!r}\n" for x, y in points.tolist()))
        command = [binary, str(file), *map(str, arguments), str(RUNS)]
        value, seconds = subprocess.run(command, capture_output=True, check=True, text=True).stdout.split()
    return float(value), float(seconds)


def by_faiss(points, k, restarts, seed):
    data = points.astype(numpy.float32)
    # faiss drops points beyond 256 a cluster unless told otherwise.
    options = {"max_points_per_centroid": len(points), "min_points_per_centroid": 1, "seed": seed + 1}
    means = faiss.Kmeans(2, k, nredo=restarts, **options)
    means.train(data)
    return means.centroids.astype(float)


def by_scikit_learn(points, k, restarts, seed):
    return KMeans(k, n_init=restarts, random_state=seed).fit(points).cluster_centers_


def mean_over_seeds(points, k, restarts, fit):
    values, times = [], []
    for seed in range(SEEDS):
        begin = time.perf_counter()
        centroids = fit(points, k, restarts, seed)
        times.append(time.perf_counter() - begin)
        values.append(inertia(points, centroids))
    return numpy.mean(values), numpy.mean(times)


def main():
    binary = sys.argv[1]
    print(f"Load of the cores at the start: {os.getloadavg()[0]:.1f}.\n")
    print("| points | k | restarts | ours | scikit-learn | faiss |")
    print("|---|---|---|---|---|---|")
    for n, k, restarts in ((100, 8, 1), (100, 8, 10), (1000, 30, 10), (100_000, 8, 1), (100_000, 64, 1), (100_000, 256, 1)):
        points = numpy.random.default_rng(n + k).random((n, 2))
        runs = [ours(binary, points, "kmeans", k, restarts, seed) for seed in range(SEEDS)]
        value, seconds = numpy.mean(runs, axis=0)
        cells = [f"{value:.6g} in {1000 * seconds:.3g} ms"]
        for fit in (by_scikit_learn, by_faiss):
            other, time_taken = mean_over_seeds(points, k, restarts, fit)
            cells.append(f"{100 * (other / value - 1):+.2f} % in {1000 * time_taken:.3g} ms")
        print(f"| {n} | {k} | {restarts} | " + " | ".join(cells) + " |", flush=True)
    print("\n| complete linkage | ours | SciPy | fastcluster | heights differ by |")
    print("|---|---|---|---|---|")
    for n in (500, 2000, 5000):
        points = numpy.random.default_rng(n).random((n, 2))
        value, seconds = ours(binary, points, "complete")
        cells, worst = [f"{1000 * seconds:.3g} ms"], 0.0
        for run in (lambda: linkage(points, "complete"), lambda: fastcluster.linkage(points, "complete")):
            tree, time_taken = least_time(run)
            cells.append(f"{1000 * time_taken:.3g} ms")
            worst = max(worst, abs(tree[:, 2].sum() / value - 1))
        print(f"| {n} points | " + " | ".join(cells) + f" | {worst:.1e} |", flush=True)


if __name__ == "__main__":
    main()
