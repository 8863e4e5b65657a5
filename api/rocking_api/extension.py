"""What other packages add to the service: routes, pages with their templates and scripts.

A package declares an entry point of the group `rocking.service` whose object is an `Extension`. The application reads
them when it is made.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path

from fastapi import APIRouter

from rocking_api.http.limits import Limit
from rocking_api.settings import Settings

LOG = logging.getLogger("rocking.service")

GROUP = "rocking.service"


def _always(_: Settings) -> bool:
    return True


@dataclass(frozen=True)
class MenuEntry:
    """A page in the navigation.

    Parameters
    ----------
    path : str
        Address of the page.
    label : str
        Its word in the navigation.
    exists : callable
        Whether the page has something to show with the settings of the service.
    """

    path: str
    label: str
    exists: Callable[[Settings], bool] = _always


@dataclass(frozen=True)
class Extension:
    """What a package adds.

    Parameters
    ----------
    name : str
        Its static files are served under `/static/NAME/`.
    routers : tuple of APIRouter
        Routes and pages.
    menu : tuple of MenuEntry
        Entries of the navigation, after the first page.
    templates : Path, optional
        Folder of Jinja templates; they may extend `base.html` of the service.
    static : Path, optional
        Folder of scripts, styles and other files.
    body_limits : mapping, optional
        Largest bodies of its routes, by the start of their addresses; others have that of the service, 0.5 MB.
    """

    name: str
    routers: tuple[APIRouter, ...]
    menu: tuple[MenuEntry, ...] = ()
    templates: Path | None = None
    static: Path | None = None
    body_limits: Mapping[str, Limit] = field(default_factory=dict)


@cache
def extensions() -> tuple[Extension, ...]:
    """Return what installed packages add; a package whose dependencies are not installed adds nothing."""
    loaded = []
    for entry_point in entry_points(group=GROUP):
        try:
            loaded.append(entry_point.load())
        except ModuleNotFoundError as error:
            LOG.info("%s adds nothing to the service: %s", entry_point.name, error)
    return tuple(loaded)
