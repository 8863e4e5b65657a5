"""Extras of the installation: packages that a part of the product needs beyond those of `rocking`."""

from importlib.util import find_spec


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
