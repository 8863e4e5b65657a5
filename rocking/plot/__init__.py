"""Pictures of responses, histories, spectra, boundaries, maps, cubes and fragility, drawn with matplotlib.

Each function draws one picture on given axes, or on those of a new figure, and returns the axes. Axes carry names and
units; colours are distinct to colour-blind readers. Nothing here changes the settings of matplotlib;
`matplotlib.rc_context(rocking.plot.STYLE)` gives the settings of the figures of the workflow. Requires the extra
`plot`.
"""

from importlib.util import find_spec as _find_spec

if _find_spec("matplotlib") is None:
    raise ModuleNotFoundError(
        "no module matplotlib: rocking.plot needs the extra `plot`, pip install 'rocking[plot]'", name="matplotlib"
    )

from rocking.plot.boundary import boundary
from rocking.plot.control_map import control_map, cube
from rocking.plot.fragility import fragility
from rocking.plot.history import ground_acceleration, history
from rocking.plot.response import response
from rocking.plot.spectrum import spectrum
from rocking.plot.style import STYLE

__all__ = [
    "STYLE",
    "boundary",
    "control_map",
    "cube",
    "fragility",
    "ground_acceleration",
    "history",
    "response",
    "spectrum",
]
