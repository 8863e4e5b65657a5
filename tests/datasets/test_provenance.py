"""Digests of settings change if and only if the settings do."""

from rocking._datasets.provenance import settings_digest


def test_settings_digest_ignores_order() -> None:
    assert settings_digest({"a": [1, 2], "b": 0.5}) == settings_digest({"b": 0.5, "a": [1, 2]})
    assert settings_digest({"a": [1, 2]}) != settings_digest({"a": [2, 1]})
