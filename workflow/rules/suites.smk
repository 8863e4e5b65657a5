# A suite of records (configuration with the key `suite`): one job per record file, so that a large suite spreads over
# cores and machines, then counts, fitted curves and figures.
SUITE = {**DEFAULTS, **config["suite"]}
SUITE_FILES = {path.name: path for path in suite_configuration(SUITE, CONFIG_FOLDER).records.paths()}
SUITE_FOLDER = f"results/suites/{SUITE['name']}"
# asked for by `sensitivity`: one file for each record, and those of the suite
SUITE_ASKS = SUITE.get("sensitivity") is not None
SENSITIVITY_FILES = {name: f"{SUITE_FOLDER}/sensitivity/{name}.nc" for name in SUITE_FILES if SUITE_ASKS}
SENSITIVITY_PRODUCTS = (
    {"sensitivity": f"{SUITE_FOLDER}/sensitivity.nc", "sensitivity_rows": f"{SUITE_FOLDER}/sensitivity.csv"}
    if SUITE_ASKS
    else {}
)
SUITE_FIGURES = {"curves": "fragility", "outcomes": "outcomes", **({"map": "outcomes"} if SUITE["map"] else {})}
# what the response of a record does not depend on
OUTCOME_SETTINGS = {**SUITE, "demand": ["overturning"], "confidence": 0.95}
# names of the jobs, of which `record_of` gives the paths of the records of their products
SUITE_JOBS = f"suites/{SUITE['name']}"

RECORD_PROVENANCE = provenance(
    "suite_record",
    ["scripts/suite_record.py"],
    OUTCOME_SETTINGS,
    [*(f"{SUITE_FOLDER}/records/{name}.nc" for name in SUITE_FILES), *SENSITIVITY_FILES.values()],
)
FRAGILITY_PROVENANCE = provenance(
    "suite_fragility",
    ["scripts/suite_fragility.py"],
    SUITE,
    [
        *(f"{SUITE_FOLDER}/{name}" for name in ("outcomes.nc", "fragility.nc", "fragility.csv")),
        *SENSITIVITY_PRODUCTS.values(),
    ],
)


wildcard_constraints:
    file="|".join(map(re.escape, SUITE_FILES)),


rule suite_record:
    input:
        file=lambda wildcards: os.path.relpath(SUITE_FILES[wildcards.file]),  # the checkout may be moved
    output:
        **({"sensitivity": f"{SUITE_FOLDER}/sensitivity/{{file}}.nc"} if SUITE_ASKS else {}),
        outcomes=f"{SUITE_FOLDER}/records/{{file}}.nc",
        record=record_of(f"{SUITE_JOBS}/records/{{file}}", RECORD_PROVENANCE),
    log:
        f"logs/suites/{SUITE['name']}/{{file}}.log",
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(800),
        runtime=120,
    params:
        suite=OUTCOME_SETTINGS,
        provenance=RECORD_PROVENANCE,
    message:
        "Responses to {wildcards.file}"
    script:
        "../scripts/suite_record.py"


rule suite_fragility:
    input:
        files=expand(rules.suite_record.output.outcomes, file=SUITE_FILES),
        sensitivities=list(SENSITIVITY_FILES.values()),
    output:
        **SENSITIVITY_PRODUCTS,
        outcomes=f"{SUITE_FOLDER}/outcomes.nc",
        fragility=f"{SUITE_FOLDER}/fragility.nc",
        table=f"{SUITE_FOLDER}/fragility.csv",
        record=record_of(f"{SUITE_JOBS}/fragility", FRAGILITY_PROVENANCE),
    log:
        f"logs/suites/{SUITE['name']}/fragility.log",
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(800),
        runtime=60,
    params:
        suite=SUITE,
        provenance=FRAGILITY_PROVENANCE,
    message:
        "Fragility under the suite"
    script:
        "../scripts/suite_fragility.py"


SUITE_FIGURE_RECORDS = []

for _figure, _source in SUITE_FIGURES.items():
    _files = {kind: f"{SUITE_FOLDER}/figures/{_figure}.{kind}" for kind in ("svg", "png", "nc")}
    _provenance = provenance(
        f"suite_figure_{_figure}", ["scripts/figure.py", f"figures/suite_{_figure}.py"], {}, _files.values()
    )
    SUITE_FIGURE_RECORDS.append(record_of(f"{SUITE_JOBS}/figures/{_figure}", _provenance))

    rule:
        name:
            f"suite_figure_{_figure}"
        input:
            **{_source: f"{SUITE_FOLDER}/{_source}.nc"},
        output:
            **_files,
            record=SUITE_FIGURE_RECORDS[-1],
        log:
            f"logs/suites/{SUITE['name']}/{_figure}.log",
        localrule: True
        conda:
            "../envs/rocking.yaml"
        resources:
            mem_mb=memory(800),
            runtime=60,
        params:
            figure=f"suite_{_figure}",
            provenance=_provenance,
        message:
            f"Drawing {_figure} of the suite"
        script:
            "../scripts/figure.py"


SUITE_MANIFEST_CODE = SOURCES.digest(PROJECT / "workflow/scripts/manifest.py")


rule suite_manifest:
    input:
        products=list(PRODUCTS),
        records=[
            *expand(rules.suite_record.output.record, file=SUITE_FILES),
            rules.suite_fragility.output.record,
            *SUITE_FIGURE_RECORDS,
        ],
    output:
        manifest=f"{SUITE_FOLDER}/manifest.json",
        record=record_of(
            f"{SUITE_JOBS}/manifest", {"code": SUITE_MANIFEST_CODE, "sources": PRODUCTS, "title": config["title"]}
        ),
    log:
        f"logs/suites/{SUITE['name']}/manifest.log",
    localrule: True
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(300),
        runtime=30,
    params:
        sources=PRODUCTS,
        title=config["title"],
        code=SUITE_MANIFEST_CODE,
    message:
        "Listing the products of the suite"
    script:
        "../scripts/manifest.py"


FINISHED += [*rules.suite_manifest.input, *rules.suite_manifest.output]
