"""`rocking fragility`: probability that blocks reach a limit state under a suite of records."""

from __future__ import annotations

import json as json_format
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rocking._cli.options import BaselineOrder, OutputOptions, said, with_options
from rocking._cli.progress import progress
from rocking._cli.record import file_errors

if TYPE_CHECKING:
    import xarray as xr

    from rocking.suites.configuration import SuiteConfiguration

Configuration = Annotated[
    str,
    typer.Argument(
        help="Configuration of a suite (YAML, TOML or JSON), such as workflow/config/suite.yaml.",
        metavar="CONFIGURATION",
    ),
]

MAX_NESTING = 100  # most brackets within brackets of a suite in YAML

MAX_LINE = 4096
"""Most characters of a line of TOML: the time of tomllib grows with the square of the parts of a key such as a.b.c."""


@with_options
def fragility(
    configuration: Configuration,
    output: OutputOptions,
    table: Annotated[
        Literal["levels", "curves", "distribution", "sensitivity"],
        typer.Option(
            "--table",
            help="What --format csv holds: counts at each level; fitted curves; the distribution of the peak rotation "
            "at each level; friction demand, and the effect of restitution and sampling, if the configuration asks "
            "for them.",
        ),
    ] = "levels",
    baseline_order: BaselineOrder = None,
    file: Annotated[
        str | None,
        said("File to write: .csv or .json.", "FILE", "--output", "-o"),
    ] = None,
) -> None:
    """Fragility of blocks under a suite of records: counts, intervals, fitted curves.

    If the configuration asks for it, also the friction demand, and the effect of restitution and sampling.
    """
    from rocking._base.errors import InvalidArgumentError
    from rocking._base.output_file import output_errors
    from rocking._cli import printing
    from rocking._cli.arguments import option_errors
    from rocking.suites.files import ENDINGS, write_fragility
    from rocking.suites.table import curve_table, distribution_table, finite, fragility_table

    with configuration_errors():
        form = printing.output_format(output)
    suite = read_suite(configuration)
    if baseline_order is not None:
        suite = replace(suite, records=replace(suite.records, baseline_order=baseline_order))
    with option_errors():
        if table == "sensitivity" and suite.sensitivity is None:
            raise InvalidArgumentError("table", table, "levels and curves: the configuration has no sensitivity")
        if table != "levels" and form.kind != "csv":
            raise InvalidArgumentError("table", table, "with --format csv; the other formats hold all tables")
        if file is not None and (form.kind != "table" or not file.lower().endswith(ENDINGS)):
            raise InvalidArgumentError(
                "output", file, f"a name that ends in {', '.join(ENDINGS)}, without --format csv or json"
            )
    found = suite_fragility(suite)
    with option_errors({"fragility": "--output", "format": "--output"}):
        if file is not None:
            with output_errors("output", file):
                write_fragility(found, file)
            return
    tables = {"levels": fragility_table(found), "curves": curve_table(found)}
    if table == "distribution":
        tables[table] = distribution_table(found)
    if suite.sensitivity is not None and (form.kind != "csv" or table == "sensitivity"):
        tables["sensitivity"] = _sensitivity(suite)
    unit = found["intensity"].attrs["units"]
    measured = ("intensity", *(f"median_intensity{end}" for end in ("", "_lower", "_upper")))
    usual = re.sub(r" s-(\d)", lambda power: "/s" + power[1].replace("1", ""), unit)  # m/s2 for m s-2
    units = dict.fromkeys(measured, usual) if unit != "1" else {}
    if form.kind == "csv":
        printing.print_csv(tables[table], form, units)
        return
    about = {"suite": suite.name, "records": found["record"].values.tolist(), "measure": suite.measure, "unit": unit}
    rows = {name: finite(columns) for name, columns in tables.items()}
    if form.kind == "json":
        printing.print_json({**about, "confidence": suite.confidence, **rows})
        return
    printing.print_text({**about, "records": len(about["records"]), "unit": usual}, form)
    printing.print_table(_with_intervals(rows["curves"]), units)
    typer.echo()
    printing.print_table(rows["levels"], units)
    if "sensitivity" in rows:
        typer.echo()
        printing.print_table(_of_sensitivity(rows["sensitivity"], len(about["records"])), units)


def read_suite(configuration: str) -> SuiteConfiguration:
    """The suite in a file; errors name the key."""
    from rocking.suites.configuration import suite_configuration

    path = Path(configuration)
    with configuration_errors():
        given = _read(path)
        return suite_configuration(given.get("suite", given), path.parent)


