"""The `rocking` command: responses in three formats, units, and errors that name the option."""

import csv
import io
import json
import math
import re
import subprocess
import sys

import numpy as np
import pytest
from typer.testing import CliRunner

import rocking
from rocking._base.errors import InvalidArgumentError, si_value
from rocking._boundary.tracing import overturning_boundary
from rocking._cli.app import app
from rocking._dimensional.block import Block
from rocking._history.time_history import time_history
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response

GROUPS = ["--pulse", "sine", "--slenderness", "0.4", "--frequency-ratio", "5", "--restitution", "0.85"]
UNITS = [
    "--pulse", "sine", "--width", "0.4m", "--height", "160 cm", "--peak-acceleration", "4 m/s^2",
    "--period", "500 ms", "--restitution", "momentum",
]  # fmt: skip


def run(*arguments):
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 0, result.output
    return result.stdout


def refused(*arguments):
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 2
    return " ".join(result.output.replace("│", " ").split())


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_response_in_three_formats():
    expected = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    result = json.loads(run("response", *GROUPS, "--json"))
    assert result["peak_rotation"] == expected.peak_rotation
    assert result["outcome"] == "SAFE"
    assert 0 < result["error_bound"] < 1e-10
    (row,) = read_csv(run("response", *GROUPS, "--csv"))
    assert float(row["peak_rotation"]) == result["peak_rotation"]
    assert row["overturned"] == "false"
    text = run("response", *GROUPS)
    assert text.startswith("rocks and comes to rest\n")
    assert f"{float(expected.peak_rotation):.9g}" in text


def test_response_with_units_is_that_of_the_rigid_block():
    block = Block(0.4, 1.6)
    expected = peak_response(
        "sine",
        slenderness=block.uplift_acceleration / 4.0,
        frequency_ratio=4 * math.pi / block.frequency_parameter,
        restitution=block.momentum_restitution,
        alpha=block.alpha,
    )
    result = json.loads(run("response", *UNITS, "--json"))
    assert result["peak_rotation"] == pytest.approx(float(expected.peak_rotation), rel=1e-9)
    assert result["peak_rotation_deg"] == pytest.approx(math.degrees(expected.peak_rotation * block.alpha), rel=1e-9)


def test_alpha_is_an_angle_with_a_unit():
    degrees = run("response", *GROUPS, "--alpha", "20 deg", "--json")
    expected = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85, alpha=math.radians(20))
    assert json.loads(degrees)["peak_rotation"] == pytest.approx(float(expected.peak_rotation), rel=1e-9)


def test_overturned_has_no_peak():
    falls = [*GROUPS[:3], "0.2", *GROUPS[4:]]
    assert json.loads(run("response", *falls, "--json"))["peak_rotation"] is None
    assert run("response", *falls).startswith("overturns")


def test_first_line_states_that_the_rocking_model_does_not_apply():
    cube = ["--width", "1.0m", "--height", "1.0m", "--peak-acceleration", "1.5g"]
    options = ["response", *UNITS[:2], *cube, *UNITS[8:]]
    first = run(*options).splitlines()[0]
    assert first.startswith("would slide: the rocking model does not apply")
    result = json.loads(run(*options, "--json"))
    assert (result["outcome"], result["rocking_model_applies"]) == ("SAFE", False)
    assert result["friction_demand"] == pytest.approx(17.9, abs=0.1)
    assert json.loads(run("response", *UNITS, "--json"))["rocking_model_applies"]
    assert "rocking_model_applies" not in json.loads(run("response", *GROUPS, "--json"))  # the slender limit


def test_squat_block_does_not_uplift():
    squat = ["--width", "2m", "--height", "1.0m", "--peak-acceleration", "1.2g"]
    assert run("response", *UNITS[:2], *squat, *UNITS[8:]).startswith("never uplifts")


