"""Settings of the service: from `rocking serve`, or environment variables ROCKING_RESULTS, ROCKING_MAX_POINTS, ..."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field
from pydantic_settings import BaseSettings, SettingsConfigDict


def _named(folder: Any) -> Any:
    if folder == "":  # Path("") is the current folder, whose files nobody asked to publish
        raise ValueError("the name of a folder")
    return folder


class Settings(BaseSettings):
    """What may differ between two services; `cors_origins` is empty unless asked for."""

    model_config = SettingsConfigDict(env_prefix="ROCKING_", frozen=True, extra="forbid")

    results: Annotated[Path, BeforeValidator(_named)] = Field(
        default=Path("results"), description="folder that the workflow filled"
    )
    max_points: int = Field(default=1_000_000, ge=1, description="most points of one batch")
    max_body_bytes: int = Field(default=64 * 1024 * 1024, ge=1, description="largest body of a request")
    max_header_bytes: int = Field(default=32 * 1024, ge=1024, description="largest URL and headers of a request")
    max_samples: int = Field(default=100_000, ge=2, description="most samples of one time history or spectrum")
    max_workers: int = Field(default=2, ge=1, description="requests of heavy work (all but one block) done at once")
    max_queue: int = Field(default=16, ge=0, description="requests of heavy work that may wait; more are refused")
    max_seconds: float = Field(default=60.0, gt=0.0, description="what a request of heavy work is granted [s]")
    max_bytes_in_flight: int = Field(
        default=64 * 1024 * 1024, ge=1, description="bodies that arrive and answers not yet read, all together [bytes]"
    )
    arrival_seconds: float = Field(default=20.0, gt=0.0, description="what headers, and a body, may take to arrive [s]")
    reading_seconds: float = Field(
        default=20.0, gt=0.0, description="what a client that does not read is waited for [s]"
    )
    stop_seconds: int = Field(default=30, ge=1, description="what running requests are granted when it is stopped [s]")
    access_log: bool = Field(default=True, description="one line of JSON for each request")
    cors_origins: tuple[str, ...] = Field(default=(), description="web origins that may read the answers")
