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
from typer.main import get_command
from typer.testing import CliRunner

import rocking
from rocking._base.errors import si_value
from rocking._base.units import UNITS as KNOWN_UNITS
from rocking._boundary.tracing import overturning_boundary
from rocking._cli.app import app
from rocking._history.time_history import time_history
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response

GROUPS = ["--pulse", "sine", "--slenderness", "0.4", "--frequency-ratio", "5", "--restitution", "0.85"]
UNITS = [
    "--pulse", "sine", "--width", "0.4m", "--height", "160 cm", "--peak-acceleration", "400 gal", "--period", "500 ms",
    "--restitution", "momentum",
]  # fmt: skip
WHOLE = UNITS[:-2]
BLOCK = rocking.Block(0.4, 1.6)


def run(*arguments):
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 0, result.output
    return result.stdout


def refused(*arguments):
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 2
    return " ".join(result.output.replace("│", " ").split())


def read_csv(text):
    """The rows of CSV, by the names of the columns without their units."""
    rows = csv.DictReader(io.StringIO(text))
    rows.fieldnames = [re.sub(r" \[[^]]*\]$", "", name) for name in rows.fieldnames]
    return list(rows)


def test_response_in_three_formats():
    expected = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    result = json.loads(run("response", *GROUPS, "--format=json"))
    assert result["peak_rotation"] == expected.peak_rotation
    assert result["outcome"] == "RECOVERS"
    assert 0 < result["error_bound"] < 1e-10
    (row,) = read_csv(run("response", *GROUPS, "--format=csv"))
    assert float(row["peak_rotation"]) == result["peak_rotation"]
    assert row["overturned"] == "false"
    text = run("response", *GROUPS)
    assert text.startswith("rocks and comes to rest\n")
    assert f"{float(expected.peak_rotation):.9g}" in text


def test_first_line_states_that_the_rocking_model_does_not_apply():
    cube = ["--width", "1.0m", "--height", "1.0m", "--peak-acceleration", "1.5g"]
    options = ["response", *UNITS[:2], *cube, *UNITS[8:]]
    assert run(*options).startswith("would slide: the rocking model does not apply")
    result = json.loads(run(*options, "--format=json"))
    assert (result["outcome"], result["rocking_model_applies"]) == ("RECOVERS", False)
    assert result["friction_demand"] == pytest.approx(17.9, abs=0.1)


def test_history_in_three_formats(triangle):
    given = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
    expected = time_history(TRIANGLE, **given, samples=20, duration=2.0)
    options = ["history", "--pulse", triangle, *GROUPS[2:], "--samples", "20", "--duration", "2"]
    result = json.loads(run(*options, "--format=json"))
    assert result["rotation"] == expected["rotation"].values.tolist()
    assert result["impact_time"] == expected["impact_time"].values.tolist()
    rows = read_csv(run(*options, "--format=csv"))
    assert [float(row["tau"]) for row in rows] == expected["tau"].values.tolist()
    assert len(run(*options).splitlines()) > len(rows)


def test_response_of_a_block_in_si_units():
    result = json.loads(run("response", *WHOLE, "--format=json"))
    found = BLOCK.response("sine", peak_acceleration=4.0, period=0.5)
    assert {name: result[name] for name in found.summary()} == found.summary()
    assert [one["overturns_above"] for one in result["thresholds"]] == [True, False, True]
    text = run("response", *WHOLE)
    assert text.splitlines()[0] == found.sentence
    assert text.splitlines()[1].split() == ["peak_rotation_deg", "[deg]", "7.41882221"]
    assert "overturns above 470.006, survives above 1312.72, overturns above 1399.39" in text
    (row,) = read_csv(run("response", *WHOLE, "--format=csv"))
    changes = [100.0 * one["peak_acceleration"] for one in result["thresholds"]]
    assert [float(a) for a in row["thresholds"].split()] == pytest.approx(changes, rel=1e-15)
    half_sine = json.loads(run("response", "--pulse", "half_sine", *WHOLE[2:], "--format=json"))
    assert half_sine["pulse_duration"] == pytest.approx(0.25)
    near = run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:])
    assert near == run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:], "--restitution", "momentum")
    assert "warning: the outcome changes within 5 % of this peak acceleration: at 4.70006 m/s2" in near
    few, many = text.splitlines(), run("response", *WHOLE, "--all").splitlines()
    assert many[: len(few)] == few
    assert any(line.startswith("half_diagonal") for line in many[len(few) :])
    assert max(map(len, few)) <= 110
    assert len(few) < 20


