"""Measures import and descent of a large PEST project: a linear model of ten parameters with many observations in many groups.

    python3 size.py PROGRAMS OBSERVATIONS GROUPS [--descent]

PROGRAMS is the folder of `horsehead` and `horsehead-worker`.
Prints the wall time of `case import` (which checks the case) and of `case check`, and with `--descent` the time of `calibrate
--preset descent`, the greatest resident memory of coordinator and workers, and the size of the journal.
"""
import os
import resource
import subprocess
import sys
import tempfile
import time

MODEL = """import math
p = [float(line) for line in open("p.txt")]
with open("y.txt", "w") as out:
    for at in range(%d):
        out.write("%%.9g\\n" %% sum(value * math.cos(0.001 * at * (k + 1)) for k, value in enumerate(p)))
"""


def project(folder, observations, groups):
    import math

    write = lambda name, text: open(os.path.join(folder, name), "w").write(text)
    truth = [1.0 + 0.1 * k for k in range(10)]
    value = lambda at: sum(v * math.cos(0.001 * at * (k + 1)) for k, v in enumerate(truth))
    parameters = "".join(f"p{k} none factor 1.0 -100 100 g 1.0 0.0 1\n" for k in range(10))
    names = "".join(f"g{k}\n" for k in range(groups))
    observed = "".join(f"o{at} {value(at):.9g} 100 g{at % groups}\n" for at in range(observations))
    write(
        "m.pst",
        "pcf\n* control data\nrestart estimation\n"
        f"10 {observations} 1 0 {groups}\n1 1 single point\n10 -3 0.3 0.03 10\n10 10 0.001\n0.1\n"
        "20 0.005 4 4 0.005 4\n1 1 1\n* parameter groups\ng relative 0.01 0.001 switch 2.0 parabolic\n"
        f"* parameter data\n{parameters}* observation groups\n{names}* observation data\n{observed}"
        "* model command line\npython3 model.py\n* model input/output\np.tpl p.txt\ny.ins y.txt\n",
    )
    write("model.py", MODEL % observations)
    write("p.tpl", "ptf ~\n" + "".join(f"~ p{k}                  ~\n" for k in range(10)))
    write("y.ins", "pif ~\n" + "".join(f"l1 !o{at}!\n" for at in range(observations)))


program, worker = (os.path.abspath(os.path.join(sys.argv[1], name)) for name in ("horsehead", "horsehead-worker"))
observations, groups = int(sys.argv[2]), int(sys.argv[3])
with tempfile.TemporaryDirectory() as folder:
    project(folder, observations, groups)
    environment = dict(os.environ, HORSEHEAD_WORKER=worker, HORSEHEAD_ALLOW=os.path.join(folder, "allow.toml"))

    def timed(*words):
        begun = time.monotonic()
        subprocess.run([program, *words], cwd=folder, env=environment, check=True, capture_output=True)
        return time.monotonic() - begun

    print(f"{observations} observations, {groups} groups")
    print(f"import {timed('case', 'import', 'm.pst', 'case'):.2f} s, check {timed('case', 'check', 'case'):.2f} s")
    if "--descent" in sys.argv:
        timed("allow", "case")
        taken = timed("calibrate", "case", "--preset", "descent", "--run", "run")
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        journal = os.path.getsize(os.path.join(folder, "run", "journal.hhj")) / 2**20
        print(f"descent {taken:.1f} s, greatest process {most:.0f} MiB, journal {journal:.1f} MiB")
