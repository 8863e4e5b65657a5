"""Write the reference problems in reference/problems: `python -m reference.make_problems` (some minutes).

Each file states a body, a motion and the answer of the multi-precision integrations of this folder, with the digits
that another code can be asked for. docs/reference-problems.md describes them; schema.json is their JSON schema.
"""

import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from flint import acb, arb

from reference.conditioning import integrate_with_conditioning
from reference.exact_response import ExactResponse, working_precision
from reference.records import Edge, response_and_amplification

FOLDER = Path(__file__).with_name("problems")
GRAVITY = 9.80665
DIGITS = 12
OUTCOMES = "no uplift", "recovers", "overturns without impact", "overturns after impact"

PULSES = {
    "sine": ("sin(phi)", 0.0, 2.0 * math.pi),
    "cosine": ("cos(phi)", 0.0, 2.0 * math.pi),
    "half_sine": ("sin(phi)", 0.0, math.pi),
    "rectangular": ("1", 0.0, math.pi),
    "ricker": ("(1 - phi^2/2) exp(-phi^2/4)", -4.0 * math.pi, 4.0 * math.pi),
    "ricker_antisymmetric": (
        "(z^2 - 3) z exp(-z^2/2)/(sqrt(6) sqrt(3 - sqrt(6)) exp(-(3 - sqrt(6))/2)), z = phi/sqrt(3)",
        -4.0 * math.pi,
        4.0 * math.pi,
    ),
}
"""f(phi) with its first and last phase; the ground accelerates by a_g f(phi), phi = first phase + 2 pi t/T."""

RECTANGLE = {"left": 0.2, "right": 0.2, "height": 0.8}
"""Geometry of the block that bodies of finite elements and contacts can repeat, 0.4 m by 1.6 m."""

UNDER_PULSES = (
    # title; pulse, a_g [m/s2], T [s]; alpha [rad], p [rad/s], restitution, slender; or a geometry
    ("sine, one impact", "sine", 2.4, 1.0, 0.2, 2.5, 0.9, True),
    ("sine, several impacts", "sine", 2.2, 0.5, 0.15, 2.0, 0.95, True),
    ("sine, overturns after one impact", "sine", 4.0, 1.2, 0.2, 2.5, 0.9, True),
    ("sine, overturns without impact", "sine", 8.0, 1.5, 0.2, 2.5, 0.9, True),
    ("cosine", "cosine", 3.0, 0.8, 0.2, 2.0, 0.85, True),
    ("half sine", "half_sine", 3.0, 0.6, 0.2, 2.5, 0.8, True),
    ("rectangular, starts with a jump", "rectangular", 2.5, 0.7, 0.2, 2.0, 0.9, True),
    ("Ricker wavelet", "ricker", 3.5, 0.7, 0.2, 2.0, 0.9, True),
    ("antisymmetric Ricker wavelet", "ricker_antisymmetric", 3.0, 0.8, 0.2, 2.0, 0.9, True),
    ("no uplift", "sine", 1.9, 1.0, 0.2, 2.5, 0.9, True),
    ("sine, rectangle of 40 cm by 160 cm", "sine", 0.4 * GRAVITY, 0.5, RECTANGLE),
    ("sine, wide block", "sine", 7.5, 1.0, 0.6, 3.0, 0.5, False),
    ("sine, the same rectangle overturns", "sine", 0.6 * GRAVITY, 0.5, RECTANGLE),
    ("cosine", "cosine", 3.0, 0.8, 0.2, 2.0, 0.85, False),
    ("cosine, overturns without impact", "cosine", 14.0, 2.0, 0.25, 2.0, 0.9, False),
    ("half sine", "half_sine", 3.5, 0.6, 0.25, 2.5, 0.8, False),
    ("rectangular", "rectangular", 2.8, 0.7, 0.25, 2.0, 0.9, False),
    ("Ricker wavelet", "ricker", 3.5, 0.7, 0.25, 2.0, 0.9, False),
    ("restitution 0", "cosine", 3.5, 0.8, 0.2, 2.5, 0.0, False),
    ("restitution 1", "sine", 3.0, 0.6, 0.2, 2.5, 1.0, False),
    ("near the onset, the impacts accumulate", "cosine", 2.0, 1.0, 0.2, 2.5, 0.7, False),
    ("grazing: just below the lowest overturning", "sine", None, 1.0, 0.2, 2.5, 0.9, True),
    ("grazing: just above the lowest overturning", "sine", None, 1.0, 0.2, 2.5, 0.9, True),
)

