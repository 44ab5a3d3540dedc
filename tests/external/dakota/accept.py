"""Reads the parameters files beside this script with Dakota's own reader, and checks what it finds.

    PYTHONPATH=FOLDER/OF/DAKOTA/python python3 accept.py

The package `dakota.interfacing` is part of Dakota's sources (python/dakota/interfacing); the files were accepted by that of
May 2026 (98620af1). Cargo's tests compare with the files and need no Dakota.
"""
import os
import dakota.interfacing as interfacing

folder = os.path.dirname(os.path.abspath(__file__))
for name, gradients in (("standard.in", False), ("aprepro.in", True), ("json.in", True)):
    parameters, results = interfacing.read_parameters_file(os.path.join(folder, name), interfacing.UNNAMED)
    assert list(parameters.descriptors) == ["k", "zone:c"], name
    assert [parameters[0], parameters[1]] == [2.5, -1e-3], name
    assert list(parameters.an_comps) == ["mesh 1.exo", "b"], name
    assert parameters.eval_num == 7, name
    assert results.descriptors == ["w1", "w2"], name
    assert list(results.deriv_vars) == ["k", "zone:c"], name
    for response in results.responses():
        assert response.asv.function and bool(response.asv.gradient) == gradients, name
    print(name, "accepted")
