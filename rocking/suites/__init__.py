"""Suites of recorded motions: fragility, sensitivity, and pulses fitted to records.

The names are listed in `__init__.pyi` and loaded at first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
