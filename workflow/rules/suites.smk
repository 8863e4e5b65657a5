# A suite of records (configuration with the key `suite`): one job for each record file, so that a large suite spreads over
# cores and machines, then counts, fitted curves and figures.
SUITE = config["suite"]
RESULTS = f"results/suites/{SUITE['name']}"
SUITE_LOGS = f"logs/suites/{SUITE['name']}"
SUITE_FILES = {path.name: path for path in suite_configuration(SUITE, CONFIG_FOLDER).records.paths()}
# asked for by `sensitivity`: one file for each record, and those of the suite
HAS_SENSITIVITY = SUITE["sensitivity"] is not None
SENSITIVITY_FILES, SENSITIVITY_PRODUCTS = [], {}
if HAS_SENSITIVITY:
    SENSITIVITY_FILES = expand(f"{RESULTS}/sensitivity/{{file}}.nc", file=SUITE_FILES)
    SENSITIVITY_PRODUCTS["sensitivity"] = f"{RESULTS}/sensitivity.nc"
    SENSITIVITY_PRODUCTS["sensitivity_rows"] = f"{RESULTS}/sensitivity.csv"
# figures and the data set that each is drawn from
SUITE_FIGURES = {"curves": "fragility", "outcomes": "outcomes"}
if SUITE["map"] is not None:
    SUITE_FIGURES["map"] = "outcomes"
# what the response of a record does not depend on
OUTCOME_SETTINGS = {**SUITE, "demand": ["overturning"], "confidence": 0.95}

RECORD_PROVENANCE = provenance(["scripts/suite_record.py"], OUTCOME_SETTINGS)
FRAGILITY_PROVENANCE = provenance(["scripts/suite_fragility.py"], SUITE)
FRAGILITY_FILES = [f"{RESULTS}/{name}" for name in ("outcomes.nc", "fragility.nc", "fragility.csv")]
list_products("suite_record", RECORD_PROVENANCE, expand(f"{RESULTS}/records/{{file}}.nc", file=SUITE_FILES))
list_products("suite_record", RECORD_PROVENANCE, SENSITIVITY_FILES)
list_products("suite_fragility", FRAGILITY_PROVENANCE, [*FRAGILITY_FILES, *SENSITIVITY_PRODUCTS.values()])


wildcard_constraints:
    file="|".join(map(re.escape, SUITE_FILES)),


rule suite_record:
    input:
        file=lambda wildcards: os.path.relpath(SUITE_FILES[wildcards.file]),  # the checkout may be moved
    output:
        **({"sensitivity": f"{RESULTS}/sensitivity/{{file}}.nc"} if HAS_SENSITIVITY else {}),
        outcomes=f"{RESULTS}/records/{{file}}.nc",
    log:
        f"{SUITE_LOGS}/{{file}}.log",
    benchmark:
        f"{SUITE_LOGS}/benchmarks/{{file}}.tsv"
    conda:
        "../envs/rocking.yaml"
    params:
        suite=OUTCOME_SETTINGS,
        provenance=RECORD_PROVENANCE,
    script:
        "../scripts/suite_record.py"


rule suite_fragility:
    input:
        files=expand(rules.suite_record.output.outcomes, file=SUITE_FILES),
        sensitivities=SENSITIVITY_FILES,
    output:
        **SENSITIVITY_PRODUCTS,
        outcomes=FRAGILITY_FILES[0],
        fragility=FRAGILITY_FILES[1],
        table=FRAGILITY_FILES[2],
    log:
        f"{SUITE_LOGS}/fragility.log",
    benchmark:
        f"{SUITE_LOGS}/benchmarks/fragility.tsv"
    conda:
        "../envs/rocking.yaml"
    params:
        suite=SUITE,
        provenance=FRAGILITY_PROVENANCE,
    script:
        "../scripts/suite_fragility.py"


SUITE_FIGURE_FILES = {
    figure: {kind: f"{RESULTS}/figures/{figure}.{kind}" for kind in ("svg", "png", "nc")} for figure in SUITE_FIGURES
}
SUITE_FIGURE_PROVENANCE = {
    figure: provenance(["scripts/figures.py", f"figures/suite_{figure}.py"], {}) for figure in SUITE_FIGURES
}
for _figure, _files in SUITE_FIGURE_FILES.items():
    list_products("suite_figures", SUITE_FIGURE_PROVENANCE[_figure], _files.values())


rule suite_figures:
    input:
        [f"{RESULTS}/{source}.nc" for source in set(SUITE_FIGURES.values())],
    output:
        [path for files in SUITE_FIGURE_FILES.values() for path in files.values()],
    log:
        f"{SUITE_LOGS}/figures.log",
    localrule: True
    conda:
        "../envs/rocking.yaml"
    params:
        figures={
            f"suite_{figure}": {
                "files": SUITE_FIGURE_FILES[figure],
                "inputs": {source: f"{RESULTS}/{source}.nc"},
                "provenance": SUITE_FIGURE_PROVENANCE[figure],
            }
            for figure, source in SUITE_FIGURES.items()
        },
    script:
        "../scripts/figures.py"
