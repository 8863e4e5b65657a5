"""Names for packages that extend `rocking`, such as `rocking_assessment`.

An extension imports public names of `rocking` and the names listed in `extension.pyi`, which are loaded at first use:
arrays, units and quantities, argument checks, motions, bodies and their responses, searches for thresholds, tables of
bodies, statistics of suites, and what the commands share. `docs/architecture.md` says how a package adds commands,
routes, pages and kinds of bodies through entry points.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub("rocking", __file__)
