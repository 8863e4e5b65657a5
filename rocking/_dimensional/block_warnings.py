"""Warnings that do not depend on the kind of ground motion, in the order in which every assessment gives them."""

from __future__ import annotations

from collections.abc import Iterable

from rocking._dimensional.threshold import Threshold
from rocking._model.block import AbstractBlock
from rocking._model.outcome import Outcome

MARGIN = 0.05
"""Relative distance of a change of outcome below which a warning is given [-]: ground motions are not known better."""

NOT_FOUND = "the {} at which the outcome changes were not found in time: such a block has too many impacts"


def warnings_of_block(block: AbstractBlock, restitution: float | str, outcome: Outcome) -> list[str]:
    """Where restitution or shape of a block make its rocking doubtful."""
    texts = []
    if restitution == "momentum" and block.momentum_restitution < 0.0 and outcome != Outcome.NO_UPLIFT:
        texts.append(
            f"the restitution (2.4) of this shape is negative ({block.momentum_restitution:.3g}): the block stops "
            "at an impact, eta = 0; give a number for another restitution"
        )
    if not block.contact_is_known:
        texts.append("the contact forces of this structure are not known: sliding is not assessed")
    elif block.half_width > block.half_height:
        texts.append("the block is wider than high: it would rather slide or bounce than rock")
    return texts


def warnings_of_changes(given: float, changes: Iterable[Threshold], name: str, unit: str = "") -> list[str]:
    """That the outcome changes close to the value that is given."""
    near = ", ".join(one.text() for one in changes if abs(one.value / given - 1.0) < MARGIN)
    return [f"the outcome changes within {100 * MARGIN:g} % of this {name}: at {near}{unit}"] if near else []