def test_history_in_three_formats():
    expected = time_history("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85, samples=20)
    result = json.loads(run("history", *GROUPS, "--samples", "20", "--json"))
    assert result["rotation"] == expected["rotation"].values.tolist()
    assert result["impact_time"] == expected["impact_time"].values.tolist()
    rows = read_csv(run("history", *GROUPS, "--samples", "20", "--csv"))
    assert [float(row["tau"]) for row in rows] == expected["tau"].values.tolist()
    assert len(run("history", *GROUPS, "--samples", "20").splitlines()) > len(rows)


def test_history_of_a_given_length():
    assert json.loads(run("history", *GROUPS, "--duration", "2", "--json"))["tau"][-1] == 2.0
    result = json.loads(run("history", *UNITS, "--duration", "900 ms", "--json"))
    assert result["time"][-1] == pytest.approx(0.9)
    assert "missing unit: write 2s" in refused("history", *UNITS, "--duration", "2")


WHOLE = [
    "--pulse", "sine", "--width", "40 cm", "--height", "1.6m", "--peak-acceleration", "400 gal",
    "--period", "0.5s",
]  # fmt: skip
BLOCK = rocking.Block(0.4, 1.6)


def test_response_of_a_block_in_si_units():
    result = json.loads(run("response", *WHOLE, "--json"))
    found = BLOCK.response("sine", peak_acceleration=4.0, period=0.5)
    assert result["peak_rotation_deg"] == pytest.approx(math.degrees(found.rotation), rel=1e-9)
    assert result["top_displacement"] == pytest.approx(found.displacement, rel=1e-9)
    assert result["largest_safe_acceleration"] == pytest.approx(found.thresholds[0].value, rel=1e-9)
    assert result["nearest_period"] == pytest.approx(found.margins.nearest_period, rel=1e-9)
    assert [one["overturns_above"] for one in result["thresholds"]] == [True, False, True]
    assert result["warnings"] == []
    text = run("response", *WHOLE)
    assert text.splitlines()[0] == found.sentence
    assert text.splitlines()[1].split() == ["peak_rotation_deg", "[deg]", "7.41882221"]
    assert "overturns above 4.70006, survives above 13.1272, overturns above 13.9939" in text
    (row,) = read_csv(run("response", *WHOLE, "--csv"))
    assert [float(a) for a in row["thresholds"].split()] == [one["peak_acceleration"] for one in result["thresholds"]]
    assert result["pulse_duration"] == 0.5
    half_sine = json.loads(run("response", "--pulse", "half_sine", *WHOLE[2:], "--json"))
    assert half_sine["pulse_duration"] == pytest.approx(0.25)
    near = run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:])
    assert near == run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:], "--restitution", "momentum")
    assert "warning: the outcome changes within 5 % of this peak acceleration: at 4.7 m/s2" in near


def test_history_of_a_block_in_si_units():
    result = json.loads(run("history", *WHOLE, "--samples", "20", "--json"))
    expected = BLOCK.history("sine", peak_acceleration=4.0, period=0.5, samples=20)
    assert result["time"] == pytest.approx(expected["time"].values, rel=1e-12)
    assert result["rotation_deg"] == pytest.approx(np.degrees(expected["rotation"].values), rel=1e-9)
    assert result["top_displacement"] == pytest.approx(expected["top_displacement"].values, rel=1e-9)
    assert result["acceleration"] == pytest.approx(expected["ground_acceleration"].values, rel=1e-9)
    assert result["impact_time_s"] == pytest.approx(expected["impact_time"].values, rel=1e-12)
    assert len(result["tau"]) == len(result["time"])
    assert "angular_velocity_deg" in run("history", *WHOLE, "--samples", "20")


def test_spectrum_of_a_block_in_si_units():
    options = [*WHOLE[:8], "--period-min", "0.3s", "--period-max", "1.2s", "--points", "3"]
    result = json.loads(run("spectrum", *options, "--json"))
    assert result["period"] == pytest.approx([1.2, 0.6, 0.3])
    expected = BLOCK.spectrum("sine", peak_acceleration=4.0, period=result["period"])
    assert result["overturned"] == expected["overturned"].values.tolist()
    degrees = [math.nan if x is None else x for x in result["peak_rotation_deg"]]
    assert degrees == pytest.approx(np.degrees(expected["rotation"].values), rel=1e-9, nan_ok=True)
    assert run("spectrum", *options).splitlines()[-3].split()[0] == "0.3"
    assert "--period-max" in refused("spectrum", *options[:-4], "--period-max", "0.2s")


