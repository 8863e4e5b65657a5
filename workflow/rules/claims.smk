# The claims of the paper against the results.
CLAIM_FILES = {"table": "results/claims.json", "text": "results/claims.md", "page": "results/claims.html"}
CLAIMS_PROVENANCE = provenance("claims", ["scripts/claims.py"], config["claims"], CLAIM_FILES.values())


rule claims:
    input:
        boundaries=overturning_files("sine", ETAS),
        cubes=spectrum_files("sine", ETAS),
        collapse="results/figures/figure-06.nc",
        similar_blocks="results/figures/figure-09.nc",
        histories=["results/figures/figure-11.nc", "results/figures/figure-12.nc"],
        master="results/figures/figure-master-spectra.nc",
        momentum="results/figures/figure-master-housner.nc",
        excitations="results/figures/figure-scale-law-excitations.nc",
    output:
        table=CLAIM_FILES["table"],
        text=CLAIM_FILES["text"],
        page=report(CLAIM_FILES["page"], caption="../report/claims.rst", category="Claims"),
        record=record_of("claims", CLAIMS_PROVENANCE),
    log:
        "logs/claims.log",
    priority: 1
    conda:
        "../envs/rocking.yaml"
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


RECORDS.append(rules.claims.output.record)
