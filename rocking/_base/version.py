"""Version and authors of the installed package; pyproject.toml is the one place that states them."""

from importlib.metadata import metadata

_ABOUT = metadata("rocking")

__version__ = _ABOUT["Version"]

AUTHORS = _ABOUT["Author"]
