"""Numbers read off the plotted data of all figures, against the multi-precision integrator, which shares no code.

`python -m benchmarks.accuracy.figure_readings results` prints the table of docs/figures.md for the figures in
`results`. A value is compared with that of the reference; for a point on a boundary the reference must find different
outcomes a relative `STEP` below and above it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from flint import arb

from reference.exact_response import working_precision
from reference.multiprecision import integrate

STEP = 1e-9
"""Relative distance from a boundary at which outcomes are compared [-]."""

BITS = 192
"""Working precision of the reference."""


class Reading(NamedTuple):
    """One number read off a figure; `difference` is relative, `STEP` for a boundary that the reference confirms."""

    figure: str
    quantity: str
    place: str
    value: float
    difference: float


def reference_peak(
    pulse: str, slenderness: float, omega: float, eta: float, alpha: float = 0.0, scale: float = 1.0
) -> float:
    """Scaled max |theta|/alpha by the multi-precision integrator [-], nan where the block overturns."""
    with working_precision(BITS):
        found = integrate(pulse, slenderness=slenderness, frequency_ratio=omega, restitution=eta, alpha=alpha or None)
        return math.nan if found.overturned or found.peak_rotation is None else scale * float(found.peak_rotation)


def overturns(pulse: str, slenderness: float, omega: float, eta: float, alpha: float = 0.0) -> bool:
    """Outcome by the multi-precision integrator."""
    with working_precision(BITS):
        return integrate(
            pulse, slenderness=slenderness, frequency_ratio=omega, restitution=eta, alpha=alpha or None
        ).overturned


def on_boundary(pulse: str, amplitude: float, omega: float, eta: float, alpha: float = 0.0) -> float:
    """`STEP` if outcomes differ on both sides of an amplitude, else inf."""
    low, high = (overturns(pulse, 1 / (amplitude * (1 + step)), omega, eta, alpha) for step in (-STEP, STEP))
    return STEP if low != high else math.inf


def readings(folder: Path) -> Iterator[Reading]:
    """Readings of all figures in results/figures."""
    yield from _uplift(xr.load_dataset(folder / "figure-01.nc"))
    yield from _first_impacts(xr.load_dataset(folder / "figure-02.nc"))
    yield from _case_1_1(xr.load_dataset(folder / "figure-03.nc"))
    yield from _overturning(xr.load_dataset(folder / "figure-04.nc"))
    yield from _histories(folder)
    yield from _spectra("figure-08", xr.load_dataset(folder / "figure-08.nc"))
    yield from _thresholds(xr.load_dataset(folder / "figure-09.nc"))
    yield from _boundaries(xr.load_dataset(folder / "figure-10.nc"))
    yield from _spectra("figure-13", xr.load_dataset(folder / "figure-13.nc"))
    yield from _sine(xr.load_dataset(folder / "figure-S1.nc"))
    yield from _scale_law(xr.load_dataset(folder / "figure-scale-law.nc"))
    for name in ("figure-master-spectra", "figure-master-housner"):
        yield from _maps(name, xr.load_dataset(folder / f"{name}.nc"))


def _relative(value: float, reference: float) -> float:
    return abs(value / reference - 1)


def _uplift(data: xr.Dataset) -> Iterator[Reading]:
    b, h, a, T = (float(data.attrs[name]) for name in ("width", "height", "peak_acceleration", "period"))
    crossing = np.flatnonzero(data.ground_acceleration.values >= b / h)[0]
    x, y = data.time.values, data.ground_acceleration.values
    found = float(np.interp(b / h, y[crossing - 1 : crossing + 1], x[crossing - 1 : crossing + 1]))
    with working_precision(BITS):
        exact = float((arb(b) / arb(h) / arb(a)).asin() / (2 * arb.pi()) * arb(T))
    yield Reading("1", "time of uplift [s], sampled", f"a_g = {a:g} g", found, _relative(found, exact))


def _first_impacts(data: xr.Dataset) -> Iterator[Reading]:
    eta = float(data.attrs["summary"].split("eta = ")[1].rstrip("."))
    for i, case in enumerate(data.attrs["case_names"].split()):
        for j in range(2):
            found, omega, a = (float(v) for v in (data.first_impact[i, j], data.omega[i], data.amplitude[i, j]))
            if case != "1.1":
                continue
            with working_precision(BITS):
                exact = integrate("sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta)
                time = float(exact.uplift_time + exact.first_impact_time)
            yield Reading("2", "time of the first impact", f"a = {a:g}", found, _relative(found, time))


def _case_1_1(data: xr.Dataset) -> Iterator[Reading]:
    for eta, fraction in zip(data.restitution.values[:2], (0.3, 0.6), strict=False):
        one = data.lower.sel(restitution=eta).dropna("frequency_ratio")
        at = one[int(fraction * one.size)]
        a, omega = float(at), float(at.frequency_ratio)
        place = f"omega = {omega:.3f}, eta = {eta:g}"
        yield Reading("3", "a from which case 1.1 overturns", place, a, on_boundary("sine", a, omega, float(eta)))


def _overturning(data: xr.Dataset) -> Iterator[Reading]:
    eta = float(data.restitution[-1])
    for name, wanted in (("overturns_from", 3.0), ("survives_again", 3.5), ("direct", 4.0)):
        j = int(np.abs(data.frequency_ratio.values - wanted).argmin())
        column = data[name].isel(frequency_ratio=j)
        a = float(column.sel(restitution=eta)) if "restitution" in column.dims else float(column)
        omega = float(data.frequency_ratio[j])
        yield Reading("4", name.replace("_", " "), f"omega = {omega:.3f}", a, on_boundary("sine", a, omega, eta))
    known = np.flatnonzero(np.isfinite(data.island_amplitude.values) & (data.island_impacts.values == 3))
    for k in known[[known.size // 4, known.size // 2]]:
        a, omega, of = (float(data[f"island_{name}"][k]) for name in ("amplitude", "frequency_ratio", "restitution"))
        yield Reading("4", "island of three impacts", f"omega = {omega:.3f}", a, on_boundary("sine", a, omega, of))


def _histories(folder: Path) -> Iterator[Reading]:
    data = xr.load_dataset(folder / "figure-05.nc")
    groups = (
        data.attrs["pulse_name"],
        *(float(data.attrs[k]) for k in ("slenderness", "frequency_ratio", "restitution")),
    )
    peak = reference_peak(*groups)
    for k in range(2):
        found = float(np.abs(data.rotation[k]).max())
        exact = peak * float(data.alpha[k])
        yield Reading("5", "peak rotation [rad], sampled", f"block {k + 1}", found, _relative(found, exact))
    scaled = xr.load_dataset(folder / "figure-06.nc")
    found = float(np.abs(scaled.master_rotation).max())
    yield Reading("6", "peak g theta/a_g, sampled", "master curve", found, _relative(found, peak * groups[1]))
    data = xr.load_dataset(folder / "figure-07.nc")
    s, omega = float(data.attrs["slenderness"]), float(data.attrs["frequency_ratio"])
    for i, pulse in enumerate(data.attrs["pulse_names"].split()):
        eta = float(data.restitution[0])
        found = float(np.abs(data.rotation[i, 0]).max())
        exact = reference_peak(pulse, s, omega, eta, scale=s)
        yield Reading("7", "peak g theta/a_g, sampled", f"{pulse}, eta = {eta:g}", found, _relative(found, exact))
    for number in (11, 12):
        data = xr.load_dataset(folder / f"figure-{number}.nc")
        s, omega, eta = (float(data.attrs[k]) for k in ("slenderness", "frequency_ratio", "restitution"))
        alpha = float(data.alpha[-1])
        found = float(np.abs(data.rotation[0, 1, -1]).max())  # groups of (6.1)
        exact = reference_peak("sine", s, omega, eta, alpha, s * alpha / math.sin(alpha))
        place = f"sine, {math.degrees(alpha):.0f} degrees"
        yield Reading(str(number), "peak g theta/(a_g cos alpha), sampled", place, found, _relative(found, exact))


def _spectra(name: str, data: xr.Dataset) -> Iterator[Reading]:
    ends = np.cumsum(data.row_size.values)
    starts = ends - data.row_size.values
    pulses = data.attrs["pulse_names"].split()
    # the branch in the middle of each panel, and one end at the boundary
    for s in np.unique(data.curve_slenderness):
        for i, pulse in enumerate(pulses):
            here = np.flatnonzero((data.curve_slenderness.values == s) & (data.curve_pulse.values == i))
            k = int(here[here.size // 2])
            eta, alpha = float(data.curve_restitution[k]), float(data.curve_alpha[k])
            scale = s * (alpha / math.sin(alpha) if alpha else 1.0)
            at = (starts[k] + ends[k]) // 2
            omega, found = float(data.frequency_ratio[at]), float(data.spectrum[at])
            exact = reference_peak(pulse, float(s), omega, eta, alpha, scale)
            which = f"{math.degrees(alpha):.0f} degrees" if alpha else f"eta = {eta:.2f}"
            place = f"{pulse}, 1/a = {s:.2f}, {which}, omega = {omega:.3f}"
            yield Reading(name[7:].lstrip("0"), "peak", place, found, _relative(found, exact))
            if data.overturns_below[k] and s == np.unique(data.curve_slenderness)[0]:
                omega = float(data.frequency_ratio[starts[k]])
                at_end, beyond = (overturns(pulse, float(s), omega * (1 - step), eta, alpha) for step in (0.0, STEP))
                changed = STEP if not at_end and beyond else math.inf
                yield Reading(
                    name[7:].lstrip("0"), "omega at the end of the curve", place.rpartition(",")[0], omega, changed
                )


def _thresholds(data: xr.Dataset) -> Iterator[Reading]:
    eta, alpha = float(data.attrs["restitution"]), float(data.attrs["alpha"])
    pulses = data.attrs["pulse_names"].split()
    for k in (0, data.sizes["threshold"] - 1):
        omega, a = float(data.threshold_frequency_ratio[k]), float(data.threshold_amplitude[k])
        pulse = pulses[int(data.threshold_pulse[k])]
        changed = on_boundary(pulse, a, omega, eta, alpha)
        yield Reading("9", "threshold a_g/(g tan alpha)", f"{pulse}, omega = {omega:.3f}", a, changed)


def _boundaries(data: xr.Dataset) -> Iterator[Reading]:
    eta = float(data.attrs["restitution"])
    pulses = data.attrs["pulse_names"].split()
    for i, pulse in enumerate(pulses):
        for alpha in (data.alpha.values[0], data.alpha.values[-1]):
            known = np.flatnonzero(
                (data.boundary_pulse.values == i) & (data.boundary_alpha.values == alpha)
                & np.isfinite(data.boundary_amplitude.values) & (data.boundary_impacts.values == 1)
            )  # fmt: skip
            k = known[known.size // 3]
            a, omega = float(data.boundary_amplitude[k]), float(data.boundary_frequency_ratio[k])
            place = f"{pulse}, {math.degrees(alpha):.0f} degrees, omega = {omega:.3f}"
            changed = on_boundary(pulse, a, omega, eta, float(alpha))
            yield Reading("10", "boundary a_g/(g tan alpha)", place, a, changed)


def _sine(data: xr.Dataset) -> Iterator[Reading]:
    tau, omega = float(data.tau[60]), float(data.frequency_ratio[0])
    with working_precision(BITS):
        exact = float((arb(omega) * arb(tau) + arb(float(data.attrs["slenderness"])).asin()).sin())
    found = float(data.exact[0, 60])
    yield Reading("S1", "sin(omega tau + psi)", f"omega = {omega:g}, tau = {tau:g}", found, _relative(found, exact))


def _scale_law(data: xr.Dataset) -> Iterator[Reading]:
    s, omega = data.slenderness.values, data.frequency_ratio.values
    eta, reference = np.atleast_1d(data.attrs["restitution"]), float(data.attrs["reference"])
    for level, frequency in ((0.3, 10.0), (0.6, 8.0)):
        i, j = int(np.abs(s - level).argmin()), int(np.abs(omega - frequency).argmin())
        peaks = np.array([reference_peak("sine", float(s[i]), float(omega[j]), float(one)) for one in eta])
        law = peaks[np.abs(eta - reference).argmin()] * (eta / reference) ** 2
        found, exact = float(data.deviation[i, j]), float(np.abs(law / peaks - 1).max())
        place = f"1/a = {s[i]:.2f}, omega = {omega[j]:.3f}"
        yield Reading("scale-law", "error of the law", place, found, _relative(found, exact))


def _maps(name: str, data: xr.Dataset) -> Iterator[Reading]:
    for i, pulse in enumerate(data.attrs["pulse_names"].split()):
        k = data.alpha.size - 1
        alpha, eta = float(data.alpha[k]), float(data.restitution[k])
        row, column = int(0.6 * data.slenderness.size), int(0.9 * data.frequency_ratio.size)
        s, omega = float(data.slenderness[row]), float(data.frequency_ratio[column])
        found = float(data.spectrum[i, k, row, column])
        exact = reference_peak(pulse, s, omega, eta, alpha, s * alpha / math.sin(alpha))
        place = f"{pulse}, {math.degrees(alpha):.0f} degrees, 1/a = {s:.3f}, omega = {omega:.3f}"
        yield Reading(name[7:], "peak", place, found, _relative(found, exact))


def as_markdown(found: list[Reading]) -> str:
    """The readings as a table."""
    rows = ["| figure | number | where | read off | difference |", "|---|---|---|---|---|"]
    for one in found:
        difference = f"{one.difference:.0e}" if one.difference else "0"
        rows.append(f"| {one.figure} | {one.quantity} | {one.place} | {one.value:.9g} | {difference} |")
    return "\n".join(rows)


if __name__ == "__main__":
    print(as_markdown([*readings(Path(sys.argv[1]) / "figures")]))
