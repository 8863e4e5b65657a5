"""
A body of one's own
===================

A kind of body states its two edges, and has all responses. Here a block that turns about points inside its base.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

from rocking._dimensional.body import RespondingBody
from rocking._model.body import Edge, rigid_edge


@dataclass(frozen=True)
class CrushedBlock(RespondingBody):
    b: float  # half width [m]
    h: float  # half height [m]
    crushed: float  # distance of the pivots from the corners [m]
    gravity: float = 9.80665
    top_height: float = 2.0
    description: str = "block with crushed corners"

    @property
    def right(self) -> Edge:
        gyration = np.hypot(self.b, self.h) / np.sqrt(3.0)
        return rigid_edge(self.b - self.crushed, self.b - self.crushed, self.h, gyration, self.gravity, 0.0)

    left = right


for crushed in (0.0, 0.03, 0.06):
    block = CrushedBlock(0.25, 1.0, crushed)
    periods = np.linspace(0.5, 2.0, 60)
    plt.plot(periods, block.thresholds("sine", period=periods).lowest, label=f"crushed by {100 * crushed:g} cm")
plt.gca().set(xlabel="period of the sine [s]", ylabel="lowest acceleration that overturns [m/s²]")
plt.legend()
plt.show()
