# The tests of the finished products, in the words of pytest: those of the data sets of a pulse as soon as they are made. A
# report has a line for each test, without times.
TESTED = (
    "env ROCKING_RESULTS=results PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 ROCKING_DATA_SETS='{params.data_sets}' "
    "python -m pytest -q -rA -p no:cacheprovider --pyargs {params.tests} >{log} && "
    "sed -n 's/^PASSED .*::/passed /p' {log} | cat - {params.reports} | sort >{output}"
)


rule check_data_sets:
    input:
        boundaries=lambda wildcards: overturning_files(wildcards.pulse, ETAS.values()),
        cubes=lambda wildcards: spectrum_files(wildcards.pulse, ETAS.values()),
        errors=rules.restitution_errors.output.errors,
    output:
        report="results/checks/{pulse}.txt",
    log:
        "logs/checks/{pulse}.log",
    conda:
        "../envs/rocking.yaml"
    params:
        code=product_code("checks/test_data_sets.py"),
        tests="workflow.checks.test_data_sets",
        data_sets=lambda wildcards, input: " ".join(input),
        reports="",
    message:
        "Testing the data sets of the {wildcards.pulse} pulse"
    shell:
        TESTED


rule check_results:
    input:
        manifest="results/manifest.json",
        products=lambda wildcards: list(PRODUCTS),
        reports=expand(rules.check_data_sets.output.report, pulse=PULSES),
    output:
        report="results/checks.txt",
    log:
        "logs/check_results.log",
    conda:
        "../envs/rocking.yaml"
    params:
        code=product_code("checks/test_products.py"),
        tests="workflow.checks.test_products",
        data_sets="",
        reports=lambda wildcards, input: input.reports,
    shell:
        TESTED


CHECKED += rules.check_results.output
