# The benchmarks: `snakemake bench`, or `make bench`. A job is one command of `benchmarks`; one job runs at a time, so that
# measurements do not disturb each other. Its output goes to its log, its progress to the terminal.
DIAGRAMS = sorted(path.stem for path in (PROJECT / "benchmarks/data").glob("*-*.csv"))
TIMED = {
    "tolerance": "accuracy.tolerance",
    "solver": "cost.solver",
    "first-call": "cost.first_call",
    "records": "cost.records",
    "service": "cost.service",
}
# files that a benchmark reads
BENCHMARK_INPUTS = {
    "tolerance": os.path.relpath(PROJECT / "benchmarks/data/random.csv"),
    "service": rules.manifest.output.manifest,
}


rule work_precision:
    input:
        cells=os.path.join(os.path.relpath(PROJECT / "benchmarks"), "data", "{diagram}.csv"),
    output:
        record="results/benchmarks/work-precision-{diagram}.json",
        table="results/benchmarks/work-precision-{diagram}.txt",
    log:
        "logs/bench/work-precision-{diagram}.log",
    benchmark:
        "logs/benchmarks/work-precision-{diagram}.tsv"
    wildcard_constraints:
        diagram="|".join(DIAGRAMS),
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=lambda wildcards: benchmark_code("cost.work_precision"),
        baselines=installed_baselines,
        folder=subpath(output.record, parent=True),
    shell:
        "python -m benchmarks.cost.work_precision {wildcards.diagram} --out {params.folder} >{log}"


rule timed:
    input:
        lambda wildcards: BENCHMARK_INPUTS.get(wildcards.name, []),
    output:
        record="results/benchmarks/{name}.json",
        table="results/benchmarks/{name}.txt",
    log:
        "logs/bench/{name}.log",
    benchmark:
        "logs/benchmarks/{name}.tsv"
    wildcard_constraints:
        name="|".join(TIMED),
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=lambda wildcards: benchmark_code(TIMED[wildcards.name]),
        module=lambda wildcards: TIMED[wildcards.name],
    shell:
        "python -m benchmarks.{params.module} --out {output.record} >{log}"


rule bench:
    input:
        diagrams=expand(rules.work_precision.output.table, diagram=DIAGRAMS),
        tables=expand(rules.timed.output.table, name=TIMED),
    output:
        summary="results/benchmarks/summary.txt",
        figures=report(
            expand("results/benchmarks/work-precision-{measure}.png", measure=["median_error", "error_99"]),
            caption="../report/work-precision.rst",
            category="Run time",
        ),
    log:
        "logs/bench/summary.log",
    conda:
        "../envs/rocking.yaml"
    params:
        code=lambda wildcards: benchmark_code("figures.work_precision"),
        folder=subpath(output.summary, parent=True),
    shell:
        "cat {input} >{output.summary} && python -m benchmarks.figures.work_precision {params.folder} >{log}"
