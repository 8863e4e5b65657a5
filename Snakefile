# Builds every product of the paper's reproduction: `snakemake` in this folder, or `make reproduce`, which sets up first.
# Another configuration: `snakemake --configfile workflow/config/smoke.yaml`; another place: `--directory DIR`.
from snakemake.utils import min_version, validate

min_version("9.10")

if not workflow.overwrite_configfiles:  # a --configfile stands alone, it is not merged into the default

    configfile: f"{workflow.basedir}/workflow/config/paper.yaml"


validate(config, "workflow/config/schema.yaml")


include: "workflow/rules/common.smk"
include: "workflow/rules/datasets.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/benchmarks.smk"


rule all:
    default_target: True
    input:
        manifest="results/manifest.json",
        checks="results/checks.txt",
    message:
        "All products are in results/, listed in results/manifest.json"
