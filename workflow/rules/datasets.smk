# Spectrum cubes and overturning boundaries: one job per pulse makes the files of all its coefficients of restitution,
# because starting Python and loading the compiled solver takes longer than filling a cube. These jobs have priority, as
# figures and claims depend on them.
ETAS = [f"{eta:.2f}" for eta in config["restitution"]]
ANGLES = {str(angle): angle for angle in config["grid"]["alpha_deg"]}
PULSES = config["pulses"]


wildcard_constraints:
    pulse="[a-z0-9_]+",
    angle="|".join(map(re.escape, ANGLES)),


SPECTRUM_SETTINGS = {"grid": config["grid"], "restitution": config["restitution"]}
SPECTRUM_PROVENANCE = provenance(
    "spectra",
    ["scripts/spectra.py"],
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


rule spectra:
    input:
        boundaries=overturning_files("{pulse}", ETAS),
    output:
        cubes=spectrum_files("{pulse}", ETAS),
        record=record_of("spectra/{pulse}"),
    log:
        "logs/spectra/{pulse}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}.tsv"
    priority: 2
    params:
        **SPECTRUM_SETTINGS,
        provenance=SPECTRUM_PROVENANCE,
        pulse=lambda wildcards: wildcards.pulse,
    message:
        "Spectrum cubes of the {wildcards.pulse} pulse"
    script:
        "../scripts/spectra.py"


# one job for each pulse and angle traces the curves of all restitutions, which share the grid
rule overturning_part:
    output:
        part=temp(part_of("overturning/{pulse}-{angle}", OVERTURNING_PROVENANCE)),
    log:
        "logs/overturning/{pulse}-{angle}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}-{angle}.tsv"
    priority: 3
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
    output:
        boundaries=overturning_files("{pulse}", ETAS),
        record=record_of("overturning/{pulse}"),
    log:
        "logs/overturning/{pulse}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}.tsv"
    priority: 3
    params:
        pulse=lambda wildcards: wildcards.pulse,
        restitution=config["restitution"],
        provenance=OVERTURNING_PROVENANCE,
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse"
    script:
        "../scripts/overturning.py"
