"""Probability that an uncertain body overturns, and the input that matters most."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.extension import (
    RESTITUTION,
    Array,
    EqualByValue,
    InvalidArgumentError,
    Scalar,
    StopFlag,
    impact_share,
    integer,
    number,
    variable,
)
from rocking_assessment._objects.assess import CONFIDENCE
from rocking_assessment._objects.objects import Bodies, signed_restitution
from rocking_assessment._objects.search import overturned_by
from rocking_assessment._objects.site import Site

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

REPLICATES = 8  # independent scramblings of the quasi-random points, whose scatter gives the interval [-]
NAMES = ("width", "height", "mass_height", "offset", "restitution")  # inputs that may be uncertain


@dataclass(frozen=True, eq=False)
class OverturningProbability(EqualByValue):
    """Probability of overturning over the distributions of the inputs.

    Attributes
    ----------
    probability : float [-]
        That a motion of the site, each equally likely, overturns the body.
    interval : (float, float) [-]
        95 % interval of this number, which the number of samples makes.
    first_order : mapping of str to float [-]
        First-order Sobol index of each uncertain input: the share of the variance that its value alone explains; nan
        where the outcome does not vary.
    samples : int
        Bodies that were solved for the probability.
    """

    probability: float
    interval: tuple[float, float]
    first_order: Mapping[str, float]
    samples: int

    def to_xarray(self) -> xr.Dataset:
        """The numbers as a data set; the indices over `input`, the interval over `end`."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

        indices, index = [*self.first_order.values()], "first-order Sobol index"
        variables: dict[str, Any] = {
            "probability": variable((), self.probability, "1", "probability of overturning"),
            "interval": variable("end", [*self.interval], "1", "95 % interval of the probability"),
            "first_order": variable("input", np.array(indices, dtype=float), "1", index),
            "samples": variable((), self.samples, "1", "bodies that were solved for the probability"),
        }
        return xr.Dataset(variables, {"input": [*self.first_order], "end": ["lower", "upper"]})

    def to_pandas(self) -> pd.Series:
        """The numbers as a series; the indices are named `first_order_` and the input."""
        import pandas as pd  # noqa: PLC0415  (takes longer to load than the package)

        indices = {f"first_order_{name}": value for name, value in self.first_order.items()}
        ends = dict(zip(("lower", "upper"), self.interval, strict=True))
        return pd.Series({"probability": self.probability, **ends, **indices, "samples": self.samples}, dtype=float)

    def __repr__(self) -> str:
        """The probability, its interval and the most important input."""
        low, high = self.interval
        text = f"<rocking.OverturningProbability {self.probability:.4g}, from {low:.4g} to {high:.4g}"
        indices = {name: index for name, index in self.first_order.items() if not math.isnan(index)}
        if indices:
            text += f"; {max(indices, key=indices.__getitem__)} matters most"
        return f"{text}>"


