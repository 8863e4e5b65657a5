"""Figure 12: blocks of different shape that barely uplift, where only the groups of (6.1) make them similar."""

from workflow.figures.similar_histories import data, draw

__all__ = ["data", "draw"]
