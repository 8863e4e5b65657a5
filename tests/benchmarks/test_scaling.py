"""Simulated wall time of the workflow: limits on one core and on many, and the overhead of a cluster."""

import pytest

from benchmarks.cost import scaling

PULSES = ("sine", "cosine", "mavroeidis_papageorgiou")

TIMES = {
    **{f"overturning-{pulse}-{angle}": 10.0 + angle for pulse in PULSES for angle in (0, 5)},
    **{f"overturning-{pulse}": 1.0 for pulse in PULSES},
    **{f"spectra-{pulse}-rows-{band}": 20.0 for pulse in PULSES for band in ("0-9", "9-20")},
    **{f"spectra-{pulse}": 2.0 for pulse in PULSES},
    **{f"checks-{pulse}": 3.0 for pulse in PULSES},
    "figure-03": 3.0, "figure-scale-law": 4.0, "table-1": 1.0, "claims": 5.0, "manifest": 0.0, "check_results": 6.0,
}  # fmt: skip


def test_one_core_takes_the_sum_and_many_take_the_longest_chain():
    jobs = scaling.jobs_of(TIMES)
    chain, names = scaling.longest_chain(jobs)
    assert chain == 15 + 1 + 20 + 2 + 4 + 5 + 0 + 6
    assert names[0] == "overturning-sine-5"
    assert names[-5:] == ["spectra-sine", "figure-scale-law", "claims", "manifest", "check_results"]
    assert scaling.wall_time(jobs, 1) == pytest.approx(sum(TIMES.values()))
    assert scaling.wall_time(jobs, 99) == chain
    times = [scaling.wall_time(jobs, cores) for cores in (1, 2, 4, 8)]
    assert times == sorted(times, reverse=True)
    assert times[1] >= 0.5 * times[0]


def test_a_cluster_delays_each_job_that_is_sent_to_it():
    jobs = scaling.jobs_of(TIMES)
    sent = 3  # on the longest chain: a part of boundaries, a tile, the join of the tiles
    least = scaling.longest_chain(jobs)[0] + 7.0 * sent
    joins = len(PULSES)  # of boundaries, one after the other on the one core of local jobs
    assert least <= scaling.wall_time(jobs, 99, overhead=7.0) <= least + joins


def test_records_of_a_run_are_read(tmp_path):
    for name, seconds in TIMES.items():
        (tmp_path / f"{name}.tsv").write_text(f"s\tmax_rss\tcpu_time\n{2 * seconds}\t1\t{seconds or 'NA'}\n")
    found = scaling.measure([tmp_path])
    assert found["processor"] == sum(TIMES.values())
    assert found["jobs"] == len(TIMES)
    assert "longest chain 53 s" in scaling.table(found)
