"""`rocking record`: one block under a recorded ground motion."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._cli.options import MassOptions, OutputOptions, RecordOptions, with_options

if TYPE_CHECKING:
    from rocking._dimensional.block import Block
    from rocking._excitation.records.record import Record

File = Annotated[
    str,
    typer.Argument(
        help="Accelerogram: PEER AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SMC, or columns of times and accelerations.",
        metavar="FILE",
    ),
]
Thresholds = Annotated[
    bool,
    typer.Option(
        "--thresholds/--no-thresholds", help="Whether to find all scales at which the outcome changes.", metavar=""
    ),
]
Fit = Annotated[bool, typer.Option("--fit", help="Fit a pulse, and compare how both overturn the block.", metavar="")]


@with_options
def record(
    file: File,
    block: RecordOptions,
    mass: MassOptions,
    output: OutputOptions,
    thresholds: Thresholds = True,
    fit: Fit = False,
) -> None:
    """Outcome and peak rotation of a block under a recorded ground motion, by the solver."""
    from rocking._base.errors import InvalidArgumentError
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking._cli.progress import progress
    from rocking._dimensional.block import Block
    from rocking._dimensional.rigid_body import body_of_size

    with option_errors(), file_errors():
        form = printing.output_format(output, block)
        motion, shape, restitution = read_problem(file, block)
        body = body_of_size(shape.width, shape.height, mass.offset or 0.0, mass.mass_height)
        if fit and not isinstance(body, Block):
            raise InvalidArgumentError("fit", fit, "a block whose centre of mass is in its middle")
        with progress("solving the block under the record"):
            found = body.response(motion, scale=block.scale, restitution=restitution, thresholds=thresholds)
            about = printing.body_columns(found)
            changes = about.pop("thresholds")
            if changes is None:
                about.pop("overturning_scale")
            else:
                about["threshold_scale"] = [one["scale"] for one in changes]
                about["overturns_above"] = [one["overturns_above"] for one in changes]
            about |= {"scale": block.scale, **_measures(motion)}
            if isinstance(body, Block):
                about |= {"alpha": body.alpha} | (_fitted(motion, body) if fit else {})
        sentences = [text for text in (about["meaning"], about["margin"]) if text]
    printing.print_answer(about, sentences, form)


@contextmanager
def file_errors() -> Iterator[None]:
    """Convert an error of a file into an error of the command line: file, line, what was found, what was expected."""
    from rocking._base.errors import InvalidArgumentError, RecordFileError

    try:
        yield
    except RecordFileError as error:
        raise typer.BadParameter(with_options_named(str(error)), param_hint="FILE") from None
    except InvalidArgumentError as error:
        if error.parameter != "path":
            raise
        raise typer.BadParameter(f"{error.value}: not {error.allowed}", param_hint="FILE") from None


def with_options_named(message: str) -> str:
    """A message in which arguments of functions have the names of the options."""
    return re.sub(
        r"(?:(?:the )?argument )?`(unit|time_step|component|vertical|skip)`",
        lambda found: "--" + found[1].replace("_", "-"),
        message,
    )


def read_problem(file: str, options: RecordOptions) -> tuple[Record, Block, float | str]:
    """The record in a file, the block, and its restitution.

    Raises
    ------
    InvalidArgumentError
        If an option is missing, or a value is not allowed.
    RecordFileError
        If the file does not hold a record.
    """
    from rocking._cli.arguments import read_block, read_eta
    from rocking._excitation.records.readers.read_record import read_record

    block = read_block(options)
    from rocking._base.quantities import RESTITUTION

    named = options.restitution.partition("(")[0] in RESTITUTION.words
    eta: float | str = options.restitution if named else read_eta(options.restitution, "a number, or momentum")
    motion = read_record(
        file,
        unit=options.unit,
        time_step=options.time_step,
        component=options.component,
        vertical=options.vertical,
        skip=options.skip,
    )
    if options.baseline_order is not None:
        motion = motion.baseline_corrected(order=options.baseline_order)
    return motion, block, eta


def _measures(motion: Record) -> dict[str, Any]:
    """What is printed of a record, by name."""
    from rocking._base.errors import finite

    return {
        "record": motion.name,
        "source": motion.source,
        "samples": motion.samples,
        "time_step": motion.time_step,
        "peak_acceleration": motion.peak_acceleration,
        "peak_vertical_acceleration": None if motion.vertical is None else motion.peak_vertical_acceleration,
        "peak_velocity": motion.peak_velocity,
        "peak_displacement": motion.peak_displacement,
        "arias_intensity": motion.arias_intensity,
        "significant_duration": motion.significant_duration,
        "mean_period": finite(motion.mean_period),
        "final_velocity": motion.final_velocity,
    }


def _fitted(motion: Record, block: Block) -> dict[str, Any]:
    """What is printed of the pulse that is fitted to a record, by name."""
    from rocking._base.errors import finite
    from rocking.suites.pulse_fit import fit_pulse

    fitted = fit_pulse(motion, blocks=block)
    return {
        "pulse": fitted.velocity.family,
        "period": fitted.period,
        "pulse_peak_acceleration": fitted.peak_acceleration,
        "pulse_cycles": finite(fitted.velocity.cycles),
        "pulse_phase": finite(fitted.velocity.phase),
        "pulse_explained": fitted.explained,
        "pulse_scale_ratio": finite(float(fitted.scale_ratio[0])),
    }
