"""Assessment of free-standing objects: which of them the ground motions of a site overturn, and what evidence says.

Objects at a site: `Object`, `read_objects`, `Site`, `assess`, `overturning_probability`; `body_from_mesh`.
Measurements and old rocks: `identify_free_rocking`, `calibrate`, `survival`, `unexceeded`.
Hazard and loss: `read_hazard`, `annual_rate`, `write_nrml`, `write_pelicun`. Checks by standards: `standards`.

>>> import rocking_assessment
>>> vase = rocking_assessment.Object("vase", width="20 cm", height="60 cm")
>>> site = rocking_assessment.Site(pga="0.4 g", pgv="0.5 m/s")
>>> rocking_assessment.assess(vase, site).rows[0]["verdict"]
'overturns in most'

The package is an application of `rocking`; its dependencies come with `pip install "rocking[assessment]"`. It adds the
commands `rocking assess` and `rocking identify`, and routes and pages to the HTTP service. The public names are listed
in `__init__.pyi` and loaded at first use. Units, arguments and errors are those of `rocking`.
"""

import lazy_loader

from rocking.extension import require_extra

require_extra("assessment", "trimesh", "jinja2")

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
