# The manifest of all products, and the tests of the finished products: those of the data sets as soon as they are made.
MANIFEST_CODE = SOURCES.digest(PROJECT / "workflow/scripts/manifest.py")
CHECKS = PROJECT / "workflow/checks"
DATA_CHECKS_CODE = SOURCES.digest(CHECKS / "test_data_sets.py", CHECKS / "report.py")
CHECKS_CODE = SOURCES.digest(*CHECKS.glob("*.py"))


rule manifest:
    input:
        products=list(PRODUCTS),
        records=RECORDS,
    output:
        manifest="results/manifest.json",
        record=record_of("manifest", {"code": MANIFEST_CODE, "sources": PRODUCTS, "title": config["title"]}),
    log:
        "logs/manifest.log",
    localrule: True
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(300),
        runtime=30,
    params:
        sources=PRODUCTS,
        title=config["title"],
        code=MANIFEST_CODE,
    message:
        "Listing all products"
    script:
        "../scripts/manifest.py"


rule check_data_sets:
    input:
        boundaries=overturning_files("{pulse}", ETAS),
        cubes=spectrum_files("{pulse}", ETAS),
    output:
        report=f"{records.FOLDER}/checks/{{pulse}}.txt",
        record=record_of(
            "checks/{pulse}",
            {"code": DATA_CHECKS_CODE, "spectra": SPECTRUM_PROVENANCE, "overturning": OVERTURNING_PROVENANCE},
        ),
    log:
        "logs/checks/{pulse}.log",
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(1200),
        runtime=120,
    params:
        code=DATA_CHECKS_CODE,
    message:
        "Testing the data sets of the {wildcards.pulse} pulse"
    script:
        "../scripts/check_data_sets.py"


rule check_results:
    input:
        manifest=rules.manifest.output.manifest,
        reports=expand(rules.check_data_sets.output.report, pulse=PULSES),
    output:
        report="results/checks.txt",
        record=record_of("check_results", {"code": CHECKS_CODE}),
    log:
        "logs/check_results.log",
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(1200),
        runtime=60,
    params:
        code=CHECKS_CODE,
    message:
        "Testing the finished products"
    script:
        "../scripts/check_results.py"


FINISHED += [*rules.manifest.input, *rules.manifest.output, *rules.check_results.output]
