# The claims of the paper against the results, the manifest of all products, and the tests of the finished products.
CLAIM_FILES = {"table": "results/claims.json", "text": "results/claims.md"}
CLAIMS_PROVENANCE = provenance("claims", ["scripts/claims.py"], config["claims"], CLAIM_FILES.values())


rule claims:
    input:
        boundaries=overturning_files("sine", ETAS),
        cubes=spectrum_files("sine", ETAS),
        collapse="results/figures/figure-06.nc",
        similar_blocks="results/figures/figure-09.nc",
        histories=["results/figures/figure-11.nc", "results/figures/figure-12.nc"],
        master="results/figures/figure-master-spectra.nc",
        housner="results/figures/figure-master-housner.nc",
    output:
        **CLAIM_FILES,
        record=record_of("claims", CLAIMS_PROVENANCE),
    log:
        "logs/claims.log",
    benchmark:
        "logs/benchmarks/claims.tsv"
    priority: 1
    resources:
        mem_mb=memory(1000),
        runtime=60,
    params:
        **config["claims"],
        provenance=CLAIMS_PROVENANCE,
    message:
        "Checking the quantitative claims of the paper"
    script:
        "../scripts/claims.py"


RECORDS = [
    *expand(rules.overturning.output.record, pulse=PULSES),
    *expand(rules.spectra.output.record, pulse=PULSES),
    *FIGURE_RECORDS,
    rules.claims.output.record,
]
MANIFEST_CODE = SOURCES.digest(PROJECT / "workflow/scripts/manifest.py")
CHECKS_CODE = SOURCES.digest(*(PROJECT / "workflow/checks").glob("*.py"))


rule manifest:
    input:
        products=list(PRODUCTS),
        records=RECORDS,
    output:
        manifest="results/manifest.json",
        record=record_of("manifest", {"code": MANIFEST_CODE, "sources": PRODUCTS, "title": config["title"]}),
    log:
        "logs/manifest.log",
    benchmark:
        "logs/benchmarks/manifest.tsv"
    localrule: True
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


rule check_results:
    input:
        manifest=rules.manifest.output.manifest,
        tests=[str(path) for path in sorted((PROJECT / "workflow/checks").glob("*.py"))],
    output:
        report="results/checks.txt",
        record=record_of("check_results", {"code": CHECKS_CODE}),
    log:
        "logs/check_results.log",
    benchmark:
        "logs/benchmarks/check_results.tsv"
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
