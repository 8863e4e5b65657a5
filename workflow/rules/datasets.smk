# Each pulse and restitution: the overturning boundaries, the solved nodes (a part, which is kept), and the cube, completed
# from the parts of its neighbours with the errors up to the next restitution. Another restitution so repeats only what
# depends on it. These jobs have priority, as figures and claims depend on them.
ETAS = {f"{eta:.2f}": eta for eta in config["restitution"]}
ENTRIES = [(configured_pulse(entry, CONFIG_FOLDER), entry) for entry in config["pulses"]]
PULSES = list(different(pulse for pulse, _ in ENTRIES))
# of the pulses given by samples: the file of the samples, which names their digest, and the entry of the configuration
SAMPLES = {pulse.name: samples_file(pulse) for pulse, _ in ENTRIES if not isinstance(pulse, str)}
SAMPLED = {pulse.name: entry for pulse, entry in ENTRIES if not isinstance(pulse, str)}


wildcard_constraints:
    pulse=r"[a-z0-9_]+(\([^/()]+\))?",
    eta="|".join(map(re.escape, ETAS)),
    samples="[0-9a-f]{16}",


CUBE_MB = 300 + BYTES * nodes_of_cube(config) / 1e6
OVERTURNING_SETTINGS = {**config["boundary"], "alpha_deg": config["grid"]["alpha_deg"]}
OVERTURNING_PROVENANCE = provenance(
    "overturning",
    ["scripts/overturning.py"],
    OVERTURNING_SETTINGS,
    [path for pulse in PULSES for path in overturning_files(pulse, ETAS)],
)
WINDOWS = {eta: window_of(eta, ETAS) for eta in ETAS}
PART_PROVENANCE = provenance("spectrum_part", ["scripts/spectrum_part.py"], config["grid"], [])
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
PART_CODE = PART_PROVENANCE | {"boundaries": OVERTURNING_PROVENANCE}
CUBE_CODE = PART_CODE | {"cubes": SOURCES.digest(PROJECT / "workflow/scripts/spectra.py")}


for pulse, _ in ENTRIES:
    if not isinstance(pulse, str):
        for path in (*spectrum_files(pulse.name, ETAS), *overturning_files(pulse.name, ETAS)):
            PRODUCTS[path]["pulse_sha256"] = pulse.digest


rule samples:
    output:
        samples=f"{records.PARTS}/pulses/{{pulse}}.{{samples}}.json",
    log:
        "logs/pulses/{pulse}.{samples}.log",
    localrule: True
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(300),
        runtime=10,
    params:
        pulse=lambda wildcards: SAMPLED[wildcards.pulse],
        folder=os.path.relpath(CONFIG_FOLDER),  # the checkout may be moved
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
    priority: 3
    conda:
        "../envs/rocking.yaml"
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
        boundaries=rules.overturning.output.boundaries,
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        part=part_files("{pulse}", ["{eta}"])[0],
        record=record_of("parts/{pulse}-{eta}", PART_CODE),
    log:
        "logs/parts/{pulse}-{eta}.log",
    priority: 2
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(CUBE_MB),
        runtime=240,
    params:
        grid=config["grid"],
        restitution=lambda wildcards: ETAS[wildcards.eta],
        pulse=lambda wildcards: wildcards.pulse,
    message:
        "Solving the spectrum cube of the {wildcards.pulse} pulse at restitution {wildcards.eta}"
    script:
        "../scripts/spectrum_part.py"


rule spectra:
    input:
        parts=lambda wildcards: part_files(wildcards.pulse, WINDOWS[wildcards.eta]),
        samples=lambda wildcards: SAMPLES.get(wildcards.pulse, []),
    output:
        cube=spectrum_files("{pulse}", ["{eta}"])[0],
        record=record_of("spectra/{pulse}-{eta}", CUBE_CODE),
    log:
        "logs/spectra/{pulse}-{eta}.log",
    priority: 3
    conda:
        "../envs/rocking.yaml"
    resources:
        mem_mb=memory(CUBE_MB),
        runtime=120,
    params:
        pulse=lambda wildcards: wildcards.pulse,
        restitution=lambda wildcards: ETAS[wildcards.eta],
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
