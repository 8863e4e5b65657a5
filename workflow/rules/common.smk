# Definitions for all rules: the configuration, and digests by which Snakemake finds what is out of date.
import os
import re
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import validate

validate(config, "../config/schema.yaml")

# The scripts are found from here by this process and by its jobs, wherever the results go.
PROJECT = Path(str(workflow.basedir))
sys.path.insert(0, str(PROJECT))
os.environ.update(PYTHONPATH=os.pathsep.join([str(PROJECT), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]))

from rocking._base.source_tree import SourceTree
from rocking._base.installation import __version__
from rocking._datasets.checksum import sha256_of_file
from rocking._datasets.provenance import settings_digest, settings_text
from rocking.suites.configuration import suite_configuration
from workflow.configuration import BYTES, ConfigurationError, check, chosen, nodes_of_cube, restitutions
from workflow.pulses import configured_pulse, different, relative_entry

CONFIG_FOLDER = Path(workflow.configfiles[0]).parent  # folders in a configuration are relative to it

try:
    check(config, CONFIG_FOLDER)
except ConfigurationError as error:
    raise WorkflowError(f"Configuration refused: {error}") from None

SOURCES = SourceTree(PROJECT)
PRODUCTS = {}  # path of each product -> its rule and digests, for the manifest
CHECKED = []  # results of the tests of the products
RESULTS = "results"  # folder of the manifest
# of this process; an engine on several machines has no number of cores
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def memory(megabytes):
    """Memory of a job [MB], more with each attempt, for engines that end jobs which need more than they state."""
    return lambda wildcards, attempt: int(attempt * megabytes)


def product_code(*scripts):
    """Digest of scripts of the workflow and of all that they import.

    Snakemake finds a changed script, but not a changed module that it imports: the digest is a parameter of the rule.
    """
    return SOURCES.digest(*(PROJECT / "workflow" / script for script in scripts))


def benchmark_code(module):
    """Digest of a module of the benchmarks and of all that it imports."""
    return SOURCES.digest(PROJECT.joinpath("benchmarks", *module.split(".")).with_suffix(".py"))


def installed_baselines(wildcards):
    """Versions of the optional integrators: a measurement is repeated when one changes."""
    from benchmarks.measure import versions
    from benchmarks.baselines.methods import OPTIONAL

    return versions(*OPTIONAL)


def provenance(scripts, settings):
    """Digests of code and settings, the settings, and the version: attributes of a product, and parameters of its rule.

    The commit is none of them: another one with the same code would make other bytes. The manifest states it.
    """
    return {
        "code_sha256": product_code(*scripts),
        "settings_sha256": settings_digest(settings),
        "configuration": settings_text(settings),
        "product_version": __version__,
    }


def list_products(rule_name, provenance, paths, **further):
    """Note products for the manifest."""
    digests = {name: value for name, value in provenance.items() if name.endswith("sha256")}
    PRODUCTS.update(dict.fromkeys(paths, {"rule": rule_name, **digests, **further}))


def spectrum_files(pulse, etas):
    """Spectrum cubes of a pulse."""
    return [f"results/spectra/{pulse}/eta-{eta:.2f}.nc" for eta in etas]


def overturning_files(pulse, etas):
    """Boundaries of a pulse."""
    return [f"results/overturning/{pulse}/eta-{eta:.2f}.nc" for eta in etas]