def overturning_probability(
    site: Site,
    *,
    width: Any,
    height: Any,
    mass_height: Any = None,
    offset: Any = 0.0,
    restitution: Any = "momentum",
    samples: Scalar = 8192,
    seed: Scalar = 0,
    stop: StopFlag | None = None,
) -> OverturningProbability:
    """Probability that the motions of a site overturn a body with uncertain dimensions.

    Parameters
    ----------
    site : Site
        The ground motions, at their strength.
    width, height, mass_height, offset : float or scipy.stats distribution
        As of `rocking_assessment.Object`, in one direction [m]; a frozen distribution such as
        `scipy.stats.norm(0.4, 0.01)`. Without a height of the centre of mass it is half the height.
    restitution : "momentum", "kalliontzis(k=...)", float or distribution
        eta [-]; values of a distribution are limited to [0, 1].
    samples : int
        Bodies, rounded up to 8 times a power of two, 64 to 4,194,304; the Sobol indices need as many again for each
        uncertain input.
    seed : int
        0 to 2^53, of the scrambled Sobol sequence.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Raises
    ------
    InvalidArgumentError
        If no input is uncertain, an argument is not as described, or a distribution gives no possible body.
    """
    from scipy import stats  # noqa: PLC0415  (takes longer to load than the package)

    inputs = dict(zip(NAMES, (width, height, mass_height, offset, restitution), strict=True))
    uncertain = {name: value for name, value in inputs.items() if hasattr(value, "ppf")}
    for name in inputs.keys() - uncertain.keys():
        value = inputs[name]
        if name == "restitution":
            inputs[name] = value if impact_share(value) is not None else RESTITUTION.number(value)
        elif value is not None:
            low = -math.inf if name == "offset" else 0.0
            inputs[name] = number(name, value, low, math.inf, closed="neither", unit="m")
    if not uncertain:
        raise InvalidArgumentError("width", width, "a distribution of scipy.stats for at least one input")
    size = 2 ** math.ceil(math.log2(integer("samples", samples, 64, 2**22) / REPLICATES))  # bodies of a scrambling
    motions = site.motions

    def share(values: Array) -> Array:
        """Share of the motions that overturns each body; values (inputs, bodies)."""
        sampled = inputs | dict(zip(uncertain, values, strict=True))
        hits = [overturned_by(_body(sampled, values.shape[1]), motion, stop) for motion in motions]
        return np.asarray(np.mean(hits, axis=0))

    streams = np.random.default_rng(integer("seed", seed, 0, 2**53)).spawn(REPLICATES + 1)
    means = []
    for stream in streams[1:]:
        points = stats.qmc.Sobol(len(uncertain), rng=stream).random(size)
        pairs = zip(uncertain.values(), points.T, strict=True)
        means.append(share(np.stack([distribution.ppf(u) for distribution, u in pairs])).mean())
    middle = float(np.mean(means))
    half = float(stats.t.ppf(0.5 + 0.5 * CONFIDENCE, REPLICATES - 1) * np.std(means, ddof=1) / math.sqrt(REPLICATES))
    half = max(half, 1.0 / size)  # one body of each scrambling, which may agree by chance
    first = np.full(len(uncertain), 1.0 if 0.0 < middle < 1.0 else np.nan)  # 1: a single input explains everything
    if 0.0 < middle < 1.0 and len(uncertain) > 1:
        indices = stats.sobol_indices(func=share, n=size, dists=list(uncertain.values()), rng=streams[0])
        first = np.ravel(indices.first_order)
    interval = max(middle - half, 0.0), min(middle + half, 1.0)
    first_order = dict(zip(uncertain, first.tolist(), strict=True))
    return OverturningProbability(middle, interval, first_order, size * REPLICATES)


def _body(values: Mapping[str, Any], size: int) -> Any:
    """The bodies of sampled values."""
    width, height, offset = (
        np.broadcast_to(np.asarray(values[name], float), size) for name in ("width", "height", "offset")
    )
    centre = 0.5 * height
    if values["mass_height"] is not None:
        centre = np.broadcast_to(np.asarray(values["mass_height"]), size)
    possible = (width > 0.0) & (height > 0.0) & (centre > 0.0) & (np.abs(offset) < 0.5 * width)
    if not possible.all():
        k = int(np.flatnonzero(~possible)[0])
        wrong = f"width {width[k]:.3g}, height {height[k]:.3g}, centre of mass {centre[k]:.3g}, offset {offset[k]:.3g}"
        raise InvalidArgumentError(
            "width",
            wrong,
            "distributions that hold possible bodies only: truncate them, for instance by scipy.stats.truncnorm",
        )
    eta = values["restitution"]
    if impact_share(eta) is not None:
        restitution = np.full(size, signed_restitution(eta))
    else:
        restitution = np.clip(np.broadcast_to(np.asarray(eta, float), size), 0.0, 1.0)
    ones, zeros, unknown = np.ones(size), np.zeros(size), np.full(size, np.nan)
    return Bodies(
        width,
        offset,
        height,
        centre,
        base_share=ones,
        inertia=ones,
        side=zeros,
        rebound=unknown,
        restitution=restitution,
    ).scaled()