def test_history_of_a_block_in_si_units():
    options = ["history", *WHOLE, "--samples=20", "--duration=900 ms", "--contact"]
    result = json.loads(run(*options, "--format=json"))
    expected = BLOCK.history("sine", peak_acceleration=4.0, period=0.5, samples=20, duration=0.9, contact=True)
    assert result["time"][-1] == pytest.approx(0.9)
    assert result["rotation_deg"] == pytest.approx(np.degrees(expected["rotation"].values), rel=1e-9)
    for name in ("time", "top_displacement", "normal_reaction", "friction_demand"):
        assert result[name] == pytest.approx(expected[name].values, rel=1e-9)
    assert result["acceleration"] == pytest.approx(expected["ground_acceleration"].values, rel=1e-9)
    assert result["impact_time_s"] == pytest.approx(expected["impact_time"].values, rel=1e-12)
    assert (result["lifts_off"], result["warnings"]) == (False, None)
    assert f"{result['largest_friction_demand']:.9g}" in run(*options)
    plain = run(*options[:-1])
    assert "angular_velocity_deg" in plain
    assert "friction_demand" not in plain


def test_spectrum_of_a_block_in_si_units():
    options = [*WHOLE[:8], "--period-min", "0.3s", "--period-max", "1.2s", "--points", "3"]
    result = json.loads(run("spectrum", *options, "--format=json"))
    assert result["period"] == pytest.approx([1.2, 0.6, 0.3])
    expected = BLOCK.spectrum("sine", peak_acceleration=4.0, period=result["period"])
    assert result["overturned"] == expected["overturned"].values.tolist()
    degrees = [math.nan if x is None else x for x in result["peak_rotation_deg"]]
    assert degrees == pytest.approx(np.degrees(expected["rotation"].values), rel=1e-9, nan_ok=True)
    assert run("spectrum", *options).splitlines()[-3].split()[0] == "0.3"
    assert "--period-max" in refused("spectrum", *options[:-4], "--period-max", "0.2s")


