"""The final outcome of a block, and the code of the way in which it overturns."""

from enum import IntEnum


class Outcome(IntEnum):
    """Final outcome of a block. A block that passes theta = alpha need not overturn: the ground can bring it back."""

    NO_UPLIFT = 0
    RECOVERS = 1
    OVERTURNED_DIRECTLY = 2
    OVERTURNED_AFTER_IMPACT = 3

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject."""
        return _SENTENCES[self]

    @property
    def plural(self) -> str:
        """The outcome of several blocks in words."""
        return _PLURALS[self]


_SENTENCES = {
    Outcome.NO_UPLIFT: "never uplifts",
    Outcome.RECOVERS: "rocks and comes to rest",
    Outcome.OVERTURNED_DIRECTLY: "overturns without impact",
    Outcome.OVERTURNED_AFTER_IMPACT: "overturns after one or more impacts",
}

_PLURALS = {
    Outcome.NO_UPLIFT: "never uplift",
    Outcome.RECOVERS: "rock and come to rest",
    Outcome.OVERTURNED_DIRECTLY: "overturn without impact",
    Outcome.OVERTURNED_AFTER_IMPACT: "overturn after one or more impacts",
}
