# Builds every product of the paper's reproduction. `make reproduce` (workflow/run.py) also makes again what is not as
# recorded; `snakemake` in this folder makes what is missing or out of date. Another configuration:
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
    include: "workflow/rules/report.smk"
    include: "workflow/rules/benchmarks.smk"


records.date_back_outdated(Path.cwd(), JOBS.values())


rule all:
    default_target: True
    input:
        FINISHED,
    message:
        "All products are made, and listed in the manifest"


onstart:
    try:
        acquire(Path.cwd())
    except RunningError as error:
        raise WorkflowError(str(error)) from None
    if not workflow.executor_plugin.common_settings.non_local_exec:
        job_server.start()
