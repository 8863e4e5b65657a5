"""Response spectra and overturning of the rocking rigid block under pulse ground motion.

The public names are listed by hand in `__init__.pyi` and loaded when first used: a command or a service worker does not
pay for what it does not touch.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
