"""Counts the instructions of one call of each hot kernel by valgrind, and writes them to benches/RESULTS.md.

    python3 benches/instructions.py [NAME ...]

Unlike times they hardly depend on what else the machine does: a change of one per cent is a change of the code. A kernel is run four times and twice,
and half the difference is one call without what sets it up, on storage that is warm.
"""

import argparse
import importlib.util
import json
import pathlib
import re
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent


def peers():
    """The script of the peers, for the marks in RESULTS.md and the words about the machine."""
    spec = importlib.util.spec_from_file_location("peers", HERE / "peers" / "run.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def instructions(program, name, times):
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", program, name, str(times)]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1))


def build():
    """The program of the benchmark `kernels`, built as criterion's are."""
    command = ["cargo", "bench", "--package", "benches", "--bench", "kernels", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return next(file for file in (json.loads(line).get("executable") for line in reversed(lines)) if file)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("names", nargs="*")
    a = arguments.parse_args()
    program = build()
    known = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    rows = ["| kernel | million instructions a call |", "|---|---|"]
    for name in a.names or known:
        count = (instructions(program, name, 4) - instructions(program, name, 2)) / 2
        rows.append(f"| `{name}` | {count / 1e6:.3f} |")
        print(rows[-1], flush=True)
    if not a.names:
        script = peers()
        version = script.output("rustc", "--version")
        script.write("instructions", f"Compiled by {version} for {script.processor()} (vector instructions are chosen at run time).\n\n" + "\n".join(rows))


if __name__ == "__main__":
    main()
