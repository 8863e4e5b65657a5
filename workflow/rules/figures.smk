# One rule per figure: workflow/figures/figure_03.py makes figure-03.svg, .png and the plotted data in figure-03.nc.
_figures = config["figures"]
FIGURE_INPUTS = {
    "figure-04": {"boundaries": overturning_files("sine", restitutions(config, "figure-04"))},
    "figure-09": {
        "boundaries": [overturning_files(pulse, restitutions(config, "figure-09"))[0] for pulse in ("sine", "cosine")]
    },
    **{
        figure: {pulse: overturning_files(pulse, restitutions(config, figure))[0] for pulse in ("sine", "cosine")}
        for figure in ("figure-10", "figure-master-spectra")
    },
    "figure-scale-law": {"cubes": spectrum_files("sine", restitutions(config, "figure-scale-law"))},
}
FIGURES = {figure: {kind: f"results/figures/{figure}.{kind}" for kind in ("svg", "png", "nc")} for figure in _figures}
READ_BY_CLAIMS = [
    "figure-06",
    "figure-09",
    "figure-11",
    "figure-12",
    "figure-master-spectra",
    "figure-master-housner",
    "figure-scale-law-excitations",
]

# for `snakemake --report`: the captions of the guide, by figure; a changed one repeats no job
GUIDE = (PROJECT / "docs/figures.md").read_text(encoding="utf-8") if (PROJECT / "docs/figures.md").exists() else ""
SECTIONS = {section.partition("\n")[0]: section.partition("\n")[2].strip() for section in GUIDE.split("\n## ")[1:]}
ANCHORS = {re.sub(r"[^a-z0-9]+", "-", title.lower()): text for title, text in SECTIONS.items()}
config["captions"] = {
    figure: ANCHORS[anchor] for figure, anchor in re.findall(r"\[(\S+)\]\(#(\S+)\) \|", GUIDE) if anchor in ANCHORS
}

for _figure, _files in FIGURES.items():
    _name = _figure.replace("-", "_")
    _read = {
        name: records.digest(PROJECT / "workflow/motions" / name)["sha256"]
        for name in chosen(config, _figure).get("records", ())
    }
    _settings = {**_figures[_figure], **({"motions": _read} if _read else {})}
    _provenance = provenance(_name, ["scripts/figure.py", f"figures/{_name}.py"], _settings, _files.values())
    RECORDS.append(record_of(f"figures/{_figure}", _provenance))

    rule:
        name:
            _name
        input:
            **FIGURE_INPUTS.get(_figure, {}),
        output:
            svg=_files["svg"],
            png=report(_files["png"], caption="../report/figure.rst", category="Figures", labels={"figure": _figure}),
            nc=_files["nc"],
            record=RECORDS[-1],
        log:
            f"logs/figures/{_figure}.log",
        priority: int(_figure in READ_BY_CLAIMS)
        localrule: True
        conda:
            "../envs/rocking.yaml"
        resources:
            mem_mb=memory(800),
            runtime=60,
        params:
            **_figures[_figure],
            figure=_name,
            provenance=_provenance,
        message:
            f"Drawing {_figure}"
        script:
            "../scripts/figure.py"
