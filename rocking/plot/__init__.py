"""Pictures of responses, histories, spectra, boundaries, maps, cubes and fragility, drawn with matplotlib.

Each function draws one picture on the axes `ax`, or without them on those of a new figure, and returns the axes.
`style` are properties of its line, such as `color` and `label`. Axes carry names and units; colours are distinct to
colour-blind readers. Nothing here changes the settings of matplotlib; `matplotlib.rc_context(rocking.plot.STYLE)` gives
the settings of the figures of the workflow. Requires the extra `plot`. The names are listed in `__init__.pyi` and
loaded at first use.
"""

from importlib.util import find_spec as _find_spec

import lazy_loader

if _find_spec("matplotlib") is None:
    raise ModuleNotFoundError(
        "no module matplotlib: rocking.plot needs the extra `plot`, pip install 'rocking[plot]'", name="matplotlib"
    )

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
