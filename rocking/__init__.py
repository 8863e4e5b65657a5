"""Response spectra and overturning of the rocking rigid block under pulse ground motion.

The public names are listed in `__init__.pyi` and loaded at first use, so that a command or a worker of the service
imports only what it needs.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
