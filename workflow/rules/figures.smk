# workflow/figures/figure_03.py makes figure-03.svg, .png and the plotted data in figure-03.nc. One job draws figures that
# share their data or their libraries, as its start takes longer than a small figure.
DRAWN_TOGETHER = {
    "closed_forms": ["figure-01", "figure-03", "figure-S1", "table-1"],
    "histories": ["figure-02", "figure-05", "figure-06", "figure-07", "figure-11", "figure-12"],
    "spectrum_curves": ["figure-08", "figure-13"],
    "boundaries": ["figure-04", "figure-09", "figure-10"],
    "master_spectra": ["figure-master-spectra", "figure-master-housner"],
    "scale_law": ["figure-scale-law", "figure-scale-law-excitations"],
}
# figures with the caption of another one
CAPTIONS = {"figure-06": "figure-05", "figure-12": "figure-11", "figure-master-housner": "figure-master-spectra"}


def boundaries_of(figure):
    """The boundaries of sine and cosine at the restitution of a figure."""
    (eta,) = restitutions(config, figure)
    return {pulse: overturning_files(pulse, [eta])[0] for pulse in ("sine", "cosine")}


# files that a figure reads, by the arguments of its function `data`
FIGURE_INPUTS = {
    "figure-04": {"boundaries": overturning_files("sine", restitutions(config, "figure-04"))},
    "figure-09": boundaries_of("figure-09"),
    "figure-10": boundaries_of("figure-10"),
    "figure-master-spectra": boundaries_of("figure-master-spectra"),
    "figure-scale-law": {"cubes": spectrum_files("sine", restitutions(config, "figure-scale-law"))},
}
FIGURE_FILES = {
    figure: {kind: f"results/figures/{figure}.{kind}" for kind in ("svg", "png", "nc")} for figure in config["figures"]
}
# the records of a figure are files of workflow/motions: their digests are settings, as paths change with the folder of a run
FIGURE_RECORDS = {
    figure: {
        name: sha256_of_file(PROJECT / "workflow/motions" / name) for name in chosen(config, figure).get("records", [])
    }
    for figure in config["figures"]
}
FIGURE_PROVENANCE = {
    figure: provenance(
        ["scripts/figures.py", f"figures/{figure.replace('-', '_')}.py"],
        {**config["figures"][figure], **({"motions": FIGURE_RECORDS[figure]} if FIGURE_RECORDS[figure] else {})},
    )
    for figure in config["figures"]
}
GROUPED = [figure for group in DRAWN_TOGETHER.values() for figure in group]
DRAWN_TOGETHER |= {figure.replace("-", "_"): [figure] for figure in config["figures"] if figure not in GROUPED}

for _group, _figures in DRAWN_TOGETHER.items():
    for _figure in _figures:
        list_products(f"figures_{_group}", FIGURE_PROVENANCE[_figure], FIGURE_FILES[_figure].values())

    rule:
        name:
            f"figures_{_group}"
        input:
            [path for figure in _figures for path in FIGURE_INPUTS.get(figure, {}).values()],
        output:
            [FIGURE_FILES[figure][kind] for figure in _figures for kind in ("svg", "nc")],
            [
                report(
                    FIGURE_FILES[figure]["png"],
                    caption=f"../report/{CAPTIONS.get(figure, figure)}.rst",
                    category="Figures",
                    labels={"figure": figure},
                )
                for figure in _figures
            ],
        log:
            f"logs/figures/{_group}.log",
        benchmark:
            f"logs/benchmarks/figures-{_group}.tsv"
        priority: 1
        localrule: True
        conda:
            "../envs/rocking.yaml"
        params:
            figures={
                figure: {
                    **config["figures"][figure],
                    "files": FIGURE_FILES[figure],
                    "inputs": FIGURE_INPUTS.get(figure, {}),
                    "provenance": FIGURE_PROVENANCE[figure],
                }
                for figure in _figures
            },
        message:
            f"Drawing {', '.join(_figures)}"
        script:
            "../scripts/figures.py"
