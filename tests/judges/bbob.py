#!/usr/bin/env python3
"""Our strategies on COCO's BBOB suite, through `horsehead ask-tell`, beside pycma.

    python3 -m venv judges && judges/bin/pip install coco-experiment cma
    judges/bin/python tests/judges/bbob.py --horsehead target/release/horsehead --out bbob

24 functions, 5 instances, dimensions 2, 5 and 10, 1,000 evaluations per dimension by default. Every run is a line
of OUT/runs.csv with the evaluations after which each target precision (10^2 to 10^-8, fifty-one of them) was
reached; what stands there is not run again. At the end the area under the ECDF over log10(evaluations /
dimension) by solver and dimension is printed and kept in OUT/areas.csv, and OUT/ecdf.svg drawn.
"""
import argparse
import csv
import json
import math
import os
import random
import subprocess
import sys
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")
import cocoex  # noqa: E402

TARGETS = [10 ** (2 - 0.2 * k) for k in range(51)]
PYCMA = "pycma"


def numbers(text):
    """`1-3,7` as a list."""
    parts = [part.split("-") for part in text.split(",")]
    return [n for part in parts for n in range(int(part[0]), int(part[-1]) + 1)]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--horsehead", type=Path, required=True, help="the program that is judged")
    parser.add_argument("--out", type=Path, required=True, help="where results go")
    parser.add_argument("--solvers", default=f"cma-es,l-shade,{PYCMA}", help="strategies of ask-tell, and pycma")
    parser.add_argument("--functions", type=numbers, default="1-24")
    parser.add_argument("--instances", type=numbers, default="1-5")
    parser.add_argument("--dimensions", type=numbers, default="2,5,10")
    parser.add_argument("--budget", type=int, default=1000, help="evaluations per dimension")
    return parser.parse_args()


class Measured:
    """A problem that notes after how many evaluations each target was reached."""

    def __init__(self, problem, optimum):
        self.problem, self.optimum = problem, optimum
        self.evaluations, self.reached = 0, []

    def __call__(self, x):
        f = self.problem(x)
        self.evaluations += 1
        while len(self.reached) < len(TARGETS) and f - self.optimum <= TARGETS[len(self.reached)]:
            self.reached.append(self.evaluations)
        return f


def optimum(suite, number):
    """Least value of a problem: the suite writes its place into a file."""
    problem = suite.get_problem(number)
    problem._best_parameter("print")
    place = Path("._bbob_problem_best_parameter.txt")
    f = problem([float(x) for x in place.read_text().split()])
    place.unlink()
    problem.free()
    return f


