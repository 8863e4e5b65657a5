"""Figure 11: blocks of different shape at a moderate slenderness group."""

from workflow.figures.similar_histories import data, draw

__all__ = ["data", "draw"]
