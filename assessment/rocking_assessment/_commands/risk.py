"""`rocking risk`: annual rates of the limit states of a suite, and its fragility for loss programs."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.extension import OutputOptions, said, with_options

ENDINGS = (".xml", ".pelicun.csv")


@with_options
def risk(
    configuration: Annotated[
        str,
        typer.Argument(
            help="Configuration of a suite (YAML, TOML or JSON), such as workflow/config/suite.yaml.",
            metavar="CONFIGURATION",
        ),
    ],
    output: OutputOptions,
    hazard: Annotated[str | None, said("Hazard curve: a table, or a file of OpenQuake or the USGS.", "FILE")] = None,
    file: Annotated[
        str | None,
        said("File to write: .xml (NRML of OpenQuake), or .pelicun.csv.", "FILE", "--output", "-o"),
    ] = None,
) -> None:
    """Annual rates at which blocks reach their limit states, from a suite of records and a hazard curve.

    The fragility, as of `rocking fragility`, can also be written for programs that compute losses.
    """
    from rocking.extension import (
        InvalidArgumentError,
        configuration_errors,
        curve_table,
        finite,
        option_errors,
        output_errors,
        output_format,
        print_csv,
        print_json,
        print_table,
        read_suite,
        suite_fragility,
    )
    from rocking_assessment._hazard.curve_files import read_hazard
    from rocking_assessment._hazard.nrml import write_nrml
    from rocking_assessment._hazard.pelicun import write_pelicun
    from rocking_assessment._hazard.rates import annual_rate

    with configuration_errors():
        form = output_format(output)
    suite = read_suite(configuration)
    with option_errors():
        if hazard is None and file is None:
            raise InvalidArgumentError("hazard", None, "a hazard curve, or --output, a file for a loss program")
        if file is not None and not file.lower().endswith(ENDINGS):
            raise InvalidArgumentError("output", file, f"a name that ends in {' or '.join(ENDINGS)}")
        curve = None if hazard is None else read_hazard(hazard)
    fragility = suite_fragility(suite)
    with option_errors({"fragility": "--output", "format": "--output"}):
        if file is not None:
            write = write_nrml if file.lower().endswith(".xml") else write_pelicun
            with output_errors("output", file):
                write(fragility, file)
        if curve is None:
            return
        rates = annual_rate(fragility, curve)
    names = ("annual_rate", "annual_rate_lower", "annual_rate_upper")
    columns = curve_table(fragility.assign(rates.data_vars), names)
    table = {name: columns[name] for name in ("demand", "width", "height", "model", *names) if name in columns}
    if form.kind == "csv":
        print_csv(table, form)
    elif form.kind == "json":
        numbers = {
            name: [finite(cell) if isinstance(cell, float) else cell for cell in cells] for name, cells in table.items()
        }
        print_json({"suite": suite.name, "curves": numbers})
    else:
        print_table(table)
