# Builds every product of the paper's reproduction: `snakemake`, or `make reproduce`. Another configuration:
# `--configfile workflow/config/smoke.yaml`; another place: `--directory DIR`.
from snakemake.utils import min_version

min_version("9.11.4")

if not workflow.overwrite_configfiles:  # a --configfile replaces the default, it is not merged into it

    configfile: f"{workflow.basedir}/workflow/config/paper.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"


if "suite" in config:

    include: "workflow/rules/suites.smk"

else:

    include: "workflow/rules/datasets.smk"

    if "figures" in config:

        include: "workflow/rules/figures.smk"
        include: "workflow/rules/claims.smk"
    include: "workflow/rules/checks.smk"


include: "workflow/rules/manifest.smk"


if "suite" not in config:

    include: "workflow/rules/benchmarks.smk"


rule all:
    default_target: True
    input:
        list(PRODUCTS),
        rules.manifest.output,
        rules.ro_crate.output,
        CHECKED,
    message:
        "All products are made, and listed in the manifest"
