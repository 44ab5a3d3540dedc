"""Writes measured/5hz.csv and 7hz.csv: bench.py at hidden values, six cycles with noise of seed 1. `make.py FOLDER NAME=VALUE ..`
writes into another folder, with other hidden values."""
import csv, json, pathlib, random, subprocess, sys, tempfile

HIDDEN = dict(stiffness=6.3, damping=26.0, friction=0.0, drag=0.0, hardening=0.012, lag_ms=0.0, unbalance_cos=0.0, unbalance_sin=0.0)
here, noise = pathlib.Path(__file__).parent, random.Random(1)
folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here / "measured"
HIDDEN.update((name, float(value)) for name, value in (word.split("=") for word in sys.argv[2:]))
folder.mkdir(exist_ok=True)
for hz in (5.0, 7.0):
    with tempfile.TemporaryDirectory() as scratch:
        (pathlib.Path(scratch) / "bench.in.json").write_text(json.dumps(dict(HIDDEN, hz=hz)))
        subprocess.run([sys.executable, here.absolute() / "bench.py"], cwd=scratch, check=True)
        rows = list(csv.DictReader(open(pathlib.Path(scratch) / "curve.csv")))
    with open(folder / f"{hz:.0f}hz.csv", "w") as out:
        out.write("cycle,phase_deg,travel_mm,force_n\n")
        for cycle in range(1, 7):
            for row in rows:
                travel = float(row["travel_mm"]) + noise.gauss(0, 0.02)
                force = float(row["force_n"]) + noise.gauss(0, 0.2)
                out.write(f"{cycle},{row['phase_deg']},{travel:.4f},{force:.3f}\n")
