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
