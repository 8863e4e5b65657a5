"""Fragility curves for other programs: NRML 0.5, the format of OpenQuake.

The curves of a suite are not monotone, so that they are written with `format="discrete"`, the probabilities at the
levels. On request the lognormal fits are written with `format="continuous"`, `shape="logncdf"`. OpenQuake takes the
mean m and the standard deviation s of the intensity itself there, not of its logarithm: its function
`openquake.risklib.scientific.FragilityFunctionContinuous` computes beta^2 = ln(1 + s^2/m^2) and the median
m^2/sqrt(m^2 + s^2). For a median x and a dispersion beta therefore m = x exp(beta^2/2), s = m sqrt(exp(beta^2) - 1).
Its unit of PGA is g, of PGV cm/s. The readers of openquake.engine 3.26 take both formats.
"""

import math
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from os import PathLike
from typing import IO, Literal

import xarray as xr

from rocking.extension import (
    STANDARD_GRAVITY,
    Array,
    FitStatus,
    Flags,
    InvalidArgumentError,
    curve_probability,
    fit_curve,
    one_of,
    with_block,
    write_output,
)

NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"

TYPES = {"pga": ("PGA", STANDARD_GRAVITY), "pgv": ("PGV", 0.01)}
"""Intensity measure types of OpenQuake for those of this package that a hazard curve has, with their units in SI."""

STEP_DISPERSION = 1e-3
"""Dispersion that is written for a step [-], such as uplift over the PGA: OpenQuake has no curve of dispersion 0."""

SMALL = 0.01
"""Fitted probability at the lowest level above which a warning is given [-]: OpenQuake takes it for zero below."""

LIMIT_STATES = ("rocks", "overturns")


def write_nrml(
    fragility: xr.Dataset,
    path: str | PathLike[str] | IO[bytes],
    *,
    format: Literal["discrete", "lognormal"] = "discrete",  # noqa: A002  # the word of NRML
    description: str = "rocking of free-standing blocks",
) -> None:
    """Write the fragility of blocks as a fragility model of OpenQuake, limit states rocks and overturns.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`, with the measure pga or pgv; one function for each block, `block-1` and so on.
    path : path or binary file
        The file, written anew, or one that is open for writing.
    format : {"discrete", "lognormal"}
        Fractions at the levels, or curves fitted to them. OpenQuake's curve is constant above the highest level. Below
        the lowest one it is a line from zero at zero, for a fitted curve zero.
    description : str
        A text for the file.

    Raises
    ------
    InvalidArgumentError
        If the measure has no counterpart, there is one level only, or a fit does not exist.

    Warns
    -----
    UserWarning
        If a fitted curve is above 0.01 at the lowest level, below which OpenQuake has no damage.
    """
    one_of("format", format, ("discrete", "lognormal"))
    name, unit = TYPES[checked_measure(fragility, TYPES)]
    levels, reached_by = reached_states(fragility)
    root = ET.Element("nrml", xmlns=NAMESPACE)
    model = ET.SubElement(root, "fragilityModel", id="rocking", assetCategory="contents", lossCategory="contents")
    ET.SubElement(model, "description").text = description
    ET.SubElement(model, "limitStates").text = " ".join(LIMIT_STATES)
    shape = {"format": "discrete"} if format == "discrete" else {"format": "continuous", "shape": "logncdf"}
    for k in range(reached_by["rocks"].shape[0]):
        function = ET.SubElement(model, "fragilityFunction", attrib={"id": f"block-{k + 1}", **shape})
        if format == "discrete":
            ET.SubElement(function, "imls", imt=name).text = _numbers(levels / unit)
        else:
            low, high = (f"{level / unit:.9g}" for level in (levels[0], levels[-1]))
            ET.SubElement(function, "imls", imt=name, noDamageLimit=low, minIML=low, maxIML=high)
        for state, of_blocks in reached_by.items():
            reached = of_blocks[k]
            if format == "discrete":
                ET.SubElement(function, "poes", ls=state).text = _numbers(reached.mean(axis=1))
                continue
            median, beta = lognormal_of(reached, levels, f"block-{k + 1} {state}", ("format", format, "discrete"))
            at_start = float(curve_probability("lognormal", levels[0], median, beta))
            if at_start > SMALL:
                text = (
                    f"block-{k + 1} {state}: at noDamageLimit, the lowest level, the fitted probability is "
                    f"{at_start:.2g}, and OpenQuake has none below: add lower levels, or write format='discrete'"
                )
                warnings.warn(text, UserWarning, stacklevel=2)
            mean = median / unit * math.exp(0.5 * beta**2)
            deviation = mean * math.sqrt(math.expm1(beta**2))
            ET.SubElement(function, "params", ls=state, mean=f"{mean:.9g}", stddev=f"{deviation:.9g}")
    ET.indent(root)
    content = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    if isinstance(path, str | PathLike):
        write_output(path, content)
    else:
        path.write(content)


def checked_measure(fragility: xr.Dataset, measures: Mapping[str, object]) -> str:
    """The measure of a fragility, one of `measures`."""
    measure = str(fragility.attrs.get("measure", ""))
    if measure not in measures:
        raise InvalidArgumentError("fragility", measure, f"a fragility with the measure {' or '.join(measures)}")
    return measure


def reached_states(fragility: xr.Dataset) -> tuple[Array, dict[str, Flags]]:
    """The levels, and by limit state True where it is reached, (blocks, levels, records)."""
    data = with_block(fragility)
    levels = data["intensity"].values
    if levels.size < 2:
        raise InvalidArgumentError("fragility", f"{levels.size} level", "two levels at least")
    outcomes = data[["overturned", "peak_rotation"]].transpose("block", "intensity", "record")
    overturns = outcomes["overturned"].values.astype(bool)
    rocks = overturns | (outcomes["peak_rotation"].values > 0.0)
    return levels, {"rocks": rocks, "overturns": overturns}


def lognormal_of(reached: Flags, levels: Array, curve: str, argument: tuple[str, object, str]) -> tuple[float, float]:
    """Median and dispersion of the lognormal fit to (levels, records); without a fit, an error of `argument`."""
    fit = fit_curve(reached, levels, model="lognormal")
    if fit.status not in (FitStatus.FITTED, FitStatus.SEPARATED):
        name, value, allowed = argument
        raise InvalidArgumentError(name, value, f"{allowed}: {curve}: {fit.status.sentence}")
    return fit.median, max(fit.dispersion, STEP_DISPERSION)


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.9g}" for value in values)
