"""Settings of the service: from `rocking serve`, or environment variables ROCKING_RESULTS, ROCKING_MAX_POINTS, ..."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class Settings(BaseSettings):
    """What may differ between two services; `cors_origins` is empty unless asked for."""

    model_config = SettingsConfigDict(env_prefix="ROCKING_", frozen=True, extra="forbid")

    results: Path = Field(default=Path("results"), description="folder that the workflow filled")
    max_points: int = Field(default=1_000_000, ge=1, description="most points of one batch")
    max_body_bytes: int = Field(default=64 * 1024 * 1024, ge=1, description="largest body of a request")
    max_samples: int = Field(default=100_000, ge=2, description="most samples of one time history or spectrum")
    max_workers: int = Field(
        default=2, ge=1, description="batches, histories and file reads worked on at once; more wait"
    )
    cors_origins: tuple[str, ...] = Field(default=(), description="web origins that may read the answers")
