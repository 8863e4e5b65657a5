"""Pulses and bodies of the options."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rocking._base.errors import InvalidArgumentError, UnreadableFileError, reject_given
from rocking._excitation.pulses import AbstractPulse, as_pulse, pulse_names

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody


def read_pulse(text: str) -> AbstractPulse:
    """Return the pulse of a name with its parameters, or read it from a file; a leading minus mirrors it."""
    name = text.removeprefix("-")
    if name.partition("(")[0].strip() in pulse_names():
        return as_pulse(text)
    from rocking._excitation.sampled import SampledPulse

    try:
        pulse = SampledPulse.from_file(name)
    except InvalidArgumentError as error:
        if error.parameter != "path":
            raise
        if isinstance(error, UnreadableFileError) and re.search(r"[./\\]", name):
            raise UnreadableFileError("pulse", text, error.reason) from None
        allowed = f"one of {', '.join(pulse_names())}, or {error.allowed}"
        raise InvalidArgumentError("pulse", text, allowed) from None
    return pulse.mirrored() if text.startswith("-") else pulse


def read_body(width: str | None, height: str | None, description: str | None) -> RespondingBody:
    """Return the block of a width and a height, or the body that a text describes."""
    if description is not None:
        reject_given("--body", width=width, height=height)
        from rocking._dimensional.body_kinds import body

        return body(description)
    if width is None:
        raise InvalidArgumentError("width", None, "required, or a body of another kind by --body")
    if height is None:
        raise InvalidArgumentError("height", None, "required, or a body of another kind by --body")
    from rocking._dimensional.block import Block

    return Block(width, height)