GRAZING = 1e-6  # relative distance of the grazing problems from the lowest overturning amplitude [-]

SLENDER, WALL = {"slender": True}, {"wall": True}

UNDER_SAMPLES = (
    # title; seed, samples, time step [s], largest acceleration [m/s2], its share in the vertical; body
    ("record, slender", 1, 300, 0.02, 3.0, 0.0, {"alpha": 0.2, "p": 2.5, "restitution": 0.9} | SLENDER),
    ("record, slender, overturns", 2, 300, 0.02, 6.0, 0.0, {"alpha": 0.15, "p": 3.0, "restitution": 0.9} | SLENDER),
    ("record", 3, 300, 0.02, 2.8, 0.0, {"alpha": 0.2, "p": 2.5, "restitution": 0.9}),
    ("record, wide block", 4, 300, 0.02, 9.0, 0.0, {"alpha": 0.6, "p": 3.0, "restitution": 0.5}),
    ("record with a vertical component", 5, 300, 0.02, 3.5, 0.6, {"alpha": 0.2, "p": 2.5, "restitution": 0.9}),
    ("record with a strong vertical component", 6, 300, 0.02, 3.0, 2.5, {"alpha": 0.25, "p": 2.0, "restitution": 0.8}),
    ("two edges", 7, 250, 0.02, 4.0, 0.0, {"left": 0.15, "right": 0.25, "height": 0.8}),
    ("two edges, the weaker one first", 8, 250, 0.02, 3.5, 0.0, {"left": 0.3, "right": 0.15, "height": 1.0}),
    ("two edges with a vertical component", 9, 250, 0.02, 3.0, 0.5, {"left": 0.2, "right": 0.25, "height": 1.0}),
    ("two edges, overturns", 10, 250, 0.02, 5.0, 0.0, {"left": 0.1, "right": 0.2, "height": 1.2}),
    ("against a wall", 11, 250, 0.02, 3.5, 0.0, {"alpha": 0.2, "p": 2.5, "restitution": 0.6} | WALL),
    ("against a wall, no rebound", 12, 250, 0.02, 3.5, 0.0, {"alpha": 0.2, "p": 2.5, "restitution": 0.0} | WALL),
    ("against a wall, vertical motion", 13, 250, 0.02, 3.5, 0.5, {"alpha": 0.2, "p": 2.5, "restitution": 0.5} | WALL),
    ("chaotic", 36, 3000, 0.02, 1.78, 0.0, {"alpha": 0.15, "p": 4.0, "restitution": 0.995}),
    ("chaotic, three digits remain", 19, 3000, 0.02, 1.63, 0.0, {"alpha": 0.15, "p": 4.0, "restitution": 0.995}),
)  # fmt: skip

FREE = (
    ("free rocking, slender", 0.8, {"alpha": 0.2, "p": 2.5, "restitution": 0.9, "slender": True}),
    ("free rocking", 0.8, {"alpha": 0.3, "p": 2.0, "restitution": 0.85}),
)
"""Title, initial rotation over alpha, body: released at rest from it."""

FREE_IMPACTS = 6


