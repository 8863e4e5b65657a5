"""The pulses of a configuration: of the catalogue, by name and parameters, or by samples under names of their own.

The samples of a pulse are an input of the jobs that depend on them, a file whose name contains their digest: other
samples of the same name make the products of this pulse again, and no others.
"""

import json
import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.pulses import PULSE_NAMES, pulse
from rocking._excitation.sampled import SampledPulse
from workflow.records import PARTS

KEYS = ("name", "acceleration", "time", "period", "file")
"""Keys of a pulse given by samples: arguments of `rocking.SampledPulse`, or a file for acceleration and time."""

NAME = re.compile(r"[a-z0-9_]{1,40}")  # names of pulses, which name folders


def configured_pulse(entry: Any, folder: Path) -> str | SampledPulse:
    """A pulse of a configuration: a name of the catalogue, or samples, in files relative to `folder`."""
    if not isinstance(entry, Mapping):
        made = pulse(entry)
        if made.name.partition("(")[0] not in PULSE_NAMES:
            raise InvalidArgumentError("pulse", entry, f"one of {', '.join(PULSE_NAMES)}, or samples with a name")
        return made.name
    given = dict(entry)
    for key in given:
        if key not in KEYS:
            raise InvalidArgumentError("key", key, f"one of {', '.join(KEYS)}")
    name = given.get("name")
    if not (isinstance(name, str) and NAME.fullmatch(name)) or name in PULSE_NAMES:
        raise InvalidArgumentError("name", name, "a-z, 0-9 and _, at most 40, that is no name of the catalogue")
    file = given.pop("file", None)
    if (file is None) == ("acceleration" not in given):
        raise InvalidArgumentError("file", file, "either a file or the key acceleration")
    if file is None:
        return SampledPulse(**given)
    if "time" in given or not isinstance(file, str):
        raise InvalidArgumentError("file", file, "a path, without the key time")
    stored = SampledPulse.from_file(folder / file, given.get("period"))
    return SampledPulse(stored.values, stored.phases, 2.0 * math.pi, name)


def different(pulses: Iterable[str | SampledPulse]) -> dict[str, str | SampledPulse]:
    """The pulses by their names, which have to differ."""
    found: dict[str, str | SampledPulse] = {}
    for one in pulses:
        name = one if isinstance(one, str) else one.name
        if name in found:
            raise InvalidArgumentError("name", name, "different names of pulses")
        found[name] = one
    return found


def samples_file(sampled: SampledPulse) -> str:
    """Path of the file with the samples of a pulse, in the folder of a run."""
    return f"{PARTS}/pulses/{sampled.name}.{sampled.digest[:16]}.json"


def write_samples(sampled: SampledPulse, path: Path) -> None:
    """Write a file from which `rocking.SampledPulse.from_file` makes the same pulse again, to the last digit."""
    given = {"name": sampled.name, "acceleration": sampled.values.tolist(), "time": sampled.phases.tolist()}
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(given | {"period": 2.0 * math.pi}), encoding="utf-8")
    partial.replace(path)


def pulse_of_job(name: str, samples: Path | list[Path]) -> str | SampledPulse:
    """The pulse of a job: its name, or the pulse of the file of samples if there is one."""
    return SampledPulse.from_file(samples) if isinstance(samples, Path) else name
