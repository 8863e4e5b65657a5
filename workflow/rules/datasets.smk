# Each pulse and restitution: the overturning boundaries, and the spectrum cube, which does not interpolate across them.
# Then, for each pulse, the errors of interpolation between its cubes, and all cubes as one zarr store. Another restitution
# makes its own boundary and cube, and these two again. Boundaries have priority, as figures and claims depend on them.
ETAS = {f"{eta:.2f}": eta for eta in config["restitution"]}
PULSES = different(configured_pulse(entry, CONFIG_FOLDER) for entry in config["pulses"])
# what a job is given: a name, or samples; paths are relative, as the checkout may be moved
ENTRIES = {
    name: name if isinstance(pulse, str) else relative_entry(entry, os.path.relpath(CONFIG_FOLDER))
    for (name, pulse), entry in zip(PULSES.items(), config["pulses"])
}
SAMPLE_FILES = {name: entry["file"] for name, entry in ENTRIES.items() if name != entry and "file" in entry}


wildcard_constraints:
    pulse="|".join(map(re.escape, PULSES)),
    eta="|".join(map(re.escape, ETAS)),


CUBE_MB = 300 + BYTES * nodes_of_cube(config) / 1e6
LEVELS_MB = 400 + (BYTES + 4 * len(ETAS)) * nodes_of_cube(config) / 1e6
BOUNDARY_SETTINGS = {**config["boundary"], "alpha_deg": config["grid"]["alpha_deg"]}
BOUNDARY_PROVENANCE = provenance(["scripts/overturning.py"], BOUNDARY_SETTINGS)
CUBE_PROVENANCE = provenance(["scripts/spectra.py"], config["grid"])
ERRORS_PROVENANCE = provenance(["scripts/restitution_errors.py"], {"restitution": config["restitution"]})
STORE_PROVENANCE = provenance(["scripts/zarr_store.py"], {})
STAC_PROVENANCE = provenance(["scripts/stac.py"], {})
list_products("stac", STAC_PROVENANCE, ["results/stac"])

for name, pulse in PULSES.items():
    samples = {} if isinstance(pulse, str) else {"pulse_sha256": pulse.digest}
    list_products("overturning", BOUNDARY_PROVENANCE, overturning_files(name, ETAS.values()), **samples)
    list_products("spectra", CUBE_PROVENANCE, spectrum_files(name, ETAS.values()), **samples)
    list_products("restitution_errors", ERRORS_PROVENANCE, [f"results/spectra/{name}/restitution-errors.nc"], **samples)
    list_products("zarr_store", STORE_PROVENANCE, [f"results/zarr/{name}.zarr"], **samples)


rule overturning:
    input:
        samples=lambda wildcards: SAMPLE_FILES.get(wildcards.pulse, []),
    output:
        boundaries="results/overturning/{pulse}/eta-{eta}.nc",
    log:
        "logs/overturning/{pulse}-{eta}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}-{eta}.tsv"
    priority: 3
    conda:
        "../envs/rocking.yaml"
    params:
        **BOUNDARY_SETTINGS,
        pulse=lambda wildcards: ENTRIES[wildcards.pulse],
        restitution=lambda wildcards: ETAS[wildcards.eta],
        provenance=BOUNDARY_PROVENANCE,
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse at restitution {wildcards.eta}"
    script:
        "../scripts/overturning.py"


rule spectra:
    input:
        boundaries=rules.overturning.output.boundaries,
        samples=rules.overturning.input.samples,
    output:
        cube="results/spectra/{pulse}/eta-{eta}.nc",
    log:
        "logs/spectra/{pulse}-{eta}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}-{eta}.tsv"
    priority: 2
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(CUBE_MB),
    params:
        grid=config["grid"],
        pulse=lambda wildcards: ENTRIES[wildcards.pulse],
        restitution=lambda wildcards: ETAS[wildcards.eta],
        provenance=CUBE_PROVENANCE,
    message:
        "Spectrum cube of the {wildcards.pulse} pulse at restitution {wildcards.eta}"
    script:
        "../scripts/spectra.py"


rule restitution_errors:
    input:
        cubes=lambda wildcards: spectrum_files(wildcards.pulse, ETAS.values()),
        samples=rules.overturning.input.samples,
    output:
        errors="results/spectra/{pulse}/restitution-errors.nc",
    log:
        "logs/restitution_errors/{pulse}.log",
    benchmark:
        "logs/benchmarks/restitution_errors-{pulse}.tsv"
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(LEVELS_MB),
    params:
        pulse=lambda wildcards: ENTRIES[wildcards.pulse],
        provenance=ERRORS_PROVENANCE,
    script:
        "../scripts/restitution_errors.py"


rule zarr_store:
    input:
        cubes=lambda wildcards: spectrum_files(wildcards.pulse, ETAS.values()),
    output:
        store=directory("results/zarr/{pulse}.zarr"),
    log:
        "logs/zarr/{pulse}.log",
    benchmark:
        "logs/benchmarks/zarr-{pulse}.tsv"
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(CUBE_MB),
    params:
        provenance=STORE_PROVENANCE,
    script:
        "../scripts/zarr_store.py"


# The data sets for catalogues of other data: https://stacspec.org, with the extension for data cubes.
rule stac:
    input:
        cubes=[path for pulse in PULSES for path in spectrum_files(pulse, ETAS.values())],
        boundaries=[path for pulse in PULSES for path in overturning_files(pulse, ETAS.values())],
        stores=[f"results/zarr/{pulse}.zarr" for pulse in PULSES],
    output:
        folder=directory("results/stac"),
    log:
        "logs/stac.log",
    benchmark:
        "logs/benchmarks/stac.tsv"
    localrule: True
    conda:
        "../envs/rocking.yaml"
    params:
        provenance=STAC_PROVENANCE,
    message:
        "Describing the data sets as a STAC catalogue"
    script:
        "../scripts/stac.py"
