"""`rocking fragility`: probability that blocks reach a limit state under a suite of records."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rocking._cli.errors import reported_errors
from rocking._cli.parameters import BaselineOrder, Configuration, OutputFormat

if TYPE_CHECKING:
    import xarray as xr

    from rocking.suites.configuration import SuiteConfiguration


def fragility(
    configuration: Configuration,
    table: Annotated[
        Literal["levels", "curves", "distribution", "sensitivity"],
        typer.Option(
            help="Table to print: counts at each level; fitted curves; distribution of the peak rotation at each "
            "level; friction demand, and the effect of restitution and sampling, if the configuration asks for them. "
            "JSON holds all of them but the distribution."
        ),
    ] = "levels",
    baseline_order: BaselineOrder = None,
    output: Annotated[
        str | None,
        typer.Option("--output", "-o", help="File to write in place of printing: .csv or .json.", metavar="[FILE]"),
    ] = None,
    output_format: OutputFormat = "table",
) -> None:
    """Fragility of blocks under a suite of records: counts, intervals, fitted curves."""
    from rocking._base.errors import InvalidArgumentError, one_of
    from rocking._base.output_file import output_errors
    from rocking._cli.printing import print_columns, print_json, print_values, unit_label
    from rocking.suites.files import ENDINGS, write_fragility
    from rocking.suites.table import curve_table, distribution_table, finite_columns, fragility_table

    if output is not None:
        with reported_errors():
            one_of("output", Path(output).suffix.lower(), ENDINGS)
    with reported_errors(source="CONFIGURATION"):
        suite = read_suite(configuration)
        if baseline_order is not None:
            suite = replace(suite, records=replace(suite.records, baseline_order=baseline_order))
        if table == "sensitivity" and suite.sensitivity is None:
            raise InvalidArgumentError("table", table, "levels and curves: the configuration has no sensitivity")
        solved = suite_fragility(suite)
    if output is not None:
        with reported_errors(), output_errors("output", output):
            write_fragility(solved, output)
        return
    with reported_errors(source="CONFIGURATION"):
        unit = solved["intensity"].attrs["units"]
        records = solved["record"].values.tolist()
        heading = {"suite": suite.name, "records": records, "measure": suite.measure, "unit": unit}
        if output_format == "json":
            tables = {
                "levels": finite_columns(fragility_table(solved)),
                "curves": finite_columns(curve_table(solved)),
            }
            if suite.sensitivity is not None:
                tables["sensitivity"] = finite_columns(_sensitivity(suite))
            print_json({**heading, "confidence": suite.confidence, **tables})
            return
        if table == "sensitivity":
            columns = _sensitivity(suite)
        elif table == "distribution":
            columns = distribution_table(solved)
        elif table == "curves":
            columns = curve_table(solved)
        else:
            columns = fragility_table(solved)
    label = unit_label(unit)
    units = {name: label for name in columns if name.startswith(("intensity", "median_intensity"))}
    units |= {"width": "m", "height": "m"}
    if output_format == "table":
        print_values({**heading, "records": len(records), "unit": label})
    print_columns(finite_columns(columns), output_format, units)


def read_suite(configuration: str) -> SuiteConfiguration:
    """Read the suite in a file."""
    from rocking._base.errors import InvalidArgumentError, UnreadableFileError
    from rocking.suites.configuration import suite_configuration

    path = Path(configuration)
    try:
        values = _parsed(path.suffix, path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableFileError("file", configuration, error) from None
    except (ValueError, RecursionError) as error:  # brackets within brackets
        raise InvalidArgumentError("file", configuration, f"a readable configuration ({error})") from None
    if not isinstance(values, dict):
        raise InvalidArgumentError("file", configuration, "a mapping of keys to values")
    return suite_configuration(values.get("suite", values), path.parent)


def _parsed(ending: str, text: str) -> Any:
    """Parse the content of a file by the ending of its name: TOML, JSON, else YAML."""
    if ending == ".toml":
        import tomllib

        return tomllib.loads(text)
    if ending == ".json":
        return json.loads(text)
    try:
        import yaml  # of the extra `workflow`
    except ModuleNotFoundError:
        raise ValueError("YAML needs the package pyyaml; TOML and JSON need none") from None
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(" ".join(str(error).split())) from None


def suite_fragility(suite: SuiteConfiguration) -> xr.Dataset:
    """Compute the fragility of a suite; remarks and warnings are printed on stderr."""
    from rocking._cli.printing import progress
    from rocking.suites.fragility import fragility as fragility_of

    motions = suite.motions()
    with progress("solving the blocks under the records"):
        solved = fragility_of(
            motions,
            suite.blocks,
            intensity=suite.intensity,
            measure=suite.measure,
            restitution=suite.restitution,
            demand=suite.demand,
            confidence=suite.confidence,
        )
    for motion in motions:
        for remark in motion.remarks:
            typer.echo(f"warning: {motion.name}: {remark}", err=True)
    for warning in filter(None, solved.attrs.get("warnings", "").split("; ")):
        typer.echo(f"warning: {warning}", err=True)
    return solved


def _sensitivity(suite: SuiteConfiguration) -> dict[str, list[Any]]:
    """Compute the table of friction demand, and of the effect of restitution and sampling."""
    from rocking._cli.printing import progress
    from rocking.suites.sensitivity import suite_sensitivity
    from rocking.suites.table import sensitivity_table

    assert suite.sensitivity is not None
    assert isinstance(suite.blocks, tuple)  # by `suite_configuration`
    with progress("solving the blocks with other restitution and sampling"):
        sensitivity = suite_sensitivity(
            suite.motions(),
            suite.blocks,
            intensity=suite.sensitivity.intensity,
            measure=suite.measure,
            restitution=suite.restitution,
            restitution_step=suite.sensitivity.restitution_step,
            confidence=suite.confidence,
        )
    return sensitivity_table(sensitivity)
