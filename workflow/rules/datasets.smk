# Spectrum cubes and overturning boundaries: one job per pulse makes the files of all its coefficients of restitution,
# because starting Python and loading the compiled solver takes longer than filling a cube. These jobs have priority, as
# figures and claims depend on them.
ETAS = [f"{eta:.2f}" for eta in config["restitution"]]
PULSES = config["pulses"]


wildcard_constraints:
    pulse="[a-z0-9_]+",
    eta=r"[01]\.[0-9]{2}",


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


rule overturning:
    output:
        boundaries=overturning_files("{pulse}", ETAS),
        record=record_of("overturning/{pulse}"),
    log:
        "logs/overturning/{pulse}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}.tsv"
    priority: 2
    params:
        **OVERTURNING_SETTINGS,
        provenance=OVERTURNING_PROVENANCE,
        pulse=lambda wildcards: wildcards.pulse,
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse"
    script:
        "../scripts/overturning.py"
