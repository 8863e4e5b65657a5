"""Simulated wall time of the workflow: its jobs, limits on one core and on many, and the overhead of a cluster."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from benchmarks.cost import scaling
from tests.workflow_fixtures import snakemake

PULSES = ("sine", "cosine", "mavroeidis_papageorgiou")

DIGEST = 16 * "0"

ETAS = ("0.80", "0.85", "0.90", "1.00")

TIMES = {
    **{f"overturning-{pulse}-{eta}": 100.0 * float(eta) for pulse in PULSES for eta in ETAS},
    **{f"spectra-{pulse}-{tenth}.{DIGEST}": 20.0 for pulse in PULSES for tenth in ("0.8", "0.9")},
    **{f"spectra-{pulse}-{eta}": 2.0 for pulse in PULSES for eta in ETAS},
    **{f"checks-{pulse}": 3.0 for pulse in PULSES},
    "figure-03": 3.0, "figure-scale-law": 4.0, "table-1": 1.0, "claims": 5.0, "manifest": 0.5, "check_results": 6.0,
}  # fmt: skip


def test_one_core_takes_the_sum_and_many_take_the_longest_chain() -> None:
    jobs = scaling.jobs_of(TIMES)
    chain, names = scaling.longest_chain(jobs)
    assert chain == 100 + 20 + 2 + 4 + 5 + 0.5 + 6
    assert names[0] == "overturning-sine-1.00"
    assert names[-4:] == ["figure-scale-law", "claims", "manifest", "check_results"]
    assert scaling.wall_time(jobs, 1) == pytest.approx(sum(TIMES.values()))
    assert scaling.wall_time(jobs, 99) == chain
    times = [scaling.wall_time(jobs, cores) for cores in (1, 2, 4, 8)]
    assert times == sorted(times, reverse=True)
    assert times[1] >= 0.5 * times[0]


def test_a_cluster_delays_each_job_that_is_sent_to_it() -> None:
    jobs = scaling.jobs_of(TIMES)
    sent = 5  # of the longest chain all but the figure and the manifest
    assert scaling.wall_time(jobs, 99, overhead=7.0) == scaling.longest_chain(jobs)[0] + 7.0 * sent


def test_records_of_a_run_are_read(tmp_path: Path) -> None:
    for name, seconds in TIMES.items():
        (tmp_path / f"{name}.tsv").write_text(f"s\tmax_rss\tcpu_time\n{seconds}\t1\tNA\n")
    found = scaling.measure([tmp_path])
    assert found["seconds"] == sum(TIMES.values())
    assert found["jobs"] == len(TIMES)
    assert "longest chain 138 s" in scaling.table(found)


def test_the_dependences_are_those_of_a_run(smoke_run: Path) -> None:
    """Those of the data sets exactly; figures and claims may read fewer of them than is assumed."""
    printed = snakemake(smoke_run, "--detailed-summary").stdout
    lines = printed[printed.index("output_file") :].splitlines()
    rows = [row for row in csv.DictReader(lines, delimiter="\t") if row["log-file(s)"] not in (None, "-")]
    # logs/spectra/sine-0.85.log belongs to logs/benchmarks/spectra-sine-0.85.tsv
    logs = {row["output_file"]: row["log-file(s)"].removeprefix("logs/").removesuffix(".log") for row in rows}
    made_by = {file: log.removeprefix("figures/").replace("/", "-") for file, log in logs.items()}
    jobs = scaling.jobs_of({path.stem: 1.0 for path in (smoke_run / "logs/benchmarks").glob("*.tsv")})
    compared = 0
    for row in rows:
        name = made_by[row["output_file"]]
        read = {made_by[file] for file in row["input-file(s)"].split(",") if file in made_by}
        assert read <= jobs[name].after, name
        if name.startswith(("overturning", "spectra", "checks")):
            assert read == jobs[name].after, name
            compared += 1
    assert compared > 10
