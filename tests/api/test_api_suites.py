"""/v1/suites: the numbers are those of the data sets of the workflow."""

import csv
import io

import numpy as np
import pytest
import xarray as xr
from rocking_api import suite_reader

import rocking
from rocking._datasets.cube import read_dataset, write_dataset
from tests.api.conftest import assert_problem, client_of
from tests.suites.motions import noise

NAME = "/v1/suites/demonstration"


@pytest.fixture(scope="module")
def suite(client):
    return client.get(NAME).json()


@pytest.fixture(scope="module")
def files(results):
    folder = results / "suites" / "demonstration"
    return read_dataset(folder / "fragility.nc"), read_dataset(folder / "outcomes.nc")


def test_catalogue_lists_suites_with_their_files(client):
    (one,) = client.get("/v1/suites").json()["suites"]
    assert (one["name"], one["measure"], one["unit"], one["records"], one["blocks"]) == (
        "demonstration", "pga", "m s-2", 4, 2,
    )  # fmt: skip
    assert one["demands"] == ["overturning", "0.5 alpha"]
    own, *data = one["links"]
    assert own == {"rel": "self", "href": NAME, "type": "application/json"}
    assert [link["href"].rpartition("/")[2] for link in data] == ["fragility.nc", "outcomes.nc", "sensitivity.nc"]
    for link in one["links"]:
        assert client.head(link["href"]).status_code in (200, 405)
        assert client.get(link["href"]).status_code == 200


def listed(values):
    """The values of a variable as JSON has them."""
    return np.where(np.isfinite(values), values, None).tolist()


def test_counts_and_curves_are_those_of_the_data_set(suite, files):
    fragility, _ = files
    assert suite["intensity"] == fragility["intensity"].values.tolist()
    assert suite["confidence"] == 0.95
    assert [one["name"] for one in suite["records"]] == [f"noise {seed}" for seed in range(4)]
    assert "rigid" in suite["metadata"]["model"]
    meanings = fragility["fit_status"].attrs["flag_meanings"].upper().split()
    for k, block in enumerate(suite["blocks"]):
        assert block["alpha_deg"] == pytest.approx(np.degrees(float(fragility["alpha"][k])))
        for n, state in enumerate(block["limit_states"]):
            found = fragility.isel(block=k, demand=n)
            assert state["demand"] == str(found["demand"].item())
            for name in ("exceedances", "fraction", "fraction_lower", "fraction_upper", "first_exceedances"):
                assert state[name] == found[name].values.tolist()
            for curve in state["curves"]:
                one = found.sel(model=curve["model"])
                assert curve["fit_status"] == meanings[int(one["fit_status"])]
                assert curve["fit_meaning"]
                for name in ("median_intensity", "dispersion", "dispersion_upper"):
                    assert curve[name] == listed(one[name].values)


def test_margins_and_quantiles_follow_from_the_outcomes(suite, files):
    _, outcomes = files
    levels = outcomes["intensity"].values
    for k, block in enumerate(suite["blocks"]):
        overturned = outcomes["overturned"].isel(block=k).transpose("record", "intensity").values.astype(bool)
        for own, margin in zip(overturned, block["margins"], strict=True):
            first, exact = (levels[own].min() if own.any() else None), margin["overturning_intensity"]
            assert (exact is None) == (first is None)
            assert margin["levels_survived_above"] == (0 if exact is None else int((~own & (levels > exact)).sum()))
            if first is not None:
                assert 0.0 < exact <= first
                # every record has a peak of 3 m/s2, and the measure is the PGA
                assert margin["overturning_scale"] == pytest.approx(exact / 3.0)
        low, median, high = block["rotation_quantiles"]
        assert (low["quantile"], median["quantile"], high["quantile"]) == (0.16, 0.5, 0.84)
        peaks = np.where(overturned, np.inf, outcomes["peak_rotation"].isel(block=k).transpose("record", "intensity"))
        for one, order in zip((low, median, high), (0, 1, 3), strict=True):  # of four: the first, the second, the last
            assert one["peak_rotation"] == listed(np.sort(peaks, axis=0)[order])


def test_friction_restitution_and_sampling_are_those_of_direct_calls(suite):
    blocks = [rocking.Block(0.5, 2.0), rocking.Block(0.8, 4.0)]
    found = rocking.suites.suite_sensitivity([noise(seed) for seed in range(4)], blocks, intensity=[4.0, 9.0])
    for k, block in enumerate(suite["blocks"]):
        assert [level["intensity"] for level in block["sensitivity"]] == [4.0, 9.0]
        for n, level in enumerate(block["sensitivity"]):
            own = found.isel(block=k, intensity=n)
            numbers = {key: value for key, value in level.items() if isinstance(value, (int, float))}
            assert len(numbers) == 15
            assert numbers == {key: own[key].item() for key in numbers}
            assert "; ".join(level["records_changed_by_sampling"]) == own["records_changed_by_sampling"].item()
            for key in ("friction_demand", "overturned", "overturned_high_restitution", "overturned_resampled"):
                assert [record[key] for record in level["records"]] == own[key].values.tolist()


def test_files_are_read_once_and_replaced_ones_are_noticed(own_results, monkeypatch):
    folder = own_results / "suites" / "demonstration"
    with client_of(own_results) as own:
        before = own.get(NAME).json()
        with monkeypatch.context() as patched:
            patched.setattr(suite_reader, "decode_dataset", None)  # a second reading fails
            assert own.get(NAME).json() == before
            assert len(own.get("/v1/suites").json()["suites"]) == 1
        for file, change in (
            ("fragility", lambda old: old.assign_attrs(title="Replaced")),
            ("outcomes", lambda old: old.assign(overturning_intensity=np.nan * old["overturning_intensity"])),
            ("sensitivity", lambda old: old.assign(friction_demand_median=2.0 * old["friction_demand_median"])),
        ):
            changed = change(read_dataset(folder / f"{file}.nc"))
            (folder / f"{file}.nc").unlink()
            write_dataset(changed, folder / f"{file}.nc")
        after = own.get(NAME).json()
        assert after["title"] == own.get("/v1/suites").json()["suites"][0]["title"] == "Replaced"
        for now, then in zip(after["blocks"], before["blocks"], strict=True):
            assert {margin["overturning_intensity"] for margin in now["margins"]} == {None}
            new, old = (one["sensitivity"][0]["friction_demand_median"] for one in (now, then))
            assert new == 2.0 * old
        (folder / "sensitivity.nc").unlink()
        assert all(block["sensitivity"] == [] for block in own.get(NAME).json()["blocks"])


def test_a_damaged_suite_is_refused(own_results):
    path = own_results / "suites" / "demonstration" / "fragility.nc"
    path.unlink()
    write_dataset(xr.Dataset({"other": ("x", [1.0])}), path)
    with client_of(own_results) as own:
        assert_problem(own.get(NAME), 503)
        assert own.get("/v1/suites").json()["suites"] == []


def test_fragility_as_csv_has_the_counts_of_the_data_set(client, files):
    rows = [*csv.DictReader(io.StringIO(client.get(NAME, params={"format": "csv"}).text))]
    counts = files[0]["exceedances"].transpose("demand", "block", "intensity").values.ravel()
    assert [int(row["exceedances"]) for row in rows] == counts.tolist()
