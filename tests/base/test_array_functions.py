"""A first response imports no more of SciPy than numba does."""

import subprocess
import sys


def test_a_response_imports_no_module_that_it_does_not_need():
    asked = "slenderness=0.5, frequency_ratio=5.0, restitution=0.9"
    code = (
        "import sys, rocking\n"
        f"rocking.peak_response('sine', {asked})\n"
        f"rocking.peak_response('ricker', {asked}, alpha=0.2)\n"
        "print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert {"scipy.special", "scipy.optimize", "xarray", "pandas", "matplotlib"}.isdisjoint(done.stdout.split())
