"""Compiled kernels: one signature for all arguments, equal results in every process."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.types.functions import BaseFunction

import rocking
from rocking import precompile
from rocking._base.errors import InvalidArgumentError
from rocking._boundary import matching
from rocking._datasets.cube import write_dataset
from rocking._excitation.pulses import SinusoidalPulse
from rocking._excitation.sinusoids import MAX_SINUSOIDS
from rocking._history import sampling
from rocking._interpolation import kernel as lookup_kernel
from rocking._interpolation import stencils as interpolation
from rocking._lookup.cube import open_cube
from rocking._numba import kernel_cache
from rocking._numba.compilation import entry, kernel
from rocking._numba.way import INTERNALS
from rocking._solver.kernels import batch as rock_many
from rocking._solver.stages import batch as stages
from rocking._spectra.cubes import spectra

ROOT = Path(__file__).parents[2]

ENTRIES = (
    *(
        rock_many.solve_batch,
        stages.solve_by_arcs,
        sampling.sample_flights,
        sampling.sample_free_rocking,
    ),
    *(interpolation.interpolate_cells,),
    *(lookup_kernel.prepare, lookup_kernel.interpolate_many),
    *(matching.match_trends, matching.learn_trends, matching.follow_trends),
)


def read_only(*values):
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array


def test_each_entry_has_one_signature_for_all_arguments(tmp_path):
    precompile.load_kernels()
    forms = {entry.__name__: len(entry.signatures) for entry in ENTRIES}  # other tests may have added to them
    for name in rocking.PULSE_NAMES:
        for pulse in (name, "-" + name):
            for alpha in (None, 0.3, read_only(0.0, 0.3)):
                groups = {"slenderness": read_only(0.4, 0.5), "restitution": 0.9, "alpha": alpha}
                rocking.peak_response(pulse, frequency_ratio=3, **groups)
                rocking.peak_response(
                    pulse, frequency_ratio=np.ones((4, 4))[::2, ::2], relative_tolerance=1e-6, **groups
                )
            rocking.time_history(pulse, slenderness=0.4, frequency_ratio=3, restitution=1, alpha=0.3, contact=True)
            rocking.time_history(pulse, slenderness=0.4, frequency_ratio=3, restitution=0, samples=2)
    rocking.overturning_boundary("cosine", restitution=0.85, nodes=16)
    axes = {"slenderness": np.linspace(0.1, 0.9, 9), "frequency_ratio": np.geomspace(1, 5, 9), "alpha": [0.0, 0.3]}
    for cube in spectra("sine", restitution=[0.85, 0.9], **axes):
        write_dataset(cube, tmp_path / f"eta-{float(cube['restitution']):.2f}.nc")
    opened = open_cube(tmp_path)
    for eta in (0.85, read_only(0.86, 0.9)):
        opened.response(slenderness=read_only(0.8), frequency_ratio=3, restitution=eta, alpha=0.1)
    assert {entry.__name__: len(entry.signatures) for entry in ENTRIES} == forms


def test_any_number_of_sinusoids_up_to_the_limit_is_one_pulse():
    """A sine as the sum of equal parts."""
    sine, groups = rocking.pulse("sine"), {"slenderness": 0.4, "frequency_ratio": 3.0, "restitution": 0.9}
    single = rocking.peak_response(sine, **groups).peak_rotation
    for count in (2, 5, MAX_SINUSOIDS):
        terms = tuple((c / count, w, d) for c, w, d in sine.terms for _ in range(count))
        parts = SinusoidalPulse("parts", sine.start, sine.end, sine.stationary, terms)
        np.testing.assert_allclose(rocking.peak_response(parts, **groups).peak_rotation, single, rtol=1e-12)
    with pytest.raises(InvalidArgumentError, match=f"1 to {MAX_SINUSOIDS} triples"):
        SinusoidalPulse("many", sine.start, sine.end, sine.stationary, sine.terms * (MAX_SINUSOIDS + 1))


def script(code, **environment):
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, env=os.environ | environment
    )
    return run.stdout


@pytest.mark.long
def test_compiling_process_and_cached_process_give_equal_bits(tmp_path):
    code = """
import hashlib, numpy as np, rocking
from rocking._model.fields import RESPONSE_FIELDS
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.stages.batch import solve_by_arcs
rng = np.random.default_rng(7)
s, w, e = rng.uniform(0.02, 0.95, 20_000), np.exp(rng.uniform(-1.2, 2.5, 20_000)), rng.uniform(0.5, 0.95, 20_000)
digest = hashlib.sha256()
for name in ("ricker", "sine", "c2"):
    for alpha in (None, 0.35):
        found = rocking.peak_response(name, slenderness=s, frequency_ratio=w, restitution=e, alpha=alpha)
        for field in RESPONSE_FIELDS:
            digest.update(getattr(found, field.name).tobytes())
entries = solve_by_arcs, solve_batch
print(sum(sum(one.stats.cache_misses.values()) for one in entries), digest.hexdigest())
"""
    printed = [script(code, NUMBA_CACHE_DIR=str(tmp_path)).split() for _ in range(2)]
    assert [misses for misses, _ in printed] == ["2", "0"]
    assert printed[0][1] == printed[1][1]


def test_a_kernel_called_from_python_does_not_run_the_copy_of_an_entry(monkeypatch):
    """That copy is compiled for the arguments of the entry: another caller gets wrong numbers, or the process ends."""
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: None)

    @kernel
    def weighted_sum(values, first, weight):
        total = 0.0
        for i in range(first, len(values)):  # long enough that it is not inlined
            x = values[i]
            total += math.sin(x) + math.cos(weight * x) + math.tan(x) + math.atan(weight * x) + math.asin(0.1 * x)
            total += math.sinh(x) + math.cosh(weight * x) + math.tanh(x) + math.exp(-weight * x) + math.acos(0.1 * x)
            total += math.erf(x) + math.erfc(weight * x) + math.gamma(x) + math.log1p(weight * x) + math.expm1(x)
        return total

    @entry
    def with_one_weight(values):
        end = len(values)
        first, second = weighted_sum(values, end - 4, 2.0), weighted_sum(values, end - 3, 2.0)
        return first + second - weighted_sum(values, end - 2, 2.0)

    @kernel
    def with_any_weight(values, weight):
        n = len(values)
        return (
            weighted_sum(values, n - 4, weight)
            + weighted_sum(values, n - 3, weight)
            - weighted_sum(values, n - 2, weight)
        )

    values = np.linspace(0.1, 1.0, 4)
    sums = [[weighted_sum.py_func(values, first, weight) for first in (0, 1, 2)] for weight in (2.0, 5.0)]
    expected = [a + b - c for a, b, c in sums]
    computed = [with_one_weight(values), with_any_weight(values, 5.0)]
    assert computed == pytest.approx(expected, rel=1e-14)


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="the system binds no process to a core")
def test_only_the_cores_of_this_process_are_used():
    bind = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})"
    code = f"{bind}; import rocking._solver.peak_response; print(rocking._solver.peak_response.AVAILABLE_CORES)"
    assert script(code) == "1\n"


@pytest.mark.skipif(INTERNALS is None, reason="of the faster way alone")
def test_an_entry_that_cannot_be_compiled_leaves_numba_as_it_was():
    before = BaseFunction.get_call_type, numba.types.Record.__repr__

    @entry
    def cannot(x):
        return x + "a"

    with pytest.raises(numba.TypingError):
        cannot(0.5)
    assert before == (BaseFunction.get_call_type, numba.types.Record.__repr__)