def problems() -> Iterator[dict[str, Any]]:
    """The problems, without their identifiers."""
    lowest = 0.0
    for title, name, stated, period, *own in UNDER_PULSES:
        body = own[0] if len(own) == 1 else dict(zip(("alpha", "p", "restitution", "slender"), own, strict=True))
        made = _two_edges(body)
        body = made["edges"]["right"] | {"slender": made["equation"] == "slender"}
        peak = stated
        if stated is None:
            lowest = lowest or _lowest_overturning(name, period, body)
            peak = lowest * (1.0 + (GRAZING if "above" in title else -GRAZING))
        formula, first, last = PULSES[name]
        motion = {
            "kind": "pulse",
            "name": name,
            "formula": formula,
            "phases": [first, last],
            "peak_acceleration": peak,
            "period": period,
        }
        response, condition = integrate_with_conditioning(**_groups(name, peak, period, body))
        factor = condition.peak_rotation / math.ulp(1.0)
        yield _problem(title, made, motion, _answer(response, body["p"]), factor, "Taylor series of 192 bits")
    for title, seed, count, step, peak, vertical, given in UNDER_SAMPLES:
        motion = _samples(seed, count, step, peak, vertical)
        body = _two_edges(given)
        response, factor = response_and_amplification(**_record_groups(motion, body))
        answer = _answer(response, body["edges"]["right"]["p"])
        yield _problem(title, body, motion, answer, factor, "Taylor series of 170 bits")
    for title, start, given in FREE:
        body = _two_edges(given)
        motion = {"kind": "release", "rotation": start * given["alpha"], "velocity": 0.0}
        with working_precision(192):
            times = _impact_times(arb(motion["rotation"]), **given)
            answer = {"outcome": OUTCOMES[1], "impact_times": [_digits(time) for time in times]}
        yield _problem(title, body, motion, answer, 1.0, "closed form, elliptic integrals of 192 bits")


def _problem(
    title: str, body: dict[str, Any], motion: dict[str, Any], answer: dict[str, Any], factor: float, how: str
) -> dict[str, Any]:
    """A problem whose peak changes by `factor` times the relative change of the motion."""
    known = factor if math.isfinite(factor) else 1.0
    return {
        "title": title,
        "body": body,
        "motion": motion,
        "answer": answer,
        "conditioning": float(f"{known:.3g}"),
        "digits": max(0, min(DIGITS, math.floor(15.0 - math.log10(max(known, 1.0))))),
        "obtained": how,
    }


def _two_edges(given: dict[str, Any]) -> dict[str, Any]:
    """The body of a problem: alpha [rad], p [rad/s] and restitution of both edges; none on the left beside a wall."""
    if "height" in given:  # a uniform rectangle of twice this height, the centre of mass not in its middle
        height, sides = given["height"], (given["right"], given["left"])
        square = (sum(sides) ** 2 + (2.0 * height) ** 2) / 12.0 + height * height
        edges = [
            {
                "alpha": math.atan2(own, height),
                "p": math.sqrt(GRAVITY * math.hypot(own, height) / (square + own * own)),
                "restitution": (square - own * other) / (square + other * other),
            }
            for own, other in (sides, sides[::-1])
        ]
    else:
        own = {name: given[name] for name in ("alpha", "p", "restitution")}
        edges = [own, None if given.get("wall") else own]
    body: dict[str, Any] = {"equation": "slender" if given.get("slender") else "rigid", "gravity": GRAVITY}
    if "height" in given:
        body["geometry"] = given
    return body | {"edges": dict(zip(("right", "left"), edges, strict=True))}


def _groups(name: str, peak: float, period: float, body: dict[str, Any]) -> dict[str, Any]:
    alpha, slender = body["alpha"], body["slender"]
    return {
        "pulse": name,
        "slenderness": GRAVITY * (alpha if slender else math.tan(alpha)) / peak,
        "frequency_ratio": 2.0 * math.pi / (period * body["p"]),
        "restitution": body["restitution"],
        "alpha": None if slender else alpha,
    }


def _lowest_overturning(name: str, period: float, body: dict[str, Any]) -> float:
    """The lowest overturning a_g [m/s2] of a block that overturns from it on: by bisection."""
    low, high = GRAVITY * body["alpha"], 2.0 * GRAVITY * body["alpha"]
    while high - low > 1e-12 * high:
        middle = 0.5 * (low + high)
        response, _ = integrate_with_conditioning(**_groups(name, middle, period, body))
        low, high = (low, middle) if response.overturned else (middle, high)
    return high


