"""The fields of a response, declared once: name, type, unit, equation, meaning, missing value.

The record of the solver, `Response`, the variables of the data sets, the models of the HTTP service, the columns of CSV
and netCDF responses and the table in docs/notation.md derive from these declarations; tests compare the annotated
classes with them.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from inspect import cleandoc
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._model.energy import residual_energy
from rocking._model.outcome import Outcome

KINDS = frozenset({"pulse", "record", "block", "edges"})
"""Kinds of responses in SI units: by the motion; by whether the body moves as a rectangular block."""


@dataclass(frozen=True)
class ResponseField:
    """A quantity of a response."""

    name: str  # name of the attribute, variable or column
    dtype: str  # type code of numpy in memory
    unit: str  # as CF writes it; "1" for a number
    equation: str  # number of the equation of the paper that it comes from
    meaning: str  # in a few words, without a capital or a full stop
    # where there is no value, as a clause that follows "where"; empty if there always is one. A missing number is nan
    # in memory and in files, null in JSON, and empty in CSV
    missing: str = ""
    detail: str = ""  # what else has to be known; empty if nothing
    at_rest: float = 0.0  # value of a block that does not uplift
    # computes the field from other fields and the groups, both arrays by name, which broadcast, the motion, and the
    # body in SI units. Groups that a response does not know are not there; motion and body are None then. None: the
    # solver computes it, or it is an argument or a property of the body
    derive: Callable[[Mapping[str, Any], Mapping[str, Any], Any, Any], Any] | None = None
    kinds: frozenset[str] = KINDS  # kinds of responses in SI units that have it, see `KINDS`
    # its name on the command line and over HTTP, where it differs; angles are in degrees there, with the ending _deg
    shown: str = ""

    @cached_property
    def label(self) -> str:
        """Its name on the command line and over HTTP."""
        return self.shown or (f"{self.name}_deg" if self.unit == "rad" else self.name)

    @property
    def label_unit(self) -> str:
        """Its unit there."""
        return {"rad": "deg", "rad s-1": "rad/s", "m s-2": "m/s2", "1": "-"}.get(self.unit, self.unit)

    @property
    def file_dtype(self) -> str:
        """Type code in files, which have no truth values."""
        return "i1" if self.dtype == "?" else self.dtype

    @property
    def flags(self) -> dict[str, Any]:
        """CF attributes of the codes of a field, empty for a number."""
        if self.name == "outcome":
            return {
                "flag_values": np.array([int(outcome) for outcome in Outcome], dtype=np.int8),
                "flag_meanings": " ".join(outcome.name.lower() for outcome in Outcome),
            }
        return {"flag_values": np.array([0, 1], dtype=np.int8), "flag_meanings": "no yes"} if self.dtype == "?" else {}

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes of the variable in a data set, without the unit: long_name, equation, comment, flags."""
        remarks = [f"missing where {self.missing}"] if self.missing else []
        comment = "; ".join([*remarks, *([self.detail] if self.detail else [])])
        return {"long_name": self.meaning, "equation": self.equation, **({"comment": comment} if comment else {})} | (
            self.flags
        )

    def variable(self, dims: Any, values: Any) -> tuple[Any, Any, dict[str, Any]]:
        """The variable of a data set."""
        return dims, values, {"units": self.unit} | self.attributes

    def description(self, missing: str = "null", unit: str = "") -> str:
        """One line with meaning, unit, by default that of the field, and what stands for a missing number."""
        named = unit or ("-" if self.unit == "1" else self.unit)
        unit = "" if self.flags or self.dtype in ("?", "U") else f" [{named}]"
        remarks = [f"{missing} where {self.missing}"] if self.missing else []
        return "; ".join([self.meaning + unit, *remarks, *([self.detail] if self.detail else [])])


PEAK_ROTATION = ResponseField(
    "peak_rotation",
    "f8",
    "1",
    "3.2",
    "peak of |theta|/alpha",
    "the block overturns",
    "over the whole response; 0 without uplift",
)
OUTCOME = ResponseField("outcome", "i1", "1", "3.8", "final outcome")
IMPACTS = ResponseField(
    "impacts",
    "i4",
    "1",
    "2.3",
    "number of impacts",
    "",
    "before the pulse ends, and the one after it that is followed by overturning; impacts that chatter sums up are not "
    "counted",
)
CHATTER = ResponseField("chatter", "?", "1", "2.3", "whether impacts accumulate to rest while the pulse acts")
EXCEEDED_ALPHA = ResponseField("exceeded_alpha", "?", "1", "3.2", "whether |theta| passed alpha at some time")
UPLIFT_TIME = ResponseField(
    "uplift_time",
    "f8",
    "1",
    "3.3",
    "time p t from the start of the pulse to the first uplift",
    "there is no uplift",
    at_rest=math.nan,
)
FIRST_IMPACT_TIME = ResponseField(
    "first_impact_time",
    "f8",
    "1",
    "3.21",
    "time p t from the uplift to the first impact",
    "there is none while the pulse acts",
    at_rest=math.nan,
)
FIRST_IMPACT_VELOCITY = ResponseField(
    "first_impact_velocity",
    "f8",
    "1",
    "3.22",
    "angular velocity theta'/(p alpha) just before the first impact",
    "there is none while the pulse acts",
    at_rest=math.nan,
)
PEAK_MODE = ResponseField(
    "peak_mode",
    "i4",
    "1",
    "3.4",
    "arc on which the peak is reached",
    "",
    "the peak is a smooth function of the groups where this number is the same: twice the impacts before it since the "
    "last uplift from rest, plus one if reached in free rocking, plus 65536 for each such uplift after the first; -1 "
    "where there is no peak",
    at_rest=-1,
)
END_ROTATION = ResponseField(
    "end_rotation", "f8", "1", "3.11", "rotation |theta|/alpha when the pulse ends, or when overturning is certain"
)
END_VELOCITY = ResponseField("end_velocity", "f8", "1", "3.11", "rate of |theta|/alpha with respect to p t then")
RESIDUAL_ENERGY = ResponseField(
    "residual_energy",
    "f8",
    "1",
    "3.11",
    "kinetic and potential energy at the end of the pulse over that of the unstable equilibrium at alpha",
    "it is interpolated in a data set, or the angle alpha is not known",
    "both from the energy at rest; where overturning is certain earlier, the energy then",
    derive=residual_energy,
)