def test_boundary_of_a_block_in_si_units():
    result = json.loads(run("boundary", *UNITS[:6], "--period-min=0.4s", "--period-max=0.8s", "--format=json"))
    assert (min(result["period"]), max(result["period"])) == pytest.approx((0.4, 0.8))
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
    command = ("response", "--pulse", "sine", "--format=csv")
    rows = read_csv(run(*command, str(path)))
    assert [row["name"] for row in rows] == ["statue", "cabinet"]
    assert list(rows[0].values())[:5] == ["statue", "40", "1.6", "400", "500"]  # as they stand
    single = json.loads(run("response", *WHOLE, "--format=json"))
    for name, factor in (("peak_rotation_deg", 1.0), ("top_displacement", 100.0), ("slenderness", 1.0)):
        assert float(rows[0][name]) == pytest.approx(single[name] * factor, rel=1e-12)
    assert (rows[1]["overturned"], rows[1]["peak_rotation_deg"], rows[1]["restitution"]) == ("true", "", "0.9")
    as_json = json.loads(run("response", "--pulse", "sine", str(path), "--format=json"))
    assert as_json["outcome"] == [row["outcome"] for row in rows]
    named = TABLE.replace(",", ";").replace("statue", '"a\r\nb"').replace("cabinet", "=1+1").encode()
    printed = CliRunner().invoke(app, [*command, "-"], input=named).stdout_bytes.decode()
    piped = list(csv.DictReader(io.StringIO(printed, newline="")))
    assert [row.pop("name") for row in piped] == ["a\r\nb", "'=1+1"]
    assert [list(row.values()) for row in piped] == [list(row.values())[1:] for row in rows]
    path.write_text(TABLE.splitlines()[0])
    assert read_csv(run(*command, str(path))) == []


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (TABLE.replace("statue", '"statue'), "line 2: found unexpected end of data"),
        (TABLE.replace("[cm]", "[kg]"), "one of [m], [cm]"),
        (TABLE.replace("period [ms]", "colour"), "expected a column period"),
        (TABLE.replace("restitution", "width [m]"), "one column width"),
        ("", "expected a column width"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused(table, words):
    result = CliRunner().invoke(app, ["response", "--pulse", "sine", "-"], input=table)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "FILE" in result.stderr
    assert words in result.stderr


def test_rows_that_cannot_be_read_are_named_and_the_others_solved(tmp_path):
    path = tmp_path / "blocks.csv"
    path.write_text(
        "name;Breite;HEIGHT (m);Peak Acceleration [g];Period;Material;outcome\n"
        'A 1;20 cm;0,8;0,4;500 ms;"clay; ""red""";?\nA 2;big;0,8;0,4;500 ms;oak;\nA 3;20 cm;0,9;;500 ms;oak;\n'
    )
    command = ["response", "--pulse", "sine", str(path), "--columns", "Breite=width", "--decimal", ","]
    printed = CliRunner().invoke(app, [*command, "--format=csv"])
    assert printed.exit_code == 2
    said = [line.partition(": ")[0].removeprefix(f"{path}, ") for line in printed.stderr.splitlines()]
    assert said == ["row 3, width", "row 4, peak_acceleration"]
    assert "'big'; allowed: one number" in printed.stderr
    (row,) = csv.DictReader(io.StringIO(printed.stdout))
    assert list(row.values())[:7] == ["A 1", "20 cm", "0,8", "0,4", "500 ms", 'clay; "red"', "?"]
    found = rocking.Block(0.2, 0.8).response("sine", peak_acceleration="0.4 g", period=0.5)
    assert (row["outcome (given)"], row["outcome"]) == ("?", found.outcome.name)
    assert float(row["uplift_acceleration [g]"]) == pytest.approx(0.25, rel=1e-12)
    table = CliRunner().invoke(app, command).stdout
    assert table.splitlines()[1].split() == ["A", "1", found.outcome.name, "-", "-"]
    answer = json.loads(CliRunner().invoke(app, [*command, "--format=json"]).stdout)
    assert answer["table"]["Material"] == ['clay; "red"']
    assert [bad["row"] for bad in answer["bad_rows"]] == [3, 4]


def test_options_stand_for_what_a_table_lacks():
    table = "Width [cm],Height [cm]\n40,160\n"
    options = ["response", "--pulse", "sine", "--peak-acceleration", "400 gal", "--period", "0.5s", "-"]
    printed = CliRunner().invoke(app, [*options, "--format=json"], input=table)
    single = json.loads(run("response", *WHOLE, "--format=json"))
    assert json.loads(printed.stdout)["top_displacement"] == [pytest.approx(single["top_displacement"], rel=1e-12)]
    assert "peak_acceleration" in CliRunner().invoke(app, [*options[:3], "-"], input=table).stderr


def test_output_has_the_units_of_the_question():
    block = [*UNITS[:3], "40 cm", *UNITS[4:7], "0.4g", *UNITS[8:10]]
    si = json.loads(run("response", *block, "--format=json"))
    shown = (line.partition("]") for line in run("response", *block, "--all").splitlines())
    given = {name: value.strip() for name, _, value in shown}
    assert float(given["top_displacement [cm"]) == pytest.approx(100.0 * si["top_displacement"], rel=1e-8)
    assert float(given["height [cm"]) == 160.0
    assert float(given["uplift_acceleration [g"]) == pytest.approx(0.25, rel=1e-8)
    assert float(given["nearest_period [ms"]) == pytest.approx(1000.0 * si["nearest_period"], rel=1e-5)
    history = ["history", *block, "--samples", "5"]
    rows, si = read_csv(run(*history, "--format=csv")), json.loads(run(*history, "--format=json"))
    assert "time [ms]" in run(*history)
    assert [float(row["time"]) for row in rows] == pytest.approx([1000.0 * one for one in si["time"]], rel=1e-12)


def test_pulses_and_units_that_are_allowed_are_listed():
    rows = read_csv(run("pulses", "--format=csv"))
    assert [row["pulse"] for row in rows] == list(rocking.PULSE_NAMES)
    assert {row["pulse"]: float(row["periods"]) for row in rows}["half_sine"] == pytest.approx(0.5)
    assert all(row["description"] for row in rows)
    units = json.loads(run("units", "--format=json"))
    for unit, names, examples in zip(units["si_unit"], units["units"], units["examples"], strict=True):
        assert [si_value("x", f"1 {name}", unit) for name in names] == list(KNOWN_UNITS[unit].values())
        assert all(si_value("x", one, unit) > 0.0 for one in examples.split(", "))


def test_options_name_their_units_and_shells_complete_names():
    text = run("response", "--help")
    assert "--width" in text
    assert re.search(r"--width +\[m\]", text)
    assert re.search(r"--peak-acceleration +\[m/s2\]", text)
    completion = {"_ROCKING_COMPLETE": "complete_bash", "COMP_WORDS": "rocking response --pulse ric", "COMP_CWORD": "3"}
    found = CliRunner().invoke(app, [], env=completion, prog_name="rocking")
    assert found.stdout.split() == ["ricker", "ricker_antisymmetric"]


def test_no_help_is_cut_off_in_a_window_of_80_columns():
    def commands(group, *names):
        yield names
        for name, command in getattr(group, "commands", {}).items():
            yield from commands(command, *names, name)

    for names in commands(get_command(app)):
        found = CliRunner().invoke(app, [*names, "--help"], env={"COLUMNS": "80", "TERMINAL_WIDTH": "80"})
        assert "…" not in found.stdout, names


def test_exit_codes_are_those_of_the_help(monkeypatch, tmp_path):
    def interrupted(*_):
        raise KeyboardInterrupt

    def code(*arguments):
        return CliRunner().invoke(app, list(arguments)).exit_code

    text = " ".join(run("--help").split())
    stated = [int(one) for one in re.findall(r"[:;] (\d+) ", text.partition("Exit codes")[2])]
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    sheet = tmp_path / "a.xlsx"
    sheet.write_bytes(b"")
    assert code("assess", str(sheet), "--pga", "0.3g", "--pgv", "0.3m/s") == 1
    found = [code("units"), code("response", "--pulse", "sine", str(sheet)), code("respons")]
    monkeypatch.setattr("rocking._cli.printing.print_columns", interrupted)
    assert [*found, code("units")] == stated == [0, 1, 2, 130]


@pytest.mark.parametrize("words", ["respons", "response --pulse sine --width 3", "record", "units --format=x"])
def test_errors_are_one_line(words):
    printed = CliRunner().invoke(app, words.split())
    assert (printed.exit_code, printed.stdout) == (2, "")
    assert len(printed.stderr.splitlines()) == 1, printed.stderr
    assert "Value error" not in printed.stderr  # words of typer, not of this command


def test_block_that_lifts_off_has_no_friction_demand():
    options = [*GROUPS[:3], "0.2", "--frequency-ratio", "12", *GROUPS[6:], "--alpha", "45 deg", "--contact"]
    result = json.loads(run("history", *options, "--format=json"))
    assert (result["lifts_off"], result["largest_friction_demand"]) == (True, None)
    assert None in result["friction_demand"]
    assert "lifts off" in result["warnings"]
    assert any(row["friction_demand"] == "" for row in read_csv(run("history", *options, "--format=csv")))
    assert "the block lifts off" in run("history", *options)


def test_spectrum_in_three_formats(triangle):
    options = ["spectrum", "--pulse", triangle, "--slenderness", "0.6", "--restitution", "0.9", "--points", "7"]
    expected = peak_response(TRIANGLE, slenderness=0.6, frequency_ratio=np.geomspace(0.5, 12.0, 7), restitution=0.9)
    result = json.loads(run(*options, "--format=json"))
    assert result["outcome"] == [Outcome(code).name for code in expected.outcome]
    peaks = [math.nan if peak is None else peak for peak in result["peak_rotation"]]
    np.testing.assert_array_equal(peaks, expected.peak_rotation)
    assert len(read_csv(run(*options, "--format=csv"))) == 7
    assert run(*options).splitlines()[-1].endswith(str(expected.impacts[-1]))


def test_boundary_in_three_formats(triangle):
    options = ["boundary", "--pulse", triangle, *GROUPS[6:], "--frequency-ratio-min=2", "--frequency-ratio-max=3"]
    expected = overturning_boundary(TRIANGLE, restitution=0.85, frequency_ratio=(2.0, 3.0))
    result = json.loads(run(*options, "--format=json"))
    assert result["slenderness"] == expected["slenderness"].values.tolist()
    assert len(read_csv(run(*options, "--format=csv"))) == expected.sizes["point"]
    assert run(*options).splitlines()[0].split()[:2] == ["curve", "slenderness"]


TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")


@pytest.fixture
def triangle(tmp_path):
    path = tmp_path / "triangle.csv"
    path.write_text("time [s],acceleration [g]\n0,0\n0.3,0.5\n0.6,0\n")
    return str(path)


def test_a_pulse_from_a_file(triangle, tmp_path):
    result = json.loads(run("response", "--pulse", triangle, *GROUPS[2:], "--format=json"))
    expected = peak_response(TRIANGLE, slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    assert (result["pulse"], result["peak_rotation"]) == ("triangle", expected.peak_rotation)
    mirrored = json.loads(run("response", f"--pulse=-{triangle}", *GROUPS[2:], "--format=json"))
    assert (mirrored["pulse"], mirrored["peak_rotation"]) == ("-triangle", result["peak_rotation"])
    path = tmp_path / "blocks.csv"
    path.write_text("width [m],height [m],peak_acceleration [g],period [s]\n0.4,1.6,0.4,0.5\n")
    (row,) = read_csv(run("response", "--pulse", triangle, str(path), "--format=csv"))
    block = BLOCK.response(TRIANGLE, peak_acceleration="0.4 g", period=0.5)
    assert float(row["top_displacement"]) == block.displacement
    assert json.loads(run("response", "--pulse", triangle, *UNITS[2:], "--format=json"))["pulse_duration"] == 0.5
    path.write_text("0,0\n1,one\n")
    damaged = refused("response", "--pulse", str(path), *GROUPS[2:])
    assert "--pulse" in damaged
    assert "blocks.csv, line 2: one" in damaged


def test_a_name_of_a_pulse_is_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("sine", "sin"):
        (tmp_path / name).write_text("0\n1\n0\n")
    exact = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    assert json.loads(run("response", *GROUPS, "--format=json"))["peak_rotation"] == exact.peak_rotation
    assert json.loads(run("response", "--pulse", "sin", *GROUPS[2:], "--format=json"))["pulse"] == "sin"


TWO_ENDS = [
    [*command.split(), *UNITS[:count], "--period-max", "0.8s", "--frequency-ratio-min", "0.5"]
    for command, count in (("spectrum", 8), ("boundary", 6), ("plot map", 6))
]
"""Commands with two options for one end of a window, the second with its default in some."""


@pytest.mark.parametrize(
    ("arguments", "option", "allowed"),
    [
        (["response", *GROUPS[:-1], "1.5"], "--restitution", "[0, 1]"),
        (["response", *GROUPS[:-1], "bouncy"], "--restitution", "or a number"),
        (["response", "--pulse", "sinus", *GROUPS[2:]], "--pulse", "one of sine"),
        (["response", *GROUPS[:4], "--restitution", "0.85"], "--frequency-ratio", "a number"),
        (["response", *GROUPS, "--alpha", "20"], "--alpha", "20 deg"),
        (["response", *GROUPS, "--width", "2m"], "--slenderness", "either groups"),
        (["response", *GROUPS, "--format=xml"], "--format", "'table', 'csv', 'json'"),
        (["response", *UNITS[:3], "20", *UNITS[4:]], "--width", "missing unit: write 20m (such as 0.3 m"),
        (["response", *UNITS[:3], "-1 m", *UNITS[4:]], "--width", "(0, inf)"),
        (["response", *UNITS[:8], *UNITS[10:]], "--period", "required"),
        (["history", *GROUPS, "--samples", "1"], "--samples", "[2,"),
        (["boundary", "--pulse", "sine", "--restitution", "0.85", "--frequency-ratio-max", "0.1"],
         "--frequency-ratio-max", "(0.2, 1e+09]"),
        *((command, "--frequency-ratio-min", "either this or --period-max") for command in TWO_ENDS),
        ([*TWO_ENDS[1][:-4], "--period-min", "0.4s", "--frequency-ratio-max", "12"],
         "--frequency-ratio-max", "either this or --period-min"),
        (["serve", "--port", "99999"], "--port", "65535"),
        (["serve", "--results", ""], "--results", "the name of a folder"),
        (["serve", "--results", "nowhere"], "--results", "a folder that exists"),
        (["response", *UNITS[:7], "4", *UNITS[8:]], "--peak-acceleration", "missing unit: write 4m/s2 or 4g (such as"),
        (["history", *UNITS, "--duration", "2"], "--duration", "missing unit: write 2s"),
        (["response", "--pulse", "sine", "-", "--width", "1m"], "--width", "not allowed"),
        (["response", "--pulse", "no.csv", *GROUPS[2:]], "--pulse", "no.csv': no such file"),
        (["response", *UNITS, "--offset=21cm"], "--offset", "'21cm' is not allowed; allowed: less than half the width"),
        (["history", *UNITS, "--mass-height=0m"], "--mass-height", "(0, "),
        (["response", *UNITS, "--left", "1m"], "--body", ""),
        (["response", "--body", "hollow(width=40cm)", *UNITS], "--width", ""),
        (["response", "--body", "hollow(width=40cm)", *UNITS[:2], *UNITS[6:]], "--height", ""),
        (["response", *UNITS, "--gyration", "5"], "--gyration", "missing unit: write 5m"),
        (["response", "blocks.csv", "--pulse=sine", "--offset=3cm"], "--offset", "allowed: no blocks"),
    ],
)  # fmt: skip
def test_errors_name_the_option_and_the_allowed_values(arguments, option, allowed):
    output = refused(*arguments)
    assert option in output
    assert allowed in output


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


@pytest.mark.parametrize(
    "words",
    [
        ["assess", "no.csv", "--pga", "0.3g", "--pgv", "30cm/s"],
        ["assess", "no.xlsx", "--pga", "0.3g", "--pgv", "30cm/s"],
        ["record", "no.at2", "--width", "0.4m", "--height", "1.6m"],
        ["response", "no.csv", "--pulse", "sine"],
        ["fragility", "no.yaml"],
        ["identify", "no.csv"],
    ],
)
def test_a_file_that_is_missing_is_no_such_file(words):
    message = refused(*words)
    assert f"{words[1]}': no such file" in message.replace(f"{words[1]}:", f"{words[1]}':")
    assert "allowed" not in message


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--width=40cm", "--height=1.6m", "--gyration=0.5m"), "offset_mass(width=0.4m,height=1.6m,gyration=50cm)"),
        ((*UNITS[2:6], "--offset=3cm"), "offset_mass(width=0.4m, height=1.6m, offset=3cm)"),
        (("--diameter", "40cm", "--height", "1.6 m"), "cylinder(diameter=0.4m, height=160cm)"),
        (("--left=12cm", "--right=18cm", "--mass-height=40cm"), "two_edges(left=0.12m, right=0.18m, mass_height=0.4m)"),
        (("--body", "hollow(width=40cm, height=1.6m, wall=2cm)"), "hollow(width=0.4m, height=1.6m, wall=0.02m)"),
        (("--body", "frame(width=40cm, height=3m, mass_ratio=2)"), "frame(width=0.4m, height=3m, mass_ratio=2)"),
    ],
)  # fmt: skip
def test_kinds_of_bodies_are_options(options, text):
    motion = ("--pulse", "sine", "--peak-acceleration", "0.4 g", "--period", "0.5s")
    found = json.loads(run("response", *options, *motion, "--format", "json"))
    expected = rocking.body(text).response("sine", peak_acceleration="0.4 g", period="0.5 s")
    assert found["peak_rotation"] == expected.summary()["peak_rotation"]
    moved = rocking.body(text).history("sine", peak_acceleration="0.4 g", period="0.5 s")
    history = json.loads(run("history", *options, *motion, "--format", "json"))
    assert history["rotation_deg"] == np.degrees(moved["rotation"].values).tolist()
    spectrum = json.loads(run("spectrum", *options, *motion[:4], "--points", "3", "--format", "json"))
    assert len(spectrum["period"]) == len(spectrum["peak_rotation_deg"]) == 3
