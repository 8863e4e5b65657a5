# What all rules share: names of files, and the digests that tell Snakemake when a product is out of date.
import os
import sys
from pathlib import Path

# The package and the scripts are found from here by this process and by its jobs, wherever the results go.
PROJECT = Path(str(workflow.basedir))
sys.path.insert(0, str(PROJECT))
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(PROJECT), os.environ.get("PYTHONPATH")]))

from rocking.provenance import code_digest, settings_digest
from workflow.scripts.axes import stepped

from snakemake.exceptions import WorkflowError

ETAS = [f"{eta:.2f}" for eta in config["restitution"]]
PULSES = config["pulses"]
PRODUCTS = {}  # path -> rule and digests, for the manifest


wildcard_constraints:
    pulse="[a-z0-9_]+",
    eta=r"[01]\.[0-9]{2}",


# The pulses of the figures that are drawn from data sets.
DATA_OF_FIGURES = {
    "figure-04": ["sine"],
    "figure-08": ["sine", "cosine"],
    "figure-09": ["sine", "cosine"],
    "figure-10": ["sine", "cosine"],
    "figure-13": ["sine", "cosine"],
    "figure-scale-law": ["sine"],
}


def chosen(figure):
    """All values of a figure, the paper's and ours."""
    values = config["figures"][figure]
    return {**values.get("paper", {}), **values.get("ours", {})}


def restitutions(figure):
    """Its restitutions as a list, also where it has only one."""
    eta = chosen(figure)["restitution"]
    return eta if isinstance(eta, list) else [eta]


def check_configuration():
    """Refuse what the schema cannot see: names of files that would clash, figures of data that nobody makes."""
    for eta, name in zip(config["restitution"], ETAS):
        if float(name) != eta:
            raise WorkflowError(f"restitution {eta}: two decimals at most, they name the files")
    angles = config["grid"]["alpha_deg"]
    try:
        rows = stepped(**config["grid"]["slenderness"])
    except ValueError as error:
        raise WorkflowError(f"slenderness: {error}") from error
    if 0 not in angles:
        raise WorkflowError(f"alpha_deg {angles}: figures and claims need the slender limit, 0")
    if angles != sorted(angles):
        raise WorkflowError(f"alpha_deg {angles}: an axis of the cubes, which has to ascend")
    for figure, pulses in DATA_OF_FIGURES.items():
        for pulse in pulses:
            if pulse not in PULSES:
                raise WorkflowError(f"{figure} needs the pulse {pulse}, which is not among the pulses {PULSES}")
        for eta in restitutions(figure):
            if f"{eta:.2f}" not in ETAS:
                raise WorkflowError(f"{figure} asks for restitution {eta:.2f}, which is not among {ETAS}")
        angle = chosen(figure).get("alpha_deg", 0)
        if angle not in angles:
            raise WorkflowError(f"{figure} asks for alpha_deg {angle}, which is not among {angles}")
        for slenderness in chosen(figure).get("slenderness", []):
            if abs(rows - slenderness).min() > 1e-9:
                raise WorkflowError(f"{figure} asks for slenderness {slenderness}, which is not a node of the grid")


check_configuration()


def spectrum_files(pulse, etas):
    return [f"results/spectra/{pulse}/eta-{float(eta):.2f}.nc" for eta in etas]


def overturning_files(pulse, etas):
    return [f"results/overturning/{pulse}/eta-{float(eta):.2f}.nc" for eta in etas]


def provenance(rule_name, scripts, settings, products):
    """Digests of the code and the settings behind a rule's products, which are noted for the manifest.

    Snakemake sees a changed script, but not a changed module that the script imports: as a parameter, the digest of
    the scripts and of all that they import makes it see both, and nothing that they do not import.
    """
    digests = {
        "code_sha256": code_digest(*(PROJECT / "workflow" / script for script in scripts)),
        "settings_sha256": settings_digest(settings),
    }
    for path in products:
        PRODUCTS[path] = {"rule": rule_name, **digests}
    return digests


def benchmark_code(*names):
    """Digest of benchmarks and of all that they import, found when a job asks for it."""
    return lambda wildcards: code_digest(*(PROJECT / f"benchmarks/{name}.py" for name in names))


def installed_peers(wildcards):
    """Versions of the optional integrators: another one is another measurement."""
    from benchmarks.measure import versions
    from benchmarks.methods import OPTIONAL

    return versions(*OPTIONAL)
