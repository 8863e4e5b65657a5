"""JSON bodies whose pulse may be given by samples: they derive from the models of queries."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    PlainSerializer,
    Tag,
    computed_field,
)

from rocking._excitation.sampled import SampledPulse
from rocking_api.models.params import (
    BatchParams,
    HistoryParams,
    MapParams,
    OverturningParams,
    Params,
    SpectrumParams,
    ThresholdsParams,
)
from rocking_api.models.quantity import PulseName, said

MAX_SAMPLES = 10_000  # most samples of a pulse over HTTP [-]: some milliseconds for the parser, and for each block
MAX_BODY = 500_000  # largest body with the samples of a pulse [bytes]: as many times and accelerations of all digits

Samples = Annotated[list[float], Field(min_length=2, max_length=MAX_SAMPLES, fail_fast=True)]


class PulseSamples(BaseModel):
    """A pulse of any shape: linear between samples, zero outside, scaled to the peak 1."""

    model_config = ConfigDict(extra="forbid")

    acceleration: Samples = said("ground acceleration at the samples, in any unit")
    time: Samples | None = said("their times, ascending, in any unit; absent: equidistant", None)
    period: float | None = said("T_p in the unit of the times; absent: the time from first to last sample", None)
    name: str = said("name that the response repeats", "sampled", min_length=1, max_length=200)


def _made(samples: PulseSamples) -> SampledPulse:
    return SampledPulse(**dict(samples))


def name_of(pulse: Any) -> str:
    """The name that an answer repeats of a pulse."""
    return str(pulse.name if isinstance(pulse, SampledPulse) else pulse)


GivenPulse: Any = Annotated[
    Annotated[PulseName, Tag("<name>")] | Annotated[PulseSamples, AfterValidator(_made), Tag("<samples>")],
    Discriminator(lambda value: "<name>" if isinstance(value, str) else "<samples>"),
    PlainSerializer(name_of, return_type=str),
    said("a pulse by its name, or by samples"),
]


def digest_of(pulse: Any) -> str | None:
    """The sha256 of the samples of a pulse; None for a pulse by its name."""
    return pulse.digest if isinstance(pulse, SampledPulse) else None


class PulseBody(Params):
    """A JSON body whose pulse has a name, or is given by samples."""

    pulse: GivenPulse

    @computed_field(description="sha256 of the samples; null for a pulse by its name")  # type: ignore[prop-decorator]
    @property
    def pulse_digest(self) -> str | None:
        return digest_of(self.pulse)


class SpectrumBody(PulseBody, SpectrumParams):
    """The parameters of /v1/spectrum."""


class HistoryBody(PulseBody, HistoryParams):
    """The parameters of /v1/history."""


class ThresholdsBody(PulseBody, ThresholdsParams):
    """The parameters of /v1/thresholds."""


class MapBody(PulseBody, MapParams):
    """The parameters of /v1/map."""


class OverturningBody(PulseBody, OverturningParams):
    """The parameters of /v1/overturning."""


class BatchBody(PulseBody, BatchParams):
    """Many blocks: numbers, or arrays of one length."""