def test_boundary_of_a_block_in_si_units():
    options = ["--pulse", "sine", "--width", "0.4m", "--height", "1.6m", "--period-min", "0.4s", "--period-max", "0.8s"]
    result = json.loads(run("boundary", *options, "--json"))
    assert min(result["period"]) == pytest.approx(0.4)
    assert max(result["period"]) == pytest.approx(0.8)
    at = int(np.argmin(np.abs(np.array(result["period"]) - 0.6)))
    period, acceleration = result["period"][at], result["peak_acceleration"][at]
    found = BLOCK.response("sine", peak_acceleration=4.0, period=period)
    assert min(abs(one.value / acceleration - 1.0) for one in found.thresholds) < 1e-9


TABLE = """name,width [cm],height [m],peak_acceleration (gal),period [ms],restitution
statue,40,1.6,400,500,
cabinet,40,1.6,800,500,0.9

"""


def test_table_of_blocks(tmp_path):
    path = tmp_path / "blocks.csv"
    path.write_text(TABLE)
    rows = read_csv(run("response", "--pulse", "sine", "--blocks", str(path)))
    assert [row["name"] for row in rows] == ["statue", "cabinet"]
    single = json.loads(run("response", *WHOLE, "--json"))
    for name in ("peak_rotation_deg", "top_displacement", "slenderness", "frequency_ratio", "restitution"):
        assert float(rows[0][name]) == pytest.approx(single[name], rel=1e-12)
    assert (rows[1]["overturned"], rows[1]["peak_rotation_deg"], rows[1]["restitution"]) == ("true", "", "0.9")
    as_json = json.loads(run("response", "--pulse", "sine", "--blocks", str(path), "--json"))
    assert as_json["outcome"] == [row["outcome"] for row in rows]
    piped = CliRunner().invoke(app, ["response", "--pulse", "sine", "--blocks", "-"], input=TABLE.replace(",", ";"))
    assert read_csv(piped.stdout) == rows
    path.write_text(TABLE.splitlines()[0])
    assert read_csv(run("response", "--pulse", "sine", "--blocks", str(path))) == []


def test_names_of_blocks_are_printed_as_they_are_read_but_for_formulas(tmp_path):
    names = ["vase, blue", 'say "no"', "two\nlines", "a\r\nb", "=1+1", "-2+3"]
    path = tmp_path / "blocks.csv"
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerows([TABLE.splitlines()[0].split(","), *([name, 40, 1.6, 400, 500, 0.9] for name in names)])
    table = ("response", "--pulse", "sine", "--blocks")
    piped = CliRunner().invoke(app, [*table, "-"], input=path.read_bytes())
    assert piped.exit_code == 0
    printed = piped.stdout_bytes.decode()
    assert CliRunner().invoke(app, [*table, str(path)]).stdout_bytes.decode() == printed
    rows = list(csv.DictReader(io.StringIO(printed, newline=""), strict=True))
    assert [row["name"] for row in rows] == [*names[:4], *(f"'{name}" for name in names[4:])]
    assert {row["restitution"] for row in rows} == {"0.9"}


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (TABLE.replace("statue", '"statue'), "line 2: 'unexpected end of data'"),
        (TABLE.replace("width [cm]", "width"), "missing unit: write width [m]"),
        (TABLE.replace("[cm]", "[kg]"), "a unit such as m, cm"),
        (TABLE.replace("name", "colour"), "name, restitution"),
        (TABLE.replace("period [ms]", "width [m]"), "each at most once"),
        (TABLE.replace("800", "x"), "line 3, peak_acceleration: 'x'"),
        (TABLE.replace("800", "-1"), "line 3, peak_acceleration: -1.0 is not allowed; allowed: (0, inf) [gal]"),
        (TABLE.replace("0.9", "1.9"), "line 3, restitution: 1.9"),
        (TABLE.replace("400,500,", "400,500"), "line 2: '5 values'"),
        ("", "one column"),
    ],
)
def test_errors_in_a_table_name_the_line(table, words):
    result = CliRunner().invoke(app, ["response", "--pulse", "sine", "--blocks", "-"], input=table)
    assert result.exit_code == 2
    text = " ".join(result.output.replace("│", " ").split())
    assert "--blocks" in text
    assert words in text


