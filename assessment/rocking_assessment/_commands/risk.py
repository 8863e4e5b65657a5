"""`rocking risk`: annual rates of the limit states of a suite, and its fragility for loss programs."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.extension import Configuration, OutputFormat, reported_errors

ENDINGS = (".xml", ".pelicun.csv")

RATES = ("annual_rate", "annual_rate_lower", "annual_rate_upper")


def risk(
    configuration: Configuration,
    hazard: Annotated[
        str | None,
        typer.Option(help="Hazard curve: a table, or a file of OpenQuake or the USGS.", metavar="[FILE]"),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "--output", "-o", help="File to write: .xml (NRML of OpenQuake), or .pelicun.csv.", metavar="[FILE]"
        ),
    ] = None,
    output_format: OutputFormat = "table",
) -> None:
    """Annual rates at which blocks reach their limit states, from a suite of records and a hazard curve.

    The fragility, as of `rocking fragility`, can also be written for programs that compute losses.
    """
    from rocking.extension import (
        InvalidArgumentError,
        curve_table,
        finite_columns,
        output_errors,
        print_columns,
        print_json,
        read_suite,
        suite_fragility,
    )
    from rocking_assessment._hazard.curve_files import read_hazard
    from rocking_assessment._hazard.nrml import write_nrml
    from rocking_assessment._hazard.pelicun import write_pelicun
    from rocking_assessment._hazard.rates import annual_rate

    with reported_errors():
        if hazard is None and output is None:
            raise InvalidArgumentError("hazard", None, "a hazard curve, or --output, a file for a loss program")
        if output is not None and not output.lower().endswith(ENDINGS):
            raise InvalidArgumentError("output", output, f"a name that ends in {' or '.join(ENDINGS)}")
        curve = None if hazard is None else read_hazard(hazard)
    with reported_errors(source="CONFIGURATION"):
        suite = read_suite(configuration)
        fragility = suite_fragility(suite)
    if output is not None:
        write = write_nrml if output.lower().endswith(".xml") else write_pelicun
        with reported_errors({"fragility": "--output"}), output_errors("output", output):
            write(fragility, output)
    if curve is None:
        return
    with reported_errors():
        rates = annual_rate(fragility, curve)
    columns = finite_columns(curve_table(fragility.assign(rates.data_vars), RATES))
    names = [name for name in ("demand", "width", "height", "model", *RATES) if name in columns]
    table = {name: columns[name] for name in names}
    if output_format == "json":
        print_json({"suite": suite.name, "curves": table})
        return
    units = {"width": "m", "height": "m", **dict.fromkeys(RATES, "1/year")}
    print_columns(table, output_format, units)
