"""
A body of your own
===================

How does a block with crushed corners rock? It turns about points inside its base. Any rigid body that rocks on two
edges is a ``RigidBody``: state where the edges are below its centre of mass, and its radius of gyration.
"""

import matplotlib.pyplot as plt
import numpy as np

import rocking

width, height = 0.5, 2.0  # m
gyration = np.hypot(width, height) / np.sqrt(12.0)  # of the whole rectangle
periods = np.linspace(0.5, 2.0, 60)  # s

figure, ax = plt.subplots(layout="constrained")
for crushed, colour in ((0.0, "#000000"), (0.03, "#0072B2"), (0.06, "#D55E00")):
    edge = width / 2.0 - crushed
    block = rocking.RigidBody(left=edge, right=edge, height=height / 2.0, gyration=gyration)
    print(f"crushed by {100 * crushed:g} cm: restitution {block.right.restitution:.3f}")
    lowest = block.thresholds("sine", period=periods).lowest
    ax.plot(periods, lowest, color=colour, label=f"{100 * crushed:g} cm")
ax.set(xlabel="period of the sine [s]", ylabel="lowest peak acceleration that overturns [m/s²]")
ax.legend(title="crushed by")
plt.show()
