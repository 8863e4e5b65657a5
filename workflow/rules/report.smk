# The manifest of all products, and the tests of the finished products.
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