def suite_fragility(suite: SuiteConfiguration) -> xr.Dataset:
    """The fragility of a suite; errors name the key or the file."""
    from rocking.suites.fragility import fragility as fragility_of

    with configuration_errors(), file_errors(), progress("solving the blocks under the records"):
        motions = suite.motions()
        for motion in motions:
            for remark in motion.remarks:
                typer.echo(f"warning: {motion.name}: {remark}", err=True)
        found = fragility_of(
            motions,
            suite.blocks,
            intensity=suite.intensity,
            measure=suite.measure,
            restitution=suite.restitution,
            demand=suite.demand,
            confidence=suite.confidence,
        )
    for warning in filter(None, found.attrs.get("warnings", "").split("; ")):
        typer.echo(f"warning: {warning}", err=True)
    return found


def _sensitivity(suite: SuiteConfiguration) -> dict[str, list[Any]]:
    """The table of friction demand, and of the effect of restitution and sampling."""
    from rocking.suites.sensitivity import suite_sensitivity
    from rocking.suites.table import sensitivity_table

    assert suite.sensitivity is not None
    assert isinstance(suite.blocks, tuple)  # by `suite_configuration`
    with configuration_errors(), file_errors(), progress("solving the blocks with other restitution and sampling"):
        found = suite_sensitivity(
            suite.motions(),
            suite.blocks,
            intensity=suite.sensitivity.intensity,
            measure=suite.measure,
            restitution=suite.restitution,
            restitution_step=suite.sensitivity.restitution_step,
            confidence=suite.confidence,
        )
    return sensitivity_table(found)


@contextmanager
def configuration_errors() -> Iterator[None]:
    """Convert an invalid configuration into an error of the command line that names the key."""
    from rocking._base.errors import InvalidArgumentError

    try:
        yield
    except InvalidArgumentError as error:
        message = str(error).replace("`", "")
        raise typer.BadParameter(message, param_hint="CONFIGURATION") from None


def _read(path: Path) -> dict[str, Any]:
    """The mapping in a file, by the ending of its name."""
    from rocking._base.errors import InvalidArgumentError, UnreadableFileError

    try:
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".toml":
            found: Any = _toml(text)
        elif path.suffix == ".json":
            found = json_format.loads(text)
        else:
            found = _yaml(text)
    except OSError as error:
        raise UnreadableFileError("file", str(path), error) from None
    except (ValueError, RecursionError) as error:  # brackets within brackets
        raise InvalidArgumentError("file", str(path), f"a readable configuration ({error})") from None
    if not isinstance(found, dict):
        raise InvalidArgumentError("file", str(path), "a mapping of keys to values")
    return found


def _toml(text: str) -> Any:
    if max(map(len, text.split("\n"))) > MAX_LINE:
        raise ValueError(f"lines of TOML have at most {MAX_LINE} characters")
    import tomllib

    return tomllib.loads(text)


def _yaml(text: str) -> Any:
    try:
        import yaml  # of the extra `workflow`
    except ModuleNotFoundError:
        raise ValueError("YAML needs the package pyyaml; TOML and JSON need none") from None
    open_brackets = accumulate((c in "[{") - (c in "]}") for c in text)
    if max(open_brackets, default=0) > MAX_NESTING:  # the reader takes time with the square of the depth
        raise ValueError(f"brackets are nested at most {MAX_NESTING} deep")
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(" ".join(str(error).split())) from None


def _with_intervals(curves: dict[str, list[Any]]) -> dict[str, list[Any]]:
    """The columns of the table of curves that fit a screen, intervals beside their values; JSON has all of them."""
    shown = ("demand", "width", "height", "model", "fit_status", "median_intensity", "dispersion")

    def column(name: str) -> list[Any]:
        if name not in ("median_intensity", "dispersion"):
            return curves[name]
        ends = zip(*(curves[name + end] for end in ("", "_lower", "_upper")), strict=True)
        texts = [["-" if value is None else f"{value:.4g}" for value in row] for row in ends]
        return [f"{value} ({low} to {high})" for value, low, high in texts]

    return {name: column(name) for name in (*shown, "records_surviving_above_first")}


def _of_sensitivity(rows: dict[str, list[Any]], records: int) -> dict[str, list[Any]]:
    """The columns of the table of sensitivities that fit a screen; CSV and JSON have all of them."""

    def count(fraction: float) -> str:
        return f"{round(fraction * records)} of {records}"

    shown = {name: rows[name] for name in ("width", "height", "intensity")}
    shown["overturn"] = [count(value) for value in rows["fraction"]]
    for end in ("low", "high"):
        pairs = zip(rows[f"fraction_{end}_restitution"], rows[f"restitution_{end}"], strict=True)
        shown[f"{end}_restitution"] = [f"{count(value)} (eta {eta:.3g})" for value, eta in pairs]
    shown["resampled"] = [count(value) for value in rows["fraction_resampled"]]
    friction = ("friction_demand_median", "friction_demand_largest", "records_changed_by_sampling")
    return shown | {name: rows[name] for name in friction}
