# The list of all products with their digests.


rule manifest:
    input:
        products=list(PRODUCTS),
    output:
        manifest=f"{RESULTS}/manifest.json",
    log:
        f"logs/{RESULTS}/manifest.log",
    localrule: True
    conda:
        "../envs/rocking.yaml"
    params:
        sources=PRODUCTS,
        title=config["title"],
        code=product_code("scripts/manifest.py"),
    message:
        "Listing all products"
    script:
        "../scripts/manifest.py"


# The run as a RO-Crate: https://www.researchobject.org/ro-crate.
rule ro_crate:
    input:
        manifest=rules.manifest.output.manifest,
    output:
        crate=f"{RESULTS}/ro-crate-metadata.json",
    log:
        f"logs/{RESULTS}/ro_crate.log",
    benchmark:
        f"logs/benchmarks/{RESULTS}/ro_crate.tsv"
    localrule: True
    conda:
        "../envs/rocking.yaml"
    params:
        configuration=config,
        code=product_code("scripts/ro_crate.py"),
        citation=sha256_of_file(PROJECT / "CITATION.cff"),
    message:
        "Describing the run as a RO-Crate"
    script:
        "../scripts/ro_crate.py"
