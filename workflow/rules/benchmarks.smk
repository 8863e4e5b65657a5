# The benchmarks: `snakemake bench`, or `make bench`. A job is one command of `benchmarks`; one job runs at a time, so that
# measurements do not disturb each other. Its output goes to its log, its progress to the terminal.
DIAGRAMS = sorted(path.stem for path in (PROJECT / "benchmarks/data").glob("*-*.csv"))
TIMED = ["tolerance", "solver", "first-call", "records", "service"]


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
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=benchmark_code("cost/work_precision"),
        baselines=installed_baselines,
        folder=lambda wildcards, output: os.path.dirname(output.record),
    message:
        "Run time against error, {wildcards.diagram}"
    shell:
        "python -m benchmarks.cost.work_precision {wildcards.diagram} --out {params.folder} >{log}"


rule tolerance:
    input:
        cells=str(PROJECT / "benchmarks/data/random.csv"),
    output:
        record="results/benchmarks/tolerance.json",
    log:
        "logs/bench/tolerance.log",
    benchmark:
        "logs/bench/tolerance.tsv"
    conda:
        "../envs/rocking.yaml"
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
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=benchmark_code("cost/solver"),
    message:
        "Time of a cell for each pulse"
    shell:
        "python -m benchmarks.cost.solver --out {output.record} >{log}"


rule first_call:
    output:
        record="results/benchmarks/first-call.json",
    log:
        "logs/bench/first-call.log",
    benchmark:
        "logs/bench/first-call.tsv"
    conda:
        "../envs/rocking.yaml"
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
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=benchmark_code("cost/records"),
    message:
        "Responses under recorded motions"
    shell:
        "python -m benchmarks.cost.records --out {output.record} >{log}"


rule service:
    input:
        manifest=rules.manifest.output.manifest,
    output:
        record="results/benchmarks/service.json",
    log:
        "logs/bench/service.log",
    benchmark:
        "logs/bench/service.tsv"
    conda:
        "../envs/rocking.yaml"
    threads: CORES
    params:
        code=benchmark_code("cost/service"),
    message:
        "Load on the service"
    shell:
        "python -m benchmarks.cost.service --out {output.record} >{log}"


rule bench:
    input:
        diagrams=expand(rules.work_precision.output.record, diagram=DIAGRAMS),
        records=expand("results/benchmarks/{name}.json", name=TIMED),
    output:
        summary="results/benchmarks/summary.txt",
    log:
        "logs/bench/summary.log",
    benchmark:
        "logs/bench/summary.tsv"
    conda:
        "../envs/rocking.yaml"
    params:
        tables=lambda wildcards, input: [f"{os.path.splitext(path)[0]}.txt" for path in input],
    message:
        "Summary of the benchmarks"
    shell:
        "cat {params.tables} >{output.summary} 2>{log}"