def test_every_line_of_a_table_with_an_error_is_named():
    rows = [TABLE.splitlines()[0], *[f"b{k},0,1,800,400,0.9" for k in range(24)], "short"]
    result = CliRunner().invoke(app, ["response", "--pulse", "sine", "--blocks", "-"], input="\n".join(rows))
    assert result.exit_code == 2
    text = " ".join(result.output.replace("│", " ").split())
    assert "25 values are not allowed" in text
    for line in range(2, 22):
        assert f"line {line}, width: 0.0 is not allowed" in text
    assert "line 22" not in text
    assert "and 5 more" in text


def test_the_header_of_csv_names_units_on_request(tmp_path):
    path = tmp_path / "blocks.csv"
    path.write_text(TABLE)
    table = ("response", "--pulse", "sine", "--blocks", str(path))
    plain, named = (run(*table, *more).splitlines() for more in ((), ("--units",)))
    assert plain[1:] == named[1:]
    assert "width [m],height [m],peak_acceleration [m/s2],period [s]," in named[0]
    assert re.sub(r" \[[^]]*\]", "", named[0]) == plain[0]
    assert "top_displacement [m]" in run("history", *WHOLE, "--csv", "--units").splitlines()[0]
    for form in ((), ("--json",)):
        assert "--units" in refused("response", *WHOLE, "--units", *form)


def test_table_and_options_exclude_each_other(tmp_path):
    assert "--width" in refused("response", "--pulse", "sine", "--blocks", "-", "--width", "1m")
    assert "--blocks" in refused("response", "--pulse", "sine", "--blocks", str(tmp_path / "none.csv"))


def test_history_with_the_reactions_of_the_ground():
    options = ["history", *UNITS, "--samples", "20", "--contact"]
    block = Block(0.4, 1.6)
    expected = time_history(
        "sine",
        slenderness=block.uplift_acceleration / 4.0,
        frequency_ratio=4 * math.pi / block.frequency_parameter,
        restitution=block.momentum_restitution,
        alpha=block.alpha,
        samples=20,
        contact=True,
    )
    result = json.loads(run(*options, "--json"))
    assert result["normal_reaction"] == pytest.approx(expected["normal_reaction"].values, rel=1e-9)
    assert result["largest_friction_demand"] == pytest.approx(expected.largest_friction_demand, rel=1e-9)
    assert (result["lifts_off"], result["warnings"]) == (False, None)
    assert [float(row["friction_demand"]) for row in read_csv(run(*options, "--csv"))] == result["friction_demand"]
    assert f"{result['largest_friction_demand']:.9g}" in run(*options)
    assert "friction_demand" not in run(*options[:-1])


def test_block_that_lifts_off_has_no_friction_demand():
    options = [*GROUPS[:3], "0.2", "--frequency-ratio", "12", "--restitution", "0.85", "--alpha", "45 deg", "--contact"]
    result = json.loads(run("history", *options, "--json"))
    assert result["lifts_off"]
    assert result["largest_friction_demand"] is None
    assert None in result["friction_demand"]
    assert "lifts off" in result["warnings"]
    assert any(row["friction_demand"] == "" for row in read_csv(run("history", *options, "--csv")))
    assert "the block lifts off" in run("history", *options)


def test_spectrum_in_three_formats():
    arguments = ["--pulse", "cosine", "--slenderness", "0.6", "--restitution", "0.9", "--points", "7"]
    expected = peak_response("cosine", slenderness=0.6, frequency_ratio=np.geomspace(0.5, 12.0, 7), restitution=0.9)
    result = json.loads(run("spectrum", *arguments, "--json"))
    assert result["outcome"] == [Outcome(code).name for code in expected.outcome]
    assert [math.nan if peak is None else peak for peak in result["peak_rotation"]] == pytest.approx(
        expected.peak_rotation.tolist(), rel=0, abs=0, nan_ok=True
    )
    assert len(read_csv(run("spectrum", *arguments, "--csv"))) == 7
    assert run("spectrum", *arguments).splitlines()[-1].endswith(str(expected.impacts[-1]))


