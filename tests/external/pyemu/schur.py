"""Compares a calibration with pyemu, which reads its files: parameters, residuals, and standard deviations by `pyemu.Schur`.

    python3 schur.py HORSEHEAD WORKER CONTROL [DEVIATIONS]

Imports the control file, calibrates it by `descent` in a temporary folder, and fails if pyemu finds other values. Writes
pyemu's standard deviations to DEVIATIONS, if given: the file that the test `pest::deviations_are_those_of_pyemu` compares with.
`.ci/run` runs it on tests/pest/decay/model.pst with pyemu 1.3.8.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import warnings

warnings.filterwarnings("ignore")
import pyemu

TOLERANCE = 0.01

program, worker, control = (os.path.abspath(path) for path in sys.argv[1:4])
with tempfile.TemporaryDirectory() as folder:
    environment = dict(os.environ, HORSEHEAD_WORKER=worker, HORSEHEAD_ALLOW=os.path.join(folder, "allow.toml"))

    def run(*words):
        return subprocess.run([program, *words], cwd=folder, env=environment, check=True, stdout=subprocess.PIPE).stdout

    run("case", "import", control, "case")
    run("allow", "case")
    result = json.loads(run("calibrate", "case", "--preset", "descent", "--run", "run", "--output", "json"))
    of = lambda name: os.path.join(folder, "run", name)
    pst = pyemu.Pst(os.path.join(folder, "case", os.path.basename(control)))
    parameters = pyemu.pst_utils.read_parfile(of("calibrated.par"))
    residuals = pyemu.pst_utils.read_resfile(of("residuals.rei"))
    assert sorted(residuals.name) == sorted(pst.nnz_obs_names)
    assert list(residuals.group) == list(pst.observation_data.loc[residuals.name, "obgnme"])
    phi = ((residuals.residual * residuals.weight) ** 2).sum()
    assert math.isclose(phi, result["objective"]["optimised"], rel_tol=1e-9), phi
    jacobian = "jacobian.jco" if os.path.exists(of("jacobian.jco")) else "jacobian.jcb"
    posterior = pyemu.Schur(jco=of(jacobian), pst=pst, verbose=False).posterior_parameter
    deviations = {}
    for at, name in enumerate(posterior.row_names):
        unknown = result["unknowns"][name]
        assert math.isclose(parameters.parval1[name], unknown["value"], rel_tol=1e-14), name
        low, high = unknown["ci95"]
        if pst.parameter_data.partrans[name] == "log":
            low, high = math.log10(low), math.log10(high)
        deviations[name] = math.sqrt(posterior.x[at, at])
        own = 0.5 * (high - low) / 1.959964
        assert abs(own / deviations[name] - 1.0) < TOLERANCE, (name, own, deviations[name])
        print(f"{name}: {own:.6g}, pyemu {deviations[name]:.6g}")
if len(sys.argv) > 4:
    with open(sys.argv[4], "w") as file:
        json.dump(deviations, file, indent=1)
        file.write("\n")