def _samples(seed: int, count: int, step: float, peak: float, vertical: float) -> dict[str, Any]:
    """Smoothed noise, to a tenth of a mm/s2; `vertical`: the largest vertical acceleration over the horizontal one."""
    random = np.random.default_rng(seed)

    def series(largest: float) -> list[float]:
        raw = np.convolve(random.standard_normal(count), np.hanning(9), "same") * np.hanning(count)
        return [round(value, 4) for value in (raw * (largest / np.abs(raw).max())).tolist()]

    horizontal = series(peak)
    return {
        "kind": "samples",
        "time_step": step,
        "horizontal": horizontal,
        "vertical": series(vertical * peak) if vertical else None,
    }


def _record_groups(motion: dict[str, Any], body: dict[str, Any]) -> dict[str, Any]:
    right, left = body["edges"]["right"], body["edges"]["left"]
    rigid = body["equation"] == "rigid"
    alpha, vertical = right["alpha"], motion["vertical"]
    peak = max(map(abs, motion["horizontal"]))
    groups = {
        "acceleration": motion["horizontal"],
        "time_step": motion["time_step"],
        "frequency_parameter": right["p"],
        "slenderness": GRAVITY * (math.tan(alpha) if rigid else alpha) / peak,
        "restitution": right["restitution"],
        "alpha": alpha if rigid else None,
        "vertical": None if vertical is None else [value / GRAVITY for value in vertical],
    }
    if left is None:
        return groups | {"one_sided": True}
    return groups | {"left": Edge(left["alpha"] / alpha, (left["p"] / right["p"]) ** 2, left["restitution"])}


def _impact_times(rotation: arb, alpha: float, p: float, restitution: float, slender: bool = False) -> Iterator[arb]:
    """Times [s] of the first impacts of a block that is released at rest.

    The time to theta = 0 is acosh(1/(1 - z))/p for the slender block, z = theta/alpha. The rigid one is a pendulum
    about alpha: (K(m) - F(asin(cos(alpha/2)/cos(phi/2)), m))/p, phi = alpha - theta, m = cos^2(phi/2). The energy
    (w^2) at an impact is multiplied by restitution^2.
    """
    a, eta, rate = arb(alpha), arb(restitution), arb(p)
    time, theta = arb(0), rotation
    for count in range(FREE_IMPACTS):
        if slender:
            quarter = (1 / (1 - theta / a)).acosh()
            after = a - a * (1 - eta**2 * (1 - (1 - theta / a) ** 2)).sqrt()
        else:
            half = (a - theta) / 2
            m = half.cos() ** 2
            angle = ((a / 2).cos() / half.cos()).asin()
            quarter = (acb.elliptic_k(acb(m)) - acb.elliptic_f(acb(angle), acb(m))).real
            energy = eta**2 * ((a - theta).cos() - a.cos())
            after = a - (a.cos() + energy).acos()
        time += quarter if count == 0 else 2 * quarter
        yield time / rate
        theta = after


def _answer(response: ExactResponse, p: float) -> dict[str, Any]:
    found: dict[str, Any] = {"outcome": OUTCOMES[response.outcome]}
    if response.peak_rotation is not None and response.outcome == 1:
        found["peak_rotation"] = _digits(response.peak_rotation)
    if response.uplift_time is not None:
        found["uplift_time"] = _digits(response.uplift_time / p)
    if response.first_impact_time is not None:
        found["first_impact_time"] = _digits((response.uplift_time + response.first_impact_time) / p)
    return found


def _digits(value: arb) -> str:
    return str(value.str(DIGITS + 3, radius=False))


def main() -> None:
    """Write the files."""
    for number, problem in enumerate(problems(), start=1):
        words = problem["title"].replace(":", "").replace(",", "").lower().split()
        name = f"{number:02d}-{problem['body']['equation']}-{'-'.join(words)}"
        text = json.dumps({"id": name} | problem, indent=1)
        (FOLDER / f"{name}.json").write_text(text + "\n")
        sys.stderr.write(f"{name}: {problem['answer']}, {problem['digits']} digits\n")


if __name__ == "__main__":
    main()