def test_boundary_in_three_formats():
    arguments = ["--pulse", "sine", "--restitution", "0.85", "--frequency-ratio-min", "2"]
    expected = overturning_boundary("sine", restitution=0.85, frequency_ratio=(2.0, 15.0))
    result = json.loads(run("boundary", *arguments, "--json"))
    assert result["slenderness"] == expected["slenderness"].values.tolist()
    assert len(read_csv(run("boundary", *arguments, "--csv"))) == expected.sizes["point"]
    assert run("boundary", *arguments).splitlines()[0].split()[:2] == ["curve", "slenderness"]


TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")


@pytest.fixture
def triangle(tmp_path):
    path = tmp_path / "triangle.csv"
    path.write_text("time [s],acceleration [g]\n0,0\n0.3,0.5\n0.6,0\n")
    return str(path)


def test_every_command_takes_a_pulse_from_a_file(triangle, tmp_path):
    groups = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
    result = json.loads(run("response", "--pulse", triangle, *GROUPS[2:], "--json"))
    assert result["pulse"] == "triangle"
    assert result["peak_rotation"] == peak_response(TRIANGLE, **groups).peak_rotation
    mirrored = json.loads(run("response", f"--pulse=-{triangle}", *GROUPS[2:], "--json"))
    assert (mirrored["pulse"], mirrored["peak_rotation"]) == ("-triangle", result["peak_rotation"])
    history = json.loads(run("history", "--pulse", triangle, *GROUPS[2:], "--json"))
    assert history["rotation"] == time_history(TRIANGLE, **groups)["rotation"].values.tolist()
    spectrum = json.loads(run("spectrum", "--pulse", triangle, *GROUPS[2:4], *GROUPS[6:], "--points", "3", "--json"))
    omega = groups | {"frequency_ratio": spectrum["frequency_ratio"]}
    overturned = peak_response(TRIANGLE, **omega).overturned
    assert [peak is None for peak in spectrum["peak_rotation"]] == overturned.tolist()
    window = {"frequency_ratio": (2.0, 3.0)}
    ends = ["--frequency-ratio-min", "2", "--frequency-ratio-max", "3"]
    boundary = json.loads(run("boundary", "--pulse", triangle, *GROUPS[6:], *ends, "--json"))
    expected = overturning_boundary(TRIANGLE, restitution=0.85, **window)
    assert boundary["slenderness"] == expected["slenderness"].values.tolist()
    path = tmp_path / "blocks.csv"
    path.write_text("width [m],height [m],peak_acceleration [g],period [s]\n0.4,1.6,0.4,0.5\n")
    (row,) = read_csv(run("response", "--pulse", triangle, "--blocks", str(path)))
    block = rocking.Block(0.4, 1.6).response(TRIANGLE, peak_acceleration="0.4 g", period=0.5)
    assert float(row["top_displacement"]) == block.displacement
    printed = json.loads(run("response", "--pulse", triangle, *UNITS[2:], "--json"))
    assert printed["pulse_duration"] == 0.5


def test_a_name_of_a_pulse_is_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sine").write_text("0\n1\n0\n")
    (tmp_path / "sin").write_text("0\n1\n0\n")
    sine = json.loads(run("response", *GROUPS, "--json"))
    assert sine["pulse"] == "sine"
    exact = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    assert sine["peak_rotation"] == exact.peak_rotation
    assert json.loads(run("response", "--pulse", "sin", *GROUPS[2:], "--json"))["pulse"] == "sin"


def test_errors_of_a_file_of_a_pulse_name_the_line(triangle, tmp_path):
    missing = refused("response", "--pulse", str(tmp_path / "no.csv"), *GROUPS[2:])
    assert "one of sine" in missing
    assert "a file that can be read (No such file" in missing
    (tmp_path / "triangle.csv").write_text("0,0\n1,one\n")
    damaged = refused("response", "--pulse", triangle, *GROUPS[2:])
    assert "--pulse" in damaged
    assert "triangle.csv, line 2: one" in damaged


