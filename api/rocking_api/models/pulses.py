"""A pulse given by samples in a JSON body, in place of a name: the models of bodies derive from those of queries."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    PlainSerializer,
    Tag,
    computed_field,
    create_model,
)

from rocking._excitation.sampled import SampledPulse
from rocking_api.models.params import Params
from rocking_api.models.quantity import PulseName, said

P = TypeVar("P", bound=Params)

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


GivenPulse = Annotated[
    Annotated[PulseName, Tag("name")] | Annotated[PulseSamples, AfterValidator(_made), Tag("samples")],
    Discriminator(lambda value: "name" if isinstance(value, str) else "samples"),
    PlainSerializer(lambda pulse: pulse if isinstance(pulse, str) else pulse.name, return_type=str),
    said("a pulse by its name, or by samples"),
]


def sampled_pulse(params: Params) -> SampledPulse | None:
    """The pulse of some parameters if it is given by samples."""
    pulse = getattr(params, "pulse", None)
    return pulse if isinstance(pulse, SampledPulse) else None


class _WithDigest(Params):
    """What a response repeats of a pulse given by samples, beside its name."""

    @computed_field(description="sha256 of the samples; null for a pulse by its name")  # type: ignore[prop-decorator]
    @property
    def pulse_digest(self) -> str | None:
        pulse = sampled_pulse(self)
        return None if pulse is None else pulse.digest


@cache
def with_samples(kind: type[P]) -> type[P]:
    """The model of a body with the fields of `kind`, whose pulse may be given by samples: a `SampledPulse` then."""
    bases: Any = (_WithDigest, kind)
    model: type[P] = create_model(
        f"{kind.__name__}WithSamples",
        __base__=bases,
        __doc__=f"{kind.__doc__} The pulse has a name, or is given by samples.",
        pulse=(GivenPulse, ...),
    )
    return model


def options_of(found: Params, kind: type[P]) -> P:
    """The fields of `kind` of a body that was validated, with the digest of a pulse that is given by samples."""
    own = kind if sampled_pulse(found) is None else with_samples(kind)
    return own.model_construct(**{name: getattr(found, name) for name in kind.model_fields})