OVERTURNED = ResponseField("overturned", "?", "1", "3.8", "whether the block overturns")
ERROR_BOUND = ResponseField(
    "error_bound",
    "f8",
    "1",
    "3.2",
    "bound of the absolute error of peak_rotation",
    "the block overturns",
    "infinite where the outcome changes within the rounding of the parameters",
)
FROM_CUBE = ResponseField("from_cube", "?", "1", "3.2", "whether it is interpolated in a data set; else it is solved")
SOURCE = ResponseField("source", "U", "1", "3.2", "cube (interpolated data set) or solver")

SOLVED_FIELDS = (
    PEAK_ROTATION,
    OUTCOME,
    IMPACTS,
    CHATTER,
    EXCEEDED_ALPHA,
    UPLIFT_TIME,
    FIRST_IMPACT_TIME,
    FIRST_IMPACT_VELOCITY,
    PEAK_MODE,
    END_ROTATION,
    END_VELOCITY,
)
"""Fields of the record that the solver writes for each block."""

DERIVED_FIELDS = (RESIDUAL_ENERGY,)
"""Numbers that are computed from fields of a response when they are read, without a kernel."""

RESPONSE_FIELDS = (*SOLVED_FIELDS, *DERIVED_FIELDS)  # fields of `rocking.Response`, in order

BOUNDED_FIELDS = (PEAK_ROTATION, OUTCOME, IMPACTS, EXCEEDED_ALPHA, ERROR_BOUND, FROM_CUBE)
"""Fields of a response with an error bound, of an interpolated cube or of the solver."""

CUBE_FIELDS = (PEAK_ROTATION, OUTCOME, IMPACTS, EXCEEDED_ALPHA, PEAK_MODE)
"""Fields of a response that a spectrum cube stores; those of `DERIVED_FIELDS` on request."""

COLUMN_FIELDS = (PEAK_ROTATION, OVERTURNED, OUTCOME, IMPACTS, EXCEEDED_ALPHA, ERROR_BOUND, SOURCE, *DERIVED_FIELDS)


def record_dtype(fields: Sequence[ResponseField]) -> np.dtype[np.void]:
    """The record with these fields, for a kernel; larger types come first, so that there are no gaps between them."""
    ordered = sorted(fields, key=lambda field: -np.dtype(field.dtype).itemsize)
    return np.dtype([(field.name, field.dtype) for field in ordered], align=True)


@dataclass(frozen=True, eq=False, repr=False)
class ResponseFields:
    """Base of responses: the fields that all of them begin with, and a property for each of `DERIVED_FIELDS`.

    A subclass names its fields by `declared`; their descriptions replace {fields} in its docstring.
    """

    peak_rotation: NDArray[np.float64]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]

    if TYPE_CHECKING:

        @property
        def residual_energy(self) -> NDArray[np.float64]:
            """Energy at the end of the pulse over that of the unstable equilibrium at alpha [-]."""

    def __init_subclass__(cls, *, declared: Sequence[ResponseField] = ()) -> None:
        described = "\n".join(
            f"{field.name} : {np.dtype(field.dtype).name} array\n"
            + fill(f"{field.description('nan')}.", 108, initial_indent=" " * 4, subsequent_indent=" " * 4)
            for field in declared
        )
        # without the indentation of the source, which docstrings have up to Python 3.12 only
        cls.__doc__ = cleandoc(cls.__doc__ or "").replace("{fields}", described)

    @property
    def overturned(self) -> NDArray[np.bool_]:
        """Whether the block overturns in the end."""
        return np.asarray(self.outcome >= Outcome.OVERTURNED_DIRECTLY)

    def _derived(self, field: ResponseField) -> NDArray[Any]:
        """The values of a derived field."""
        raise NotImplementedError


def _property(field: ResponseField) -> property:
    def read(self: ResponseFields) -> NDArray[Any]:
        return self._derived(field)

    return property(read, doc=field.description("nan"))


for _field in DERIVED_FIELDS:
    setattr(ResponseFields, _field.name, _property(_field))