@pytest.mark.parametrize(
    ("arguments", "option", "allowed"),
    [
        (["response", *GROUPS[:-1], "1.5"], "--restitution", "[0, 1]"),
        (["response", *GROUPS[:-1], "bouncy"], "--restitution", "momentum for a block"),
        (["response", "--pulse", "sinus", *GROUPS[2:]], "--pulse", "one of sine"),
        (["response", *GROUPS[:3], "nan", *GROUPS[4:]], "--slenderness", "[1e-12, inf)"),
        (["response", *GROUPS[:4], "--restitution", "0.85"], "--frequency-ratio", "a number"),
        (["response", *GROUPS, "--alpha", "20"], "--alpha", "20 deg"),
        (["response", *GROUPS, "--alpha", "95 deg"], "--alpha", "[0, 1.5"),
        (["response", *GROUPS, "--width", "2m"], "--slenderness", "either groups"),
        (["response", *GROUPS, "--json", "--csv"], "--csv", "one of --json and --csv"),
        (["response", *UNITS[:3], "20", *UNITS[4:]], "--width", "missing unit: write 20m (such as 0.3 m"),
        (["response", *UNITS[:3], "2 kg", *UNITS[4:]], "--width", "0.3 m"),
        (["response", *UNITS[:3], "-1 m", *UNITS[4:]], "--width", "(0, inf)"),
        (["response", *UNITS[:8], *UNITS[10:]], "--period", "required"),
        (["history", *GROUPS, "--samples", "1"], "--samples", "[2,"),
        (["spectrum", "--pulse", "sine", "--slenderness", "0.4", "--restitution", "0.85", "--points", "1"],
         "--points", "[2,"),
        (["boundary", "--pulse", "sine", "--restitution", "0.85", "--frequency-ratio-max", "0.1"],
         "--frequency-ratio-max", "(0.2, 1e+09]"),
        (["serve", "--port", "99999"], "--port", "65535"),
        (["serve", "--results", ""], "--results", "the name of a folder"),
        (["serve", "--results", "nowhere"], "--results", "a folder that exists"),
        (["response", *UNITS[:7], "4", *UNITS[8:]], "--peak-acceleration", "missing unit: write 4m/s2 or 4g (such as"),
    ],
)  # fmt: skip
def test_errors_name_the_option_and_the_allowed_values(arguments, option, allowed):
    output = refused(*arguments)
    assert option in output
    assert allowed in output


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0.3m", "m", 0.3),
        ("30 cm", "m", 0.3),
        ("12 inch", "m", 0.3048),
        ("0.4g", "m/s2", 0.4 * 9.80665),
        ("0.4 g", "m/s2", 0.4 * 9.80665),
        ("4 m/s2", "m/s2", 4.0),
        ("4 m/s^2", "m/s2", 4.0),
        ("400 cm/s**2", "m/s2", 4.0),
        ("400 gal", "m/s2", 4.0),
        ("400Gal", "m/s2", 4.0),
        ("500 ms", "s", 0.5),
        ("20 deg", "rad", math.radians(20)),
        ("0.2 rad", "rad", 0.2),
    ],
)
def test_units(text, unit, value):
    assert si_value("x", text, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "unit"),
    [("0.3", "m"), ("0.3 s", "m"), ("0.3 furlongs per", "m"), ("", "m"), ("m", "s"), ("nan m", "m"), ("0.3", "rad"),
     ("1 kg", "m/s2"), ("__import__('os')", "m"), ("1e999 m", "m")],
)  # fmt: skip
def test_invalid_quantities_are_refused(text, unit):
    with pytest.raises(InvalidArgumentError) as caught:
        si_value("x", text, unit)
    assert caught.value.parameter == "x"


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_import_nothing_heavy(option):
    code = (
        "import sys\n"
        "from typer.testing import CliRunner\n"
        "from rocking._cli.app import app\n"
        f"result = CliRunner().invoke(app, [{option!r}])\n"
        "assert result.exit_code == 0\n"
        "print(result.stdout)\n"
        "print(*({'numba', 'numpy', 'scipy', 'xarray', 'pint', 'fastapi', 'uvicorn'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    *printed, heavy = done.stdout.split("\n")[:-1]
    assert heavy == ""
    if option == "--version":
        assert printed[0] == rocking.__version__
        assert not any(printed[1:])
