# The claims of the paper against the results, the manifest of all products, and the tests of the finished products.
CLAIM_FILES = {"table": "results/claims.json", "text": "results/claims.md"}


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
        record=record_of("claims"),
    log:
        "logs/claims.log",
    benchmark:
        "logs/benchmarks/claims.tsv"
    priority: 1
    params:
        **config["claims"],
        provenance=provenance("claims", ["scripts/claims.py"], config["claims"], CLAIM_FILES.values()),
    message:
        "Checking the quantitative claims of the paper"
    script:
        "../scripts/claims.py"


RECORDS = [
    *expand(record_of("{kind}/{pulse}"), kind=["overturning", "spectra"], pulse=PULSES),
    *(record_of(f"figures/{figure}") for figure in FIGURES),
    record_of("claims"),
]


rule manifest:
    input:
        products=list(PRODUCTS),
        records=RECORDS,
    output:
        manifest="results/manifest.json",
        record=record_of("manifest"),
    log:
        "logs/manifest.log",
    benchmark:
        "logs/benchmarks/manifest.tsv"
    params:
        sources=PRODUCTS,
        title=config["title"],
        code=code_digest(PROJECT / "workflow/scripts/manifest.py"),
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
        record=record_of("check_results"),
    log:
        "logs/check_results.log",
    benchmark:
        "logs/benchmarks/check_results.tsv"
    params:
        code=code_digest(*(PROJECT / "workflow/checks").glob("*.py")),
    message:
        "Testing the finished products"
    script:
        "../scripts/check_results.py"


FINISHED += [*rules.manifest.input, *rules.manifest.output, *rules.check_results.output]
