# Definitions for all rules, and digests by which Snakemake detects products that are out of date.
import math
import os
import re
import sys
from pathlib import Path

# The package and the scripts are found from here by this process and by its jobs, wherever the results go.
PROJECT = Path(str(workflow.basedir))
sys.path.insert(0, str(PROJECT))
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(PROJECT), os.environ.get("PYTHONPATH")]))

from rocking._base.installation import __version__
from rocking._datasets.provenance import settings_digest, settings_text
from rocking._base.source_tree import SourceTree
from rocking._interpolation.slices import windows_of
from rocking.suites.configuration import DEFAULTS, suite_configuration
from workflow import job_server, records
from workflow.configuration import (
    BYTES,
    ConfigurationError,
    check,
    chosen,
    nodes_of_cube,
    restitutions,
)
from workflow.pulses import configured_pulse, different, samples_file
from workflow.run_lock import RUN_ID, RunningError, acquire

from snakemake.exceptions import WorkflowError

os.environ[RUN_ID] = str(os.getpid())  # the jobs end with this process

SOURCES = SourceTree(PROJECT)

CONFIG_FOLDER = Path(workflow.configfiles[0]).parent  # folders in a configuration are relative to it

try:
    check(config, CONFIG_FOLDER)
except ConfigurationError as error:
    sys.exit(f"Configuration refused: {error}")  # one line; WorkflowError would add where in this file it was raised

PRODUCTS = {}  # path -> rule and digests, for the manifest
RECORDS = []  # of the jobs that make products
FINISHED = []  # files of a complete run
JOBS = {}  # names of the jobs that have a record, with wildcards -> name of the record
# of this process; an engine on several machines has no number of cores
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def record_of(job, provenance):
    """Path of the record with the digests of the products of a job."""
    JOBS[job] = records.record_name(job, provenance)
    return f"{records.FOLDER}/{JOBS[job]}"


def memory(megabytes):
    """Memory of a job [MB], more with each attempt, for engines that end jobs which need more than they state."""
    return lambda wildcards, attempt: math.ceil(attempt * megabytes)


def named(eta):
    """A restitution as in the names of files; a wildcard or a name stays as it is."""
    return eta if isinstance(eta, str) else f"{eta:.2f}"


def spectrum_files(pulse, etas):
    """Spectrum cubes of a pulse."""
    return [f"results/spectra/{pulse}/eta-{named(eta)}.nc" for eta in etas]


def overturning_files(pulse, etas):
    """Boundaries of a pulse."""
    return [f"results/overturning/{pulse}/eta-{named(eta)}.nc" for eta in etas]


def part_files(pulse, etas):
    """Solved nodes of the cubes of a pulse, kept for the cubes of other restitutions."""
    return [f"{records.PARTS}/spectra/{pulse}-{named(eta)}.nc" for eta in etas]


def window_of(eta, etas):
    """The restitutions, of those by name, from which the interval above one is interpolated."""
    place = [*etas].index(eta)
    return [*etas.values()][slice(*windows_of(len(etas), place, place + 1))]


def provenance(rule_name, scripts, settings, products):
    """Digests of the code and the settings behind a rule's products, which are listed in the manifest.

    Snakemake detects a changed script, but not a changed module that the script imports. The digest of the scripts and
    of all files that they import is therefore a parameter of the rule. The settings and the version of the package
    are too: they become attributes of the products. The commit does not: another one with the same code would make
    other bytes. The manifest states it.
    """
    digests = {
        "code_sha256": SOURCES.digest(*(PROJECT / "workflow" / script for script in scripts)),
        "settings_sha256": settings_digest(settings),
    }
    for path in products:
        PRODUCTS[path] = {"rule": rule_name, **digests}
    return {**digests, "configuration": settings_text(settings), "product_version": __version__}


def benchmark_code(*names):
    """Digest of benchmarks and of all that they import, computed when a job needs it."""
    return lambda wildcards: SOURCES.digest(*(PROJECT / f"benchmarks/{name}.py" for name in names))


def installed_baselines(wildcards):
    """Versions of the optional integrators: a measurement is repeated when one changes."""
    from benchmarks.measure import versions
    from benchmarks.baselines.methods import OPTIONAL

    return versions(*OPTIONAL)
