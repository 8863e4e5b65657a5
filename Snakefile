# Builds every product of the paper's reproduction. `make reproduce` (workflow/run.py) also makes again what is not as
# recorded; `snakemake` in this folder makes what is missing or out of date. Another configuration:
# `--configfile workflow/config/smoke.yaml`; another place: `--directory DIR`.
from snakemake.utils import min_version

min_version("9.10")

if not workflow.overwrite_configfiles:  # a --configfile replaces the default, it is not merged into it

    configfile: f"{workflow.basedir}/workflow/config/paper.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/datasets.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/benchmarks.smk"


rule all:
    default_target: True
    input:
        *rules.manifest.input,
        *rules.manifest.output,
        *rules.check_results.output,
    message:
        "All products are in results/, listed in results/manifest.json"


onstart:
    try:
        acquire(Path.cwd())
    except RunningError as error:
        raise WorkflowError(str(error)) from None
