# The benchmarks: `snakemake bench`, or `make bench`. A job is one command of `benchmarks`; one job runs at a time, so that
# measurements do not disturb each other. Its output goes to its log, its progress to the terminal.
DIAGRAMS = sorted(path.stem for path in (PROJECT / "benchmarks/data").glob("*-*.csv"))
TIMED = [
    "tolerance",
    "solver",
    "growth",
    "grid-size",
    "first-call",
    "records",
    "bodies",
    "service",
    "ablations",
    "stages",
]


rule work_precision:
    input:
        cells=str(PROJECT / "benchmarks/data/{diagram}.csv"),
    output:
        record="results/benchmarks/work-precision-{diagram}.json",
    log:
        "logs/bench/work-precision-{diagram}.log",
    benchmark:
        "logs/bench/work-precision-{diagram}.tsv"
    wildcard_constraints:
        diagram="|".join(DIAGRAMS),
    threads: CORES
    params:
        code=benchmark_code("cost/work_precision"),
        baselines=installed_baselines,
    message:
        "Run time against error, {wildcards.diagram}"
    shell:
        "python -m benchmarks.cost.work_precision {wildcards.diagram} --out {output.record} >{log}"


rule work_precision_figure:
    input:
        records=expand(rules.work_precision.output.record, diagram=DIAGRAMS),
    output:
        expand("results/benchmarks/work-precision{kind}.{format}", kind=["", "-median"], format=["png", "svg"]),
    log:
        "logs/bench/work-precision-figure.log",
    benchmark:
        "logs/bench/work-precision-figure.tsv"
    params:
        code=benchmark_code("figures/work_precision"),
        folder=lambda wildcards, input: os.path.dirname(input.records[0]),
    message:
        "Drawing run time against error"
    shell:
        "for measure in error_99 median_error; do"
        " python -m benchmarks.figures.work_precision --folder {params.folder} --measure $measure >>{log}; done"


rule tolerance:
    input:
        cells=str(PROJECT / "benchmarks/data/random.csv"),
    output:
        record="results/benchmarks/tolerance.json",
        figure="results/benchmarks/tolerance.png",
    log:
        "logs/bench/tolerance.log",
    benchmark:
        "logs/bench/tolerance.tsv"
    threads: CORES
    params:
        code=benchmark_code("accuracy/tolerance"),
    message:
        "Error against the requested tolerance"
    shell:
        "python -m benchmarks.accuracy.tolerance --out {output.record} >{log}"


rule solver:
    output:
        record="results/benchmarks/solver.json",
    log:
        "logs/bench/solver.log",
    benchmark:
        "logs/bench/solver.tsv"
    threads: CORES
    params:
        code=benchmark_code("cost/solver"),
    message:
        "Time of a cell for each pulse"
    shell:
        "python -m benchmarks.cost.solver --out {output.record} >{log}"


rule growth:
    output:
        record="results/benchmarks/growth.json",
        drawings=multiext("results/benchmarks/growth", ".png", ".svg"),
    log:
        "logs/bench/growth.log",
    benchmark:
        "logs/bench/growth.tsv"
    threads: CORES
    params:
        code=benchmark_code("cost/growth"),
    message:
        "Cost against the number of cells"
    shell:
        "python -m benchmarks.cost.growth --out {output.record} >{log}"


rule grid_size:
    input:
        config=str(PROJECT / "workflow/config/paper.yaml"),
    output:
        record="results/benchmarks/grid-size.json",
        drawings=multiext("results/benchmarks/grid-size", ".png", ".svg"),
    log:
        "logs/bench/grid-size.log",
    benchmark:
        "logs/bench/grid-size.tsv"
    threads: CORES
    params:
        code=benchmark_code("accuracy/grid_size"),
    message:
        "Error of interpolation against the size of the grid"
    shell:
        "python -m benchmarks.accuracy.grid_size --out {output.record} >{log}"


rule first_call:
    output:
        record="results/benchmarks/first-call.json",
    log:
        "logs/bench/first-call.log",
    benchmark:
        "logs/bench/first-call.tsv"
    threads: CORES
    params:
        code=benchmark_code("cost/first_call"),
    message:
        "First response of a new process"
    shell:
        "python -m benchmarks.cost.first_call --out {output.record} >{log}"


rule recorded_motions:
    output:
        record="results/benchmarks/records.json",
    log:
        "logs/bench/records.log",
    benchmark:
        "logs/bench/records.tsv"
    threads: CORES
    params:
        code=benchmark_code("cost/records"),
    message:
        "Responses under recorded motions"
    shell:
        "python -m benchmarks.cost.records --out {output.record} >{log}"


rule bodies:
    output:
        record="results/benchmarks/bodies.json",
    log:
        "logs/bench/bodies.log",
    benchmark:
        "logs/bench/bodies.tsv"
    threads: CORES
    params:
        code=benchmark_code("cost/bodies"),
    message:
        "Bodies with two edges beside blocks"
    shell:
        "python -m benchmarks.cost.bodies --out {output.record} >{log}"


rule service:
    input:
        manifest=rules.manifest.output.manifest,
    output:
        record="results/benchmarks/service.json",
    log:
        "logs/bench/service.log",
    benchmark:
        "logs/bench/service.tsv"
    threads: CORES
    params:
        code=benchmark_code("service/performance"),
    message:
        "Load on the service"
    shell:
        "python -m benchmarks.service.performance --out {output.record} >{log}"


rule ablations:
    input:
        manifest=rules.manifest.output.manifest,
    output:
        record="results/benchmarks/ablations.json",
    log:
        "logs/bench/ablations.log",
    benchmark:
        "logs/bench/ablations.tsv"
    threads: CORES
    params:
        code=benchmark_code("ablations/suite"),
    message:
        "Ablations"
    shell:
        "python -m benchmarks.ablations.suite --out {output.record} >{log}"


rule stages:
    input:
        checks=rules.check_results.output.report,
    output:
        record="results/benchmarks/stages.json",
    log:
        "logs/bench/stages.log",
    benchmark:
        "logs/bench/stages.tsv"
    params:
        code=benchmark_code("cost/stages"),
    message:
        "Time of the stages of the reproduction"
    shell:
        "python -m benchmarks.cost.stages --out {output.record} >{log}"


rule bench:
    input:
        diagrams=rules.work_precision_figure.input.records,
        figures=rules.work_precision_figure.output,
        records=expand("results/benchmarks/{name}.json", name=TIMED),
    output:
        summary="results/benchmarks/summary.md",
    log:
        "logs/bench/summary.log",
    benchmark:
        "logs/bench/summary.tsv"
    params:
        code=benchmark_code("summary"),
        folder=lambda wildcards, output: os.path.dirname(output.summary),
    message:
        "Summary of the benchmarks"
    shell:
        "python -m benchmarks.summary --folder {params.folder} >{log}"
