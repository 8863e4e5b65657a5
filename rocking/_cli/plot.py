"""`rocking plot`: pictures of what the other commands print, in a file or a window.

This module holds the signatures and puts the pictures together; `rocking.plot` draws them.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking._cli.fragility import Configuration
from rocking._cli.options import (
    Duration,
    PictureOptions,
    ProblemOptions,
    RecordOptions,
    SpectrumOptions,
    WindowOptions,
    said,
    with_options,
)
from rocking._cli.progress import progress
from rocking._cli.record import File, file_errors, read_problem

if TYPE_CHECKING:
    import xarray as xr

    from rocking._cli.arguments import Params

plot = typer.Typer(no_args_is_help=True, help="Draw a picture: png, svg, or a window.")

SIZE = (5.2, 3.4)  # width and height of a picture [in]
POINTS = 600  # points of a spectrum, columns of a map
ROWS = 300  # rows of a map
AMPLITUDE = (1.0, 12.0)  # amplitudes a of a map [-]


Panels = Callable[[Any, Any], Any]  # draws with the functions of `rocking.plot` into a figure


def picture(name: str | None = None) -> Callable[[Callable[..., Panels]], None]:
    """A decorator that makes a command with the option of a file from a function that reads options and gives panels.

    Errors name the option. The figure is made, drawn, and saved or shown.
    """

    def add(read: Callable[..., Panels]) -> None:
        @functools.wraps(read)
        def command(picture: PictureOptions, **given: Any) -> None:
            from rocking._cli.arguments import option_errors

            with option_errors():
                _draw(read(**given), picture.output)

        signature = inspect.signature(read)
        own = inspect.Parameter("picture", inspect.Parameter.KEYWORD_ONLY)
        vars(command)["__signature__"] = signature.replace(parameters=[*signature.parameters.values(), own])
        command.__annotations__ = read.__annotations__ | {"picture": PictureOptions}
        plot.command(name)(with_options(command))

    return add


def _draw(panels: Panels, path: str | None) -> None:
    try:
        import rocking.plot as pictures
        from rocking.plot import output
    except ModuleNotFoundError as error:
        typer.echo(f"rocking plot: {error}", err=True)
        raise typer.Exit(1) from error
    with output.style():
        with progress("drawing"):
            figure = output.new_figure(path, SIZE)
            panels(pictures, figure)
            if path is not None:
                output.save_figure(figure, path)
        if path is None:
            output.show_figure(figure)


@picture()
def response(block: ProblemOptions) -> Panels:
    """Peak rotation against the amplitude of the pulse, with the block in question marked."""
    from rocking._cli import arguments

    params = arguments.read_params(block)
    return lambda pictures, figure: pictures.response(_found(params), figure.add_subplot())


@picture()
def history(block: ProblemOptions, duration: Duration = None) -> Panels:
    """Rotation and ground acceleration of one block against time."""
    from rocking._cli import arguments

    params = arguments.read_params(block)
    length = arguments.read_duration(duration, params)

    def panels(pictures: Any, figure: Any) -> None:
        from rocking._dimensional.curves import history as history_of
        from rocking._history.time_history import time_history

        problem = params.problem
        if problem is not None:
            data = history_of(problem, duration=length)
        else:
            data = time_history(params.pulse, **params.groups, duration=length)
        _draw_history(pictures, figure, data)

    return panels


@picture()
def record(
    file: File,
    block: RecordOptions,
    duration: Annotated[
        str | None, said("Length of time that is drawn, such as 20s; by default the record and some more.", "s")
    ] = None,
) -> Panels:
    """Rotation of one block under a recorded ground motion, and its acceleration, against time."""
    with file_errors():
        motion, shape, restitution = read_problem(file, block)

    def panels(pictures: Any, figure: Any) -> None:
        data = shape.history(motion, scale=block.scale, restitution=restitution, duration=duration)
        _draw_history(pictures, figure, data)
        for warning in shape.response(motion, scale=block.scale, restitution=restitution).warnings:
            typer.echo(f"warning: {warning}", err=True)

    return panels


@picture()
def spectrum(block: SpectrumOptions) -> Panels:
    """Peak rotation against the frequency ratio, or against the period."""
    from rocking._cli import arguments

    params, window = arguments.read_spectrum(block, (0.5, 12.0))

    def panel(pictures: Any, figure: Any) -> None:
        ax = pictures.spectrum(_spectrum(params, window), figure.add_subplot(), label="survives")
        ax.legend(frameon=True, framealpha=1.0)

    return panel


@picture()
def boundary(block: WindowOptions) -> Panels:
    """Boundaries of overturning: amplitude against the frequency ratio, or against the period."""
    from rocking._cli import arguments, printing

    given = arguments.read_boundary(block, (0.2, 15.0))
    return lambda pictures, figure: pictures.boundary(printing.boundary_curves(*given), figure.add_subplot())


@picture("map")
def control_map(block: WindowOptions) -> Panels:
    """Peak rotation and outcome over amplitude and frequency ratio, or over peak acceleration and period."""
    from rocking._cli import arguments

    given = arguments.read_boundary(block, (0.5, 12.0))
    return lambda pictures, figure: pictures.control_map(_map(*given), figure.add_subplot())


@picture()
def cube(
    file: Annotated[
        str, typer.Argument(help="Spectrum cube, such as results/spectra/sine/eta-0.85.nc.", metavar="FILE")
    ],
) -> Panels:
    """Maps of a spectrum cube, one for each slenderness angle."""
    from rocking._base.errors import DatasetError

    def panels(pictures: Any, figure: Any) -> None:
        from rocking._datasets.cube import read_dataset

        try:
            data = read_dataset(file)
        except (DatasetError, OSError) as error:
            raise typer.BadParameter(str(error), param_hint="FILE") from None
        angles = data.sizes.get("alpha", 1)
        columns = min(angles, 4)
        rows = -(-angles // columns)
        figure.set_size_inches(1.4 + 2.4 * columns, 0.6 + 2.5 * rows)
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel().tolist()
        for ax in axes[angles:]:
            ax.set_axis_off()
        pictures.cube(data, axes[:angles])

    return panels


@picture()
def distribution(configuration: Configuration) -> Panels:
    """Distributions of the peak rotation under a suite of records at five of its levels, one panel for each block."""
    from rocking._cli.fragility import read_suite, suite_fragility

    data = suite_fragility(read_suite(configuration))

    def panels(pictures: Any, figure: Any) -> None:
        from rocking.plot.style import label_of, shades
        from rocking.suites.distribution import distribution as distribution_of
        from rocking.suites.table import with_block

        found = distribution_of(with_block(data))
        levels = sorted({round(k * (found.sizes["intensity"] - 1) / 4) for k in range(5)})
        axes = figure.subplots(1, found.sizes["block"], sharex=True, sharey=True, squeeze=False)[0]
        figure.set_size_inches(0.6 + 2.8 * len(axes), 3.2)
        for block, ax in enumerate(axes):
            one = found.isel(block=block)
            for level, colour in zip(levels, shades(len(levels)), strict=True):
                at = one.isel(intensity=level)
                pictures.distribution(at, ax, color=colour, label=f"{at['intensity'].item():.3g}")
            ax.set_title(f"{float(one['width']):g} m x {float(one['height']):g} m", loc="right")
            ax.label_outer()
        of = f"{100.0 * found.attrs['confidence']:g} %"
        shaded = f"shaded: {of} interval at each rotation\nlighter: {of} band; grey line: the share that survives"
        title = f"{label_of(found['intensity'])}\n{shaded}"
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=5, title=title)

    return panels


@picture()
def fragility(configuration: Configuration) -> Panels:
    """Fragility curves of the first limit state of a suite of records, one panel for each block."""
    from rocking._cli.fragility import read_suite, suite_fragility

    first = suite_fragility(read_suite(configuration)).isel(demand=0)

    def panels(pictures: Any, figure: Any) -> None:
        blocks = first.sizes["block"]
        figure.set_size_inches(0.6 + 2.8 * blocks, 3.2)
        axes = figure.subplots(1, blocks, sharex=True, sharey=True, squeeze=False)[0]
        for k, ax in enumerate(axes):
            pictures.fragility(first.isel(block=k), ax)
            ax.label_outer()
            ax.get_legend().remove()
        columns = 2 if blocks == 1 else 4  # all that one panel is wide enough for
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=columns)

    return panels


def _draw_history(pictures: Any, figure: Any, data: xr.Dataset) -> None:
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.6, 1.0))
    pictures.history(data, upper).set_xlabel("")
    pictures.ground_acceleration(data, lower)


def _found(params: Params) -> Any:
    from rocking._dimensional.response import respond
    from rocking._solver.peak_response import peak_response

    if params.problem is not None:
        return respond(params.problem)
    return peak_response(params.pulse, **params.groups)


def _spectrum(params: Params, window: tuple[float, float]) -> xr.Dataset:
    import numpy as np

    from rocking._cli.arguments import unit_period
    from rocking._solver.peak_response import peak_response

    if params.problem is None:
        groups = params.groups | {"frequency_ratio": np.linspace(*window, POINTS)}
        solved: xr.Dataset = peak_response(params.pulse, **groups).to_xarray()
        return solved
    from dataclasses import replace

    from rocking._dimensional.curves import over_axis
    from rocking._dimensional.response import respond

    unit = unit_period(params.problem.body)
    period = np.geomspace(unit / window[1], unit / window[0], POINTS)
    return over_axis(respond(replace(params.problem, period=period)), "period", period)


def _map(params: Params, window: tuple[float, float]) -> xr.Dataset:
    import numpy as np

    from rocking._dimensional.problem import period_of
    from rocking._solver.peak_response import peak_response

    block = None if params.problem is None else params.problem.block
    amplitude = np.geomspace(*AMPLITUDE, ROWS)
    omega = np.linspace(*window, POINTS) if params.problem is None else np.geomspace(*window, POINTS)[::-1]
    groups = params.groups | {"slenderness": 1.0 / amplitude[:, None], "frequency_ratio": omega}
    found: xr.Dataset = peak_response(params.pulse, **groups).to_xarray()
    if block is None:
        return found
    return found.assign_coords(
        peak_acceleration=("slenderness", block.uplift_acceleration * amplitude, {"units": "m s-2"}),
        period=("frequency_ratio", period_of(block, 1.0) / omega, {"units": "s"}),
    ).swap_dims(slenderness="peak_acceleration", frequency_ratio="period")
