"""The pulses of a configuration: of the catalogue, by name and parameters, or by samples under names of their own."""

import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.pulses import PULSE_NAMES, pulse
from rocking._excitation.sampled import SampledPulse

KEYS = ("name", "acceleration", "time", "period", "file")
"""Keys of a pulse given by samples: arguments of `rocking.SampledPulse`, or a file for acceleration and time."""

NAME = re.compile(r"[a-z0-9_]{1,40}")  # names of pulses, which name folders


def configured_pulse(entry: Any, folder: Path = Path()) -> str | SampledPulse:
    """A pulse of a configuration: a name of the catalogue, or samples, in files relative to `folder`."""
    if not isinstance(entry, Mapping):
        made = pulse(entry)
        if made.name.partition("(")[0] not in PULSE_NAMES:
            raise InvalidArgumentError("pulse", entry, f"one of {', '.join(PULSE_NAMES)}, or samples with a name")
        return made.name
    arguments = dict(entry)
    for key in arguments:
        if key not in KEYS:
            raise InvalidArgumentError("key", key, f"one of {', '.join(KEYS)}")
    name = arguments.get("name")
    if not (isinstance(name, str) and NAME.fullmatch(name)) or name in PULSE_NAMES:
        raise InvalidArgumentError("name", name, "a-z, 0-9 and _, at most 40, that is no name of the catalogue")
    file = arguments.pop("file", None)
    if (file is None) == ("acceleration" not in arguments):
        raise InvalidArgumentError("file", file, "either a file or the key acceleration")
    if file is None:
        return SampledPulse(**arguments)
    if "time" in arguments or not isinstance(file, str):
        raise InvalidArgumentError("file", file, "a path, without the key time")
    stored = SampledPulse.from_file(folder / file, arguments.get("period"))
    return SampledPulse(stored.values, stored.phases, 2.0 * math.pi, name)


def relative_entry(entry: Mapping[str, Any], folder: str) -> dict[str, Any]:
    """The entry of a pulse given by samples, with the path of its file relative to that of which `folder` is a part."""
    if "file" not in entry:
        return dict(entry)
    return {**entry, "file": f"{folder}/{entry['file']}"}


def different(pulses: Iterable[str | SampledPulse]) -> dict[str, str | SampledPulse]:
    """The pulses by their names, which have to differ."""
    by_name: dict[str, str | SampledPulse] = {}
    for shape in pulses:
        name = shape if isinstance(shape, str) else shape.name
        if name in by_name:
            raise InvalidArgumentError("name", name, "different names of pulses")
        by_name[name] = shape
    return by_name
