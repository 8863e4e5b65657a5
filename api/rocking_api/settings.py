"""Settings of the service: from `rocking serve`, or environment variables ROCKING_RESULTS, ROCKING_MAX_POINTS, ..."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

EXAMPLE = Path(__file__).with_name("example")
"""Results that `rocking serve` has where there are no others: a small spectrum, boundaries and a suite."""


def has_data(results: Path) -> bool:
    """Whether a folder may have data sets."""
    return results.is_dir() and any(one.is_dir() for one in results.iterdir())


def _nonempty(folder: Any) -> Any:
    if folder == "":  # Path("") is the current folder, which must not be published by accident
        raise ValueError("the name of a folder")
    return folder


Folder = Annotated[Path, BeforeValidator(_nonempty)]


def _origins(given: Any) -> Any:
    if not isinstance(given, str):
        return given
    try:
        return TypeAdapter(tuple[str, ...]).validate_json(given)
    except ValidationError:
        raise ValueError('a JSON list of origins, such as ["https://example.org"]') from None


PREFIX = "ROCKING_"  # of the environment variables

OTHERS = {"PLAIN_NUMBA", "NO_BROWSER", "CHROMIUM", "RUN", "RUN_NUMBER", "SERVER", "DATA_SETS", "MOTIONS", "SMOKE_RUN"}
"""Variables with the prefix that are no settings: of the solver, the workflow, the guide and the tests."""


class Settings(BaseSettings):
    """Settings of one service; `cors_origins` is empty by default."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="forbid")

    results: Folder = Field(default=Path("results"), description="folder that the workflow filled")
    guide: Folder = Field(default=Path("build/docs"), description="folder of the guide, which `make docs` fills")
    max_points: int = Field(default=1_000_000, ge=1, description="largest number of points of a batch")
    max_body_bytes: int = Field(default=64 * 1024 * 1024, ge=1, description="largest body of a request")
    max_record_bytes: int = Field(default=8 * 1024 * 1024, ge=1, description="largest file of a record in a request")
    max_connections: int = Field(default=1000, ge=1, description="connections beyond which requests are refused")
    max_samples: int = Field(default=100_000, ge=2, description="most samples of a time history or spectrum")
    max_workers: int = Field(default=2, ge=1, description="threads for dear requests: curves, maps, large bodies")
    max_queue: int = Field(default=16, ge=0, description="dear requests that may wait; more are refused")
    max_seconds: float = Field(default=60.0, gt=0.0, description="time limit of the work for a request [s]")
    arrival_seconds: float = Field(default=20.0, gt=0.0, description="time for a body to arrive [s]")
    stop_seconds: int = Field(default=30, ge=1, description="time for running requests at shutdown [s]")
    access_log: bool = Field(default=True, description="one line of the log for each request")
    # pydantic-settings would report text that is no JSON by an error without its value
    cors_origins: Annotated[tuple[str, ...], NoDecode, BeforeValidator(_origins)] = Field(
        default=(), description="web origins that may read the responses"
    )


def variables() -> list[str]:
    """The environment variables of the settings, sorted."""
    return sorted(f"{PREFIX}{name}".upper() for name in Settings.model_fields)


def unknown_variables(environment: Iterable[str]) -> list[str]:
    """The variables of an environment with the prefix that nothing reads, such as a misspelt setting, sorted."""
    known = {*variables(), *(f"{PREFIX}{name}" for name in OTHERS)}
    return sorted(name for name in environment if name.upper().startswith(PREFIX) and name.upper() not in known)
