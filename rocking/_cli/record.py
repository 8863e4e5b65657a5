"""`rocking record`: one body under a recorded ground motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._base.quantities import MASS
from rocking._cli.errors import reported_errors
from rocking._cli.parameters import (
    LAYOUT,
    MOTION,
    Acceleration,
    BaselineOrder,
    Body,
    Decimal,
    Delimiter,
    FileFormat,
    Height,
    OutputFormat,
    RecordFile,
    Restitution,
    Scale,
    Skip,
    Time,
    TimeStep,
    TimeUnit,
    Unit,
    Width,
    Wrapped,
)

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody
    from rocking._dimensional.response import BodyResponse
    from rocking._excitation.records.record import Record
    from rocking._model.block import AbstractBlock

HISTORY = "Motion against time"


def record(
    file: RecordFile,
    vertical: Annotated[
        str | None,
        typer.Option(
            help="File of the vertical component, upwards, or its column or channel in the file.",
            metavar="[FILE|NAME]",
            rich_help_panel=MOTION,
        ),
    ] = None,
    second: Annotated[
        str | None,
        typer.Option(
            help="Second horizontal component: the answer is for the worst direction.",
            metavar="[FILE|NAME]",
            rich_help_panel=MOTION,
        ),
    ] = None,
    scale: Scale = 1.0,
    mirrored: Annotated[
        bool, typer.Option("--mirrored", help="The record with the other sign.", rich_help_panel=MOTION)
    ] = False,
    baseline_order: BaselineOrder = None,
    width: Width = None,
    height: Height = None,
    body: Body = None,
    restitution: Restitution = "momentum",
    file_format: FileFormat = None,
    acceleration: Acceleration = None,
    time: Time = None,
    time_step: TimeStep = None,
    time_unit: TimeUnit = None,
    unit: Unit = None,
    skip: Skip = 0,
    delimiter: Delimiter = None,
    decimal: Decimal = ".",
    wrapped: Wrapped = False,
    allow_unusual: Annotated[
        bool,
        typer.Option(
            "--allow-unusual",
            help="Accept a PGA above 5 g, a PGV above 10 m/s, a step above 0.1 s.",
            rich_help_panel=LAYOUT,
        ),
    ] = False,
    thresholds: Annotated[bool, typer.Option(help="Find all factors at which the outcome changes.")] = True,
    fit: Annotated[bool, typer.Option("--fit", help="Fit a pulse and compare when both overturn the block.")] = False,
    history: Annotated[
        bool, typer.Option("--history", help="Print the motion against time instead.", rich_help_panel=HISTORY)
    ] = False,
    samples: Annotated[
        int | None,
        typer.Option(
            help="Number of uniform samples; by default those of the record.",
            metavar="[NUMBER]",
            rich_help_panel=HISTORY,
        ),
    ] = None,
    contact: Annotated[
        bool,
        typer.Option("--contact", help="Add reactions of the ground and friction demand.", rich_help_panel=HISTORY),
    ] = False,
    mass: Annotated[
        str | None,
        typer.Option(
            help="Mass of the body, such as 45kg, for these reactions in newtons.",
            metavar="[kg]",
            rich_help_panel=HISTORY,
        ),
    ] = None,
    output_format: OutputFormat = "table",
) -> None:
    """Outcome and peak rotation of a body under a recorded ground motion.

    With a second component the motion is turned in steps of 15 degrees towards it; the worst one has the lowest factor.
    """
    from rocking._base.errors import InvalidArgumentError, reject_given
    from rocking._base.quantities import RESTITUTION
    from rocking._cli.arguments import read_body
    from rocking._cli.printing import print_dataset, print_response, progress, response_values
    from rocking._dimensional.curves import with_forces
    from rocking._excitation.records.readers.read_record import read_record
    from rocking._excitation.records.record import summary_of
    from rocking._model.block import AbstractBlock

    with reported_errors({"records": "--second"}):
        rigid_body, eta = read_body(width, height, body), RESTITUTION.read(restitution)
        layout: dict[str, Any] = {
            "format": file_format,
            "time": time,
            "time_step": time_step,
            "time_unit": time_unit,
            "unit": unit,
            "skip": skip,
            "delimiter": delimiter,
            "decimal": decimal,
            "wrapped": wrapped,
            "allow_unusual": allow_unusual,
        }
        motion = read_record(file, acceleration=acceleration, vertical=vertical, **layout)
        motion = motion.baseline_corrected(order=baseline_order)
        if mirrored:
            motion = motion.mirrored()
        if history:
            reject_given("--history", second=second, fit=fit or None)
            with progress("solving the motion"):
                moving = rigid_body.history(
                    motion, scale=scale, restitution=eta, samples=samples, contact=contact or mass is not None
                )
            if mass is not None:
                moving = with_forces(moving, MASS.number(mass), float(rigid_body.gravity))
            print_dataset(moving, "time", output_format)
            return
        reject_given("an answer without --history", samples=samples, contact=contact or None, mass=mass)
        if fit and not isinstance(rigid_body, AbstractBlock):
            raise InvalidArgumentError("fit", fit, "a block whose centre of mass is in its middle")
        direction: dict[str, float] = {}
        with progress("solving the body under the record"):
            if second is None:
                solved = rigid_body.response(
                    motion, scale=scale, restitution=eta, error_bound=True, thresholds=thresholds
                )
            else:
                if Path(second).is_file():
                    other = read_record(second, acceleration=acceleration, **layout)
                else:
                    other = read_record(file, acceleration=second, **layout)
                pair = motion, other.baseline_corrected(order=baseline_order)
                worst = _worst_direction(rigid_body, pair, scale, eta, thresholds)
                direction, motion, solved = {"direction_deg": worst.angle}, worst.motion, worst.response
            values = response_values(solved) | direction | summary_of(motion)
            values.pop("name")  # that of `record`
            if fit and isinstance(rigid_body, AbstractBlock):
                values |= _fitted(motion, rigid_body)
    print_response(solved, values, output_format)


@dataclass(frozen=True)
class Direction:
    """A direction of the motion, and the response of the body in it."""

    angle: float  # from the first towards the second component [degrees]
    motion: Record
    response: BodyResponse

    @property
    def order(self) -> tuple[float, bool, float]:
        """Rank among other directions, the lowest is the worst: lowest factor, outcome, rotation."""
        factor = self.response.overturning_scale
        overturned = bool(self.response.overturned)
        rotation = 0.0 if overturned else float(self.response.rotation)
        return math.inf if factor is None else factor, not overturned, -rotation


def _worst_direction(
    body: RespondingBody, pair: tuple[Record, Record], scale: float, restitution: float | str, thresholds: bool
) -> Direction:
    """Search the direction in which a body overturns at the lowest factor, or with the largest rotation."""
    from rocking._excitation.records.pair import PAIR_ANGLES, checked_pair, rotated

    checked_pair(pair)
    motions = [motion for _, motion in rotated(*pair)]
    if not body.moves_as_block:
        motions += [motion.mirrored() for motion in motions]  # in the opposite directions
    directions = []
    for k, motion in enumerate(motions):
        solved = body.response(motion, scale=scale, restitution=restitution, error_bound=True, thresholds=thresholds)
        directions.append(Direction(180.0 * k / PAIR_ANGLES, motion, solved))
    return min(directions, key=lambda direction: direction.order)


def _fitted(motion: Record, block: AbstractBlock) -> dict[str, Any]:
    """Return the printed values of the pulse fitted to a record, by name."""
    from rocking.suites.pulse_fit import fit_pulse, summary_of

    values = summary_of(fit_pulse(motion, blocks=block))
    values.pop("centre")
    return {name if name == "pulse" else f"pulse_{name}": value for name, value in values.items()}