def with_ask_tell(program, strategy, problem, dimension, budget, seed):
    """Drives one of our strategies until it has asked for its budget."""
    axes = [{"name": f"x{k}", "lower": -5, "upper": 5, "scale": "linear", "start": 0} for k in range(dimension)]
    settings = {"evaluations": budget} if strategy in ("cma-es", "l-shade") else {}
    opening = {"space": axes, "seed": seed, "budget": budget, "settings": settings}
    with subprocess.Popen([program, "ask-tell", strategy], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as peer:
        line = opening
        while True:
            peer.stdin.write(json.dumps(line) + "\n")
            peer.stdin.flush()
            said = json.loads(peer.stdout.readline())
            if "error" in said:
                sys.exit(f"{strategy}: {said['error']}; {said['help']}")
            if "done" in said:
                return
            line = {"tell": [{"id": one["id"], "f": problem(one["x"])} for one in said["ask"]]}


def with_pycma(problem, dimension, budget, seed):
    """pycma with restarts of growing populations, from the same start as ours."""
    import cma

    chance = random.Random(seed)
    population, left = 1, lambda: budget - problem.evaluations
    first = True
    while left() > 0:
        options = {
            "bounds": [-5, 5], "maxfevals": left(), "verbose": -9, "seed": seed + 1000 * population,
            "popsize": (4 + int(3 * math.log(dimension))) * population, "verb_log": 0,
        }
        start = [0.0 if first else chance.uniform(-5, 5) for _ in range(dimension)]
        cma.fmin(problem, start, 2.5, options)
        first, population = False, 2 * population


def run(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.out / "runs.csv"
    head = ["solver", "function", "dimension", "instance", "evaluations"] + [f"{t:.2e}" for t in TARGETS]
    done = {}
    if path.exists():
        for row in csv.reader(path.open()):
            if len(row) == len(head) and row[0] != "solver":
                done[tuple(row[:4])] = row
    else:
        path.write_text(",".join(head) + "\n")
    # the suite writes a file into the current folder
    program = arguments.horsehead.resolve()
    path = path.resolve()
    os.chdir(arguments.out)
    listed = lambda values: ",".join(map(str, values))
    wanted = [
        (solver, function, dimension, instance)
        for dimension in arguments.dimensions
        for function in arguments.functions
        for instance in arguments.instances
        for solver in arguments.solvers.split(",")
    ]
    for number, (solver, function, dimension, instance) in enumerate(wanted, 1):
        key = (solver, str(function), str(dimension), str(instance))
        if key in done:
            continue
        options = f"dimensions:{dimension} function_indices:{function} instance_indices:{instance}"
        suite = cocoex.Suite("bbob", "", options)
        least = optimum(suite, 0)
        problem = Measured(suite.get_problem(0), least)
        budget = arguments.budget * dimension
        if solver == PYCMA:
            with_pycma(problem, dimension, budget, instance)
        else:
            with_ask_tell(program, solver, problem, dimension, budget, instance)
        missed = [""] * (len(TARGETS) - len(problem.reached))
        row = [*key, problem.evaluations, *problem.reached, *missed]
        # one write of a whole line: what was stopped in between is run again
        with path.open("a") as file:
            file.write(listed(row) + "\n")
        done[key] = [str(cell) for cell in row]
        print(f"{number} of {len(wanted)}: {' '.join(key)}", file=sys.stderr)
    return done


def curve(rows, dimension, budget):
    """Share of all targets that were reached, over log10(evaluations / dimension): a staircase."""
    reached = sorted(float(cell) for row in rows for cell in row[5:] if cell and float(cell) <= budget * dimension)
    total = max(1, len(rows) * len(TARGETS))
    return [(math.log10(max(1.0, r / dimension)), (k + 1) / total) for k, r in enumerate(reached)]


def area(staircase, end):
    """Mean share over the whole axis."""
    sum_, last, share = 0.0, 0.0, 0.0
    for at, now in staircase:
        sum_, last, share = sum_ + share * (at - last), at, now
    return (sum_ + share * (end - last)) / end


def draw(curves, end, path):
    """Curves by (solver, dimension) as one SVG, a panel for each dimension."""
    dimensions = sorted({dimension for _, dimension in curves})
    solvers = sorted({solver for solver, _ in curves})
    colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"]
    width, height, left, top = 300, 260, 46, 30
    text = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * len(dimensions) + 20}" height="{height + 70}" '
        'font-family="Helvetica, Arial, sans-serif" font-size="12" fill="#222">'
    ]
    for panel, dimension in enumerate(dimensions):
        x = lambda at: left + width * panel + (width - 60) * at / end
        y = lambda share: top + height * (1 - share)
        text.append(f'<text x="{x(0)}" y="{top - 10}">dimension {dimension}</text>')
        for share in (0, 0.5, 1):
            text.append(f'<path d="M{x(0)},{y(share)}H{x(end)}" stroke="#ddd"/><text x="{x(0) - 30}" y="{y(share) + 4}">{share}</text>')
        text.append(f'<text x="{x(0)}" y="{y(0) + 18}">log10(evaluations / dimension), 0 to {end:g}</text>')
        for solver in solvers:
            points = curves.get((solver, dimension), [])
            path_ = f"M{x(0):.1f},{y(0):.1f}" + "".join(f"H{x(at):.1f}V{y(share):.1f}" for at, share in points) + f"H{x(end):.1f}"
            text.append(f'<path d="{path_}" fill="none" stroke="{colours[solvers.index(solver) % 6]}" stroke-width="1.6"/>')
    for k, solver in enumerate(solvers):
        text.append(f'<text x="{left + 110 * k}" y="{height + 66}" fill="{colours[k % 6]}">{solver}</text>')
    path.write_text("\n".join(text + ["</svg>"]) + "\n")


def main():
    given = arguments()
    for name in ("functions", "instances", "dimensions"):
        if isinstance(getattr(given, name), str):
            setattr(given, name, numbers(getattr(given, name)))
    out = given.out.resolve()
    done = run(given)
    end = math.log10(given.budget)
    curves, table = {}, []
    for solver in given.solvers.split(","):
        for dimension in given.dimensions:
            rows = [row for key, row in done.items() if key[0] == solver and key[2] == str(dimension)]
            curves[(solver, dimension)] = curve(rows, dimension, given.budget)
            table.append((solver, dimension, len(rows), area(curves[(solver, dimension)], end)))
    lines = ["solver,dimension,runs,area"] + [f"{s},{d},{n},{a:.4f}" for s, d, n, a in table]
    (out / "areas.csv").write_text("\n".join(lines) + "\n")
    draw(curves, end, out / "ecdf.svg")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
