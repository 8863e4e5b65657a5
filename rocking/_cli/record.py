"""`rocking record`: one block under a recorded ground motion."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._base.quantities import MASS
from rocking._cli.options import OutputOptions, RecordOptions, option, said, with_options

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody
    from rocking._dimensional.response import BodyResponse
    from rocking._excitation.records.record import Record
    from rocking._model.block import AbstractBlock

File = Annotated[
    str,
    typer.Argument(
        help="Accelerogram: AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SAC, miniSEED, TSPAIR, SLIST, or columns whose "
        "layout is stated.",
        metavar="FILE",
    ),
]


@with_options
def record(
    file: File,
    block: RecordOptions,
    output: OutputOptions,
    thresholds: Annotated[
        bool, said("Find all factors at which the outcome changes.", "", "--thresholds/--no-thresholds")
    ] = True,
    fit: Annotated[bool, said("Fit a pulse and compare when both overturn the block.", "", "--fit")] = False,
    second: Annotated[
        str | None, said("Second horizontal component: the answer is for the worst direction.", "FILE|NAME")
    ] = None,
    mirrored: Annotated[bool, said("The record with the other sign.", "", "--mirrored")] = False,
    history: Annotated[bool, said("Print the motion against time instead.", "", "--history")] = False,
    samples: Annotated[
        int | None, said("Number of uniform samples of this motion; by default those of the record.", "NUMBER")
    ] = None,
    contact: Annotated[
        bool, said("Add reactions of the ground and friction demand to this motion.", "", "--contact")
    ] = False,
    mass: Annotated[str | None, option(MASS, text="Mass of the body, for these reactions in newtons")] = None,
) -> None:
    """Outcome and peak rotation of a block under a recorded ground motion, by the solver.

    With a second component the motion is turned in steps of 15 degrees towards it; the worst one has the lowest factor.
    """
    from rocking._base.errors import InvalidArgumentError, reject_given
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress
    from rocking._dimensional.curves import with_forces
    from rocking._excitation.records.record import summary_of
    from rocking._model.block import AbstractBlock

    with option_errors({"records": "--second", "format": "--file-format"}), file_errors():
        form = printing.output_format(output, block)
        motion, body, restitution = read_problem(file, block)
        if mirrored:
            motion = motion.mirrored()
        if history:
            reject_given("--history", second=second, fit=fit or None)
            options: dict[str, Any] = {"scale": block.scale, "restitution": restitution, "samples": samples}
            with progress("solving the motion"):
                moving = body.history(motion, **options, contact=contact or mass is not None)
            if mass is not None:
                moving = with_forces(moving, MASS.number(mass), float(body.gravity))
            printing.print_motion(moving, form)
            return
        reject_given("an answer without --history", samples=samples, contact=contact or None, mass=mass)
        if fit and not isinstance(body, AbstractBlock):
            raise InvalidArgumentError("fit", fit, "a block whose centre of mass is in its middle")
        with progress("solving the block under the record"):
            given: dict[str, Any] = {"scale": block.scale, "restitution": restitution, "thresholds": thresholds}
            direction: dict[str, float] = {}
            if second is None:
                found = body.response(motion, **given)
            else:
                apart = Path(second).is_file()
                other = replace(block, acceleration=block.acceleration if apart else second, vertical=None)
                pair = motion, read_problem(second if apart else file, other)[0]
                angle, motion, found = _worst_direction(body, pair, given)
                direction = {"direction_deg": angle}
            about = printing.body_columns(found)
            changes = about.pop("thresholds")
            if changes is None:
                about.pop("overturning_scale")
            else:
                about["threshold_scale"] = [one["scale"] for one in changes]
                about["overturns_above"] = [one["overturns_above"] for one in changes]
            measures = summary_of(motion)
            about |= {"scale": block.scale, "record": measures.pop("name"), **measures}
            if isinstance(body, AbstractBlock):
                about |= {"alpha": body.alpha} | (_fitted(motion, body) if fit else {})
        sentences = [text for text in (about["meaning"], about["margin"]) if text]
        about |= direction
    printing.print_answer(about, sentences, form)


def _worst_direction(
    body: RespondingBody, pair: tuple[Record, Record], given: dict[str, Any]
) -> tuple[float, Record, BodyResponse]:
    """The worst angle from the first towards the second component [degrees], the motion along it, the response."""
    from rocking._excitation.records.pair import PAIR_ANGLES, checked_pair, rotated

    checked_pair(pair)
    motions = [one for _, one in rotated(*pair)]
    if not body.moves_as_block:
        motions = [*motions, *[one.mirrored() for one in motions]]  # in the opposite directions
    found = [(180.0 * k / PAIR_ANGLES, one, body.response(one, **given)) for k, one in enumerate(motions)]

    def order(one: tuple[float, Record, BodyResponse]) -> tuple[float, bool, float]:
        known = one[2].overturning_scale if given["thresholds"] else None
        overturned = bool(one[2].overturned)
        return math.inf if known is None else known, not overturned, 0.0 if overturned else -float(one[2].rotation)

    return min(found, key=order)


@contextmanager
def file_errors() -> Iterator[None]:
    """Convert an error of a file into an error of the command line: file, line, what was found, what was expected."""
    from rocking._base.errors import RecordFileError, UnreadableFileError

    try:
        yield
    except RecordFileError as error:
        raise typer.BadParameter(error.message(_as_option, "", " "), param_hint="FILE") from None
    except UnreadableFileError as error:
        if error.parameter not in ("path", "file"):
            raise
        raise typer.BadParameter(f"{error.value}: {error.reason}", param_hint="FILE") from None


def _as_option(name: str, value: Any) -> str:
    """An argument of `read_record` as an option."""
    option = "--" + {"format": "file-format"}.get(name, name).replace("_", "-")
    if value is None or value is True:
        return option
    return f"{option} {'...' if value is ... else shlex.quote(str(value))}"


def read_problem(file: str, options: RecordOptions) -> tuple[Record, RespondingBody, float | str]:
    """The record in a file, the body, and its restitution."""
    from rocking._base.quantities import RESTITUTION
    from rocking._cli.arguments import read_body
    from rocking._excitation.records.readers.read_record import read_record

    body, eta = read_body(options), RESTITUTION.read(options.restitution)
    motion = read_record(file, vertical=options.vertical, **options.stated())
    return motion.baseline_corrected(order=options.baseline_order), body, eta


def _fitted(motion: Record, block: AbstractBlock) -> dict[str, Any]:
    """The printed values of the pulse fitted to a record, by name."""
    from rocking.suites.pulse_fit import fit_pulse, summary_of

    found = summary_of(fit_pulse(motion, blocks=block))
    named = {name if name in ("pulse", "period") else f"pulse_{name}": value for name, value in found.items()}
    return {name: value for name, value in named.items() if name != "pulse_centre"}
