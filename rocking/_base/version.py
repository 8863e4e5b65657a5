"""The version of the installed package; pyproject.toml is the one place that states it."""

from importlib.metadata import version

__version__ = version("rocking")
