# The claims of the paper against the results.
CLAIM_FILES = {"table": "results/claims.json", "text": "results/claims.md", "page": "results/claims.html"}
# pages that the script reads: their digests are settings, as paths change with the folder of a run
CLAIM_PAGES = ["workflow/claims/statements.md", "docs/equations.md"]
CLAIMS_PROVENANCE = provenance(
    ["scripts/claims.py"],
    {**config["claims"], "pages": {page: sha256_of_file(PROJECT / page) for page in CLAIM_PAGES}},
)
list_products("claims", CLAIMS_PROVENANCE, CLAIM_FILES.values())


rule claims:
    input:
        boundaries=overturning_files("sine", ETAS.values()),
        cubes=spectrum_files("sine", ETAS.values()),
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
    log:
        "logs/claims.log",
    benchmark:
        "logs/benchmarks/claims.tsv"
    priority: 1
    conda:
        "../envs/rocking.yaml"
    params:
        **config["claims"],
        provenance=CLAIMS_PROVENANCE,
    script:
        "../scripts/claims.py"
