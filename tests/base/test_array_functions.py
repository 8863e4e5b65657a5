"""A first response does not import SciPy, and numba finds its BLAS all the same."""

import subprocess
import sys


def in_a_new_process(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.split()


def test_a_response_imports_no_part_of_scipy_that_takes_time():
    asked = "slenderness=0.5, frequency_ratio=5.0, restitution=0.9"
    modules = in_a_new_process(
        "import sys, rocking\n"
        f"rocking.peak_response('sine', {asked})\n"
        f"rocking.peak_response('ricker', {asked}, alpha=0.2)\n"
        "print(*sys.modules)"
    )
    assert "numba.np.arraymath" in modules
    heavy = {"scipy.linalg", "scipy.special", "scipy.optimize", "xarray", "pandas", "matplotlib"}
    assert heavy.isdisjoint(modules)


def test_functions_of_others_find_the_blas():
    found = in_a_new_process(
        "import sys, rocking\n"
        "from numba.np import arraymath, linalg\n"
        "rocking.peak_response('sine', slenderness=0.5, frequency_ratio=5.0, restitution=0.9)\n"
        "linalg.ensure_blas()  # what numba calls where it compiles a product of matrices\n"
        "print(arraymath._HAVE_BLAS, linalg.ensure_blas.__module__, 'scipy.linalg.cython_blas' in sys.modules)"
    )
    assert found == ["True", "numba.np.linalg", "True"]
