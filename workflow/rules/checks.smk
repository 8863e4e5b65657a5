# The tests of the finished products: those of the data sets of a pulse as soon as they are made.
DATA_CHECKS = ["checks/test_data_sets.py", "checks/report.py"]


rule check_data_sets:
    input:
        boundaries=lambda wildcards: overturning_files(wildcards.pulse, ETAS.values()),
        cubes=lambda wildcards: spectrum_files(wildcards.pulse, ETAS.values()),
        errors=rules.restitution_errors.output.errors,
    output:
        report="results/checks/{pulse}.txt",
    log:
        "logs/checks/{pulse}.log",
    benchmark:
        "logs/benchmarks/checks-{pulse}.tsv"
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(1200),
    params:
        code=product_code("scripts/check_data_sets.py", *DATA_CHECKS),
    message:
        "Testing the data sets of the {wildcards.pulse} pulse"
    script:
        "../scripts/check_data_sets.py"


rule check_results:
    input:
        manifest="results/manifest.json",
        products=lambda wildcards: list(PRODUCTS),
        reports=expand(rules.check_data_sets.output.report, pulse=PULSES),
    output:
        report="results/checks.txt",
    log:
        "logs/check_results.log",
    benchmark:
        "logs/benchmarks/check_results.tsv"
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(1200),
    params:
        code=product_code("scripts/check_results.py", "checks/test_products.py", *DATA_CHECKS),
    script:
        "../scripts/check_results.py"


CHECKED += rules.check_results.output
