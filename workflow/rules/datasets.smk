# Overturning boundaries, traced by pulse and restitution, then spectrum cubes: solved by pulse and tenth of the restitution,
# whose blocks share the starts of their motions, and completed by pulse and restitution with the errors up to the next one.
# Another restitution so repeats what depends on it. These jobs have priority, as figures and claims depend on them.
ETAS = {f"{eta:.2f}": eta for eta in config["restitution"]}
TENTHS = tenths(config)
ENTRIES = [(configured_pulse(entry, CONFIG_FOLDER), entry) for entry in config["pulses"]]
PULSES = list(different(pulse for pulse, _ in ENTRIES))
# of the pulses given by samples: the file of the samples, which names their digest, and the entry of the configuration
SAMPLES = {pulse.name: samples_file(pulse) for pulse, _ in ENTRIES if not isinstance(pulse, str)}
SAMPLED = {pulse.name: entry for pulse, entry in ENTRIES if not isinstance(pulse, str)}


wildcard_constraints:
    pulse=r"[a-z0-9_]+(\([^/()]+\))?",
    eta="|".join(map(re.escape, ETAS)),
    tenth="|".join(TENTHS),
    digest="[0-9a-f]{16}",
    samples="[0-9a-f]{16}",


PART_MB, CUBE_MB = (300 + BYTES * nodes / 1e6 for nodes in (nodes_of_part(config), nodes_of_cube(config)))
OVERTURNING_SETTINGS = {**config["boundary"], "alpha_deg": config["grid"]["alpha_deg"]}
OVERTURNING_PROVENANCE = provenance(
    "overturning",
    ["scripts/overturning.py"],
    OVERTURNING_SETTINGS,
    [path for pulse in PULSES for path in overturning_files(pulse, ETAS)],
)
WINDOWS = {eta: window_of(eta, ETAS) for eta in ETAS}
SPECTRUM_PROVENANCE = {
    eta: provenance(
        "spectra",
        ["scripts/spectra.py", "scripts/spectrum_part.py"],
        {"grid": config["grid"], "restitution": window},
        [path for pulse in PULSES for path in spectrum_files(pulse, [eta])],
    )
    for eta, window in WINDOWS.items()
}
# the cells that are not interpolated depend on the code of the boundaries too
CUBE_CODE = {
    "cubes": [one["code_sha256"] for one in SPECTRUM_PROVENANCE.values()][0],
    "boundaries": OVERTURNING_PROVENANCE,
    "grid": config["grid"],
}


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


rule overturning:
    input:
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        boundaries=overturning_files("{pulse}", ["{eta}"])[0],
        record=record_of("overturning/{pulse}-{eta}", OVERTURNING_PROVENANCE),
    log:
        "logs/overturning/{pulse}-{eta}.log",
    benchmark:
        "logs/benchmarks/overturning-{pulse}-{eta}.tsv"
    priority: 3
    resources:
        mem_mb=memory(400),
        runtime=240,
    params:
        **OVERTURNING_SETTINGS,
        pulse=lambda wildcards: wildcards.pulse,
        restitution=lambda wildcards: ETAS[wildcards.eta],
        provenance=OVERTURNING_PROVENANCE,
    message:
        "Overturning boundaries of the {wildcards.pulse} pulse at restitution {wildcards.eta}"
    script:
        "../scripts/overturning.py"


rule spectrum_part:
    input:
        boundaries=lambda wildcards: overturning_files(wildcards.pulse, TENTHS[wildcards.tenth]),
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        part=temp(f"{parts.FOLDER}/spectra/{{pulse}}-{{tenth}}.{{digest}}.nc"),
    log:
        "logs/spectra/{pulse}-{tenth}.{digest}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}-{tenth}.{digest}.tsv"
    priority: 2
    resources:
        mem_mb=memory(PART_MB),
        runtime=240,
    params:
        grid=config["grid"],
        restitution=lambda wildcards: TENTHS[wildcards.tenth],
        pulse=lambda wildcards: wildcards.pulse,
    message:
        "Solving the spectrum cubes of the {wildcards.pulse} pulse at restitutions from {wildcards.tenth} on"
    script:
        "../scripts/spectrum_part.py"


rule spectra:
    input:
        parts=lambda wildcards: parts_of(WINDOWS[wildcards.eta], TENTHS, CUBE_CODE),
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        cube=spectrum_files("{pulse}", ["{eta}"])[0],
        record=record_of("spectra/{pulse}-{eta}", CUBE_CODE),
    log:
        "logs/spectra/{pulse}-{eta}.log",
    benchmark:
        "logs/benchmarks/spectra-{pulse}-{eta}.tsv"
    priority: 3
    resources:
        mem_mb=memory(CUBE_MB),
        runtime=120,
    params:
        pulse=lambda wildcards: wildcards.pulse,
        restitution=lambda wildcards: ETAS[wildcards.eta],
        window=lambda wildcards: WINDOWS[wildcards.eta],
        provenance=lambda wildcards: SPECTRUM_PROVENANCE[wildcards.eta],
    message:
        "Spectrum cube of the {wildcards.pulse} pulse at restitution {wildcards.eta}"
    script:
        "../scripts/spectra.py"


RECORDS += expand(
    [rules.overturning.output.record, rules.spectra.output.record],
    pulse=PULSES,
    eta=ETAS,
)
