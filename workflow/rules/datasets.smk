# Overturning boundaries, then spectrum cubes. Boundaries are traced by pulse and angle, cubes filled by pulse and band of
# rows, each for all coefficients of restitution, which share the starts of the motions; one job of the pulse joins these
# parts to the files of each restitution. These jobs have priority, as figures and claims depend on them.
ETAS = [f"{eta:.2f}" for eta in config["restitution"]]
ANGLES = {str(angle): angle for angle in config["grid"]["alpha_deg"]}
BANDS = {f"{first}-{last}": (first, last) for first, last in tile_bands(config)}
ENTRIES = [(configured_pulse(entry, CONFIG_FOLDER), entry) for entry in config["pulses"]]
PULSES = list(different(pulse for pulse, _ in ENTRIES))
# of the pulses given by samples: the file of the samples, which names their digest, and the entry of the configuration
SAMPLES = {pulse.name: samples_file(pulse) for pulse, _ in ENTRIES if not isinstance(pulse, str)}
SAMPLED = {pulse.name: entry for pulse, entry in ENTRIES if not isinstance(pulse, str)}


wildcard_constraints:
    pulse="[a-z0-9_]+",
    angle="|".join(map(re.escape, ANGLES)),
    band="|".join(BANDS),
    samples="[0-9a-f]{16}",


# the curves of one angle at all restitutions, of c2, which has the most
PART_MB = 300 + 40 * len(ETAS)
TILE_MB, CUBE_MB = (300 + BYTES * nodes / 1e6 for nodes in (nodes_of_tile(config), nodes_of_cube(config)))
SPECTRUM_SETTINGS = {"grid": config["grid"], "restitution": config["restitution"]}
SPECTRUM_PROVENANCE = provenance(
    "spectra",
    ["scripts/spectra.py", "scripts/spectrum_tile.py"],
    SPECTRUM_SETTINGS,
    [path for pulse in PULSES for path in spectrum_files(pulse, ETAS)],
)
OVERTURNING_SETTINGS = {
    "boundary": config["boundary"],
    "alpha_deg": config["grid"]["alpha_deg"],
    "restitution": config["restitution"],
}
OVERTURNING_PROVENANCE = provenance(
    "overturning",
    ["scripts/overturning.py"],
    OVERTURNING_SETTINGS,
    [path for pulse in PULSES for path in overturning_files(pulse, ETAS)],
)


for pulse, _ in ENTRIES:
    if not isinstance(pulse, str):
        for path in (*spectrum_files(pulse.name, ETAS), *overturning_files(pulse.name, ETAS)):
            PRODUCTS[path]["pulse_sha256"] = pulse.digest


rule samples:
    output:
        samples=f"{parts.FOLDER}/pulses/{{pulse}}.{{samples}}.json",
    log:
        "logs/pulses/{pulse}.{samples}.log",
    benchmark:
        "logs/benchmarks/pulses-{pulse}-{samples}.tsv"
    localrule: True
    resources:
        mem_mb=memory(300),
        runtime=10,
    params:
        pulse=lambda wildcards: SAMPLED[wildcards.pulse],
        folder=str(CONFIG_FOLDER.resolve()),
    message:
        "Samples of the {wildcards.pulse} pulse"
    script:
        "../scripts/samples.py"


# one job for each pulse and angle traces the curves of all restitutions, which share the grid
rule overturning_part:
    input:
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        part=temp(part_of("overturning/{pulse}-{angle}", OVERTURNING_PROVENANCE)),
    log:
        "logs/overturning/{pulse}-{angle}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}-{angle}.tsv"
    priority: 3
    resources:
        mem_mb=memory(PART_MB),
        runtime=240,
    params:
        pulse=lambda wildcards: wildcards.pulse,
        restitution=config["restitution"],
        alpha_deg=lambda wildcards: ANGLES[wildcards.angle],
        nodes=lambda wildcards: config["boundary"]["nodes_rigid" if ANGLES[wildcards.angle] else "nodes"],
        slenderness=config["boundary"]["slenderness"],
        frequency_ratio=config["boundary"]["frequency_ratio"],
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse at {wildcards.angle} degrees"
    script:
        "../scripts/overturning_part.py"


rule overturning:
    input:
        parts=expand(rules.overturning_part.output.part, angle=ANGLES, allow_missing=True),
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        boundaries=overturning_files("{pulse}", ETAS),
        record=record_of("overturning/{pulse}", OVERTURNING_PROVENANCE),
    log:
        "logs/overturning/{pulse}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}.tsv"
    priority: 3
    localrule: True
    resources:
        mem_mb=memory(400),
        runtime=30,
    params:
        pulse=lambda wildcards: wildcards.pulse,
        restitution=config["restitution"],
        provenance=OVERTURNING_PROVENANCE,
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse"
    script:
        "../scripts/overturning.py"


rule spectrum_tile:
    input:
        boundaries=rules.overturning.output.boundaries,
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        # the cells that are not interpolated depend on the code of the boundaries too
        part=temp(part_of("spectra/{pulse}-rows-{band}", {**SPECTRUM_PROVENANCE, "boundaries": OVERTURNING_PROVENANCE})),
    log:
        "logs/spectra/{pulse}-rows-{band}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}-rows-{band}.tsv"
    priority: 2
    resources:
        mem_mb=memory(TILE_MB),
        runtime=240,
    params:
        **SPECTRUM_SETTINGS,
        pulse=lambda wildcards: wildcards.pulse,
        band=lambda wildcards: BANDS[wildcards.band],
    message:
        "Spectrum cubes of the {wildcards.pulse} pulse, rows {wildcards.band}"
    script:
        "../scripts/spectrum_tile.py"


rule spectra:
    input:
        tiles=expand(rules.spectrum_tile.output.part, band=BANDS, allow_missing=True),
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        cubes=spectrum_files("{pulse}", ETAS),
        record=record_of("spectra/{pulse}", SPECTRUM_PROVENANCE),
    log:
        "logs/spectra/{pulse}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}.tsv"
    priority: 3
    resources:
        mem_mb=memory(CUBE_MB),
        runtime=120,
    params:
        pulse=lambda wildcards: wildcards.pulse,
        provenance=SPECTRUM_PROVENANCE,
    message:
        "Spectrum cubes of the {wildcards.pulse} pulse"
    script:
        "../scripts/spectra.py"


RECORDS += [
    *expand(rules.overturning.output.record, pulse=PULSES),
    *expand(rules.spectra.output.record, pulse=PULSES),
]
