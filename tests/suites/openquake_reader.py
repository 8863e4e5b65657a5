"""A fragility model as OpenQuake's own reader reads it: `python -m tests.suites.openquake_reader FILE LEVEL ...`.

Writes JSON: probabilities at the levels by function and limit state. Runs in a process of its own: packages that the
reader imports and does not use are stubbed where they are absent.
"""

import importlib.abc
import importlib.machinery
import importlib.util
import json
import sys
import tomllib
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np

UNUSED = {"alpha_shapes", "decorator", "fiona", "h3", "psutil", "pyproj", "rtree", "shapely", "zmq"}


class Stubs(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Stands for packages that are not used."""

    def find_spec(self, name, *_):
        if name.partition(".")[0] not in UNUSED:
            return None
        return importlib.machinery.ModuleSpec(name, self, is_package=True)

    def create_module(self, spec):
        return MagicMock(name=spec.name, __path__=[], __spec__=spec)

    def exec_module(self, module):
        pass


def main() -> None:
    """Command line."""
    file, *levels = sys.argv[1:]
    sys.meta_path.append(Stubs())
    if importlib.util.find_spec("toml") is None:
        sys.modules["toml"] = SimpleNamespace(loads=tomllib.loads, dumps=str)
    importlib.import_module("openquake.risklib.read_nrml")  # registers the reader
    model = importlib.import_module("openquake.hazardlib.nrml").to_python(file)
    im = np.array(levels, dtype=float)
    curves = {
        f"{name} {one.limit_state}": one(im).tolist()
        for (_, name), functions in model.items()
        for one in functions.build(model.limitStates)
    }
    sys.stdout.write(json.dumps(curves))


if __name__ == "__main__":
    main()
