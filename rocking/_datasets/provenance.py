"""Digests of the settings from which a result was computed; `rocking._base.source_tree` has digests of its code.

A result depends on the modules that its script imports, directly or indirectly, and on the locked environment, so that
a change of a module affects only results that depend on it.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any


def settings_digest(settings: Mapping[str, Any]) -> str:
    """Return the sha256 (hex) of settings (numbers, strings, lists, mappings), whatever the order of their keys."""
    return hashlib.sha256(settings_text(settings).encode()).hexdigest()


def settings_text(settings: Mapping[str, Any]) -> str:
    """Return the settings as JSON with sorted keys, the text whose digest is `settings_digest`."""
    return json.dumps(settings, sort_keys=True)
