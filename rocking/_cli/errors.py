"""Errors of Python as messages of the command line: one line that names the option, and an exit code."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from rocking._base.errors import InvalidArgumentError

MAX_ERRORS = 20  # lines of a file that an error names at most


@contextmanager
def reported_errors(options: Mapping[str, str] | None = None, source: str = "") -> Iterator[None]:
    """End the command with a message on stderr: exit code 2 for a wrong argument or file, 1 for a missing package.

    `options` are the options and arguments of the command that have other names than the arguments of Python. `source`
    is the argument with a file whose keys are the arguments of Python.
    """
    from rocking._base.errors import InvalidArgumentError, RecordFileError

    names = {"order": "--baseline-order", "path": "FILE", "file": "FILE", "format": "--file-format"}
    names |= dict(options or {})

    def spell(argument: str, value: Any) -> str:
        option = names.get(argument, "--" + argument.replace("_", "-"))
        if value is None or value is True:
            return option
        return f"{option} {'...' if value is ... else shlex.quote(str(value))}"

    try:
        yield
    except RecordFileError as error:
        message, code = f"Invalid value for FILE: {error.message(spell, '', ' ')}", 2
    except InvalidArgumentError as error:
        name = error.parameter.split("[")[0].split(",")[0]
        hint = source or names.get(name, "--" + name.replace("_", "-"))
        text = str(error).replace("`", "") if source else _texts(error)
        message, code = f"Invalid value for {hint}: {text}", 2
    except ImportError as error:
        message, code = str(error), 1
    else:
        return
    typer.echo(f"Error: {message}", err=True)
    raise typer.Exit(code)


def _texts(error: InvalidArgumentError) -> str:
    """Return the wrong values of an error, each in a line."""
    from rocking._base.errors import SeveralArgumentsError

    if not isinstance(error, SeveralArgumentsError):
        return _text(error)
    lines = [f"{len(error.errors)} values are not allowed", *map(_text, error.errors[:MAX_ERRORS])]
    if len(error.errors) > MAX_ERRORS:
        lines.append(f"and {len(error.errors) - MAX_ERRORS} more")
    return "\n".join(lines)


def _text(error: InvalidArgumentError) -> str:
    """Return a line about an argument; of a file, where in it."""
    from rocking._base.errors import UnreadableFileError

    text = f"{error.value!r} is not allowed; allowed: {error.allowed}"
    if error.value is None:
        text = f"missing; {error.allowed}"
    if error.allowed.startswith("missing unit"):
        text = f"{error.value!r}: {error.allowed}"
    if isinstance(error, UnreadableFileError):
        text = f"{error.value!r}: {error.reason}"
    row = error.parameter.partition(",")[2].strip()
    return f"{row}: {text}" if row else text
