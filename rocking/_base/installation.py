"""The installed package: version and authors, which pyproject.toml states, and what its extras need."""

from importlib.metadata import metadata
from importlib.util import find_spec

_ABOUT = metadata("rocking")

__version__ = _ABOUT["Version"]

AUTHORS = _ABOUT["Author"]


def require_extra(extra: str, *modules: str) -> None:
    """Check that the modules of an extra are installed.

    Parameters
    ----------
    extra : str
        Name of the extra in pyproject.toml.
    *modules : str
        Top-level modules that it installs.

    Raises
    ------
    ModuleNotFoundError
        If one is missing; the message says which extra to install.
    """
    for module in modules:
        if find_spec(module) is None:
            raise ModuleNotFoundError(
                f"no module {module}: install the extra `{extra}`, pip install 'rocking[{extra}]'", name=module
            )
