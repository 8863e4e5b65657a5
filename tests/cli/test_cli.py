"""The `rocking` command: responses in three formats, and errors that name the option."""

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
from rocking._cli.app import app
from rocking._model.response import Outcome

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
    expected = BLOCK.response("sine", peak_acceleration=4.0, period=0.5)
    result = json.loads(run("response", *WHOLE, "--format=json"))
    assert {name: result[name] for name in expected.summary()} == expected.summary()
    assert result["thresholds"] == expected.changes
    assert [change["overturns_above"] for change in result["thresholds"]] == [True, False, True]
    (row,) = read_csv(run("response", *WHOLE, "--format=csv"))
    assert float(row["peak_rotation"]) == result["peak_rotation"]
    assert row["overturned"] == "false"
    accelerations = [change["peak_acceleration"] for change in result["thresholds"]]
    assert [float(text) for text in row["thresholds"].split()] == accelerations
    lines = run("response", *WHOLE).splitlines()
    assert lines[:2] == [expected.sentence, expected.margin]
    assert ["peak_rotation_deg", "[deg]", "7.41882221"] in [line.split() for line in lines]
    assert "overturns above 4.70006, survives above 13.1272, overturns above 13.9939" in lines[-2]
    half_sine = json.loads(run("response", "--pulse", "half_sine", *WHOLE[2:], "--format=json"))
    assert half_sine["pulse_duration"] == pytest.approx(0.25)
    near = run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:])
    assert near == run("response", *WHOLE[:7], "4.6 m/s^2", *WHOLE[8:], "--restitution", "momentum")
    assert "warning: the outcome changes within 5 % of this peak acceleration: at 4.70006 m/s2" in near


def test_first_line_states_that_the_rocking_model_does_not_apply():
    cube = ["--width", "1.0m", "--height", "1.0m", "--peak-acceleration", "1.5g"]
    options = ["response", *UNITS[:2], *cube, *UNITS[8:]]
    assert run(*options).startswith("would slide: the rocking model does not apply")
    result = json.loads(run(*options, "--format=json"))
    assert (result["outcome"], result["rocking_model_applies"]) == ("RECOVERS", False)
    assert result["friction_demand"] == pytest.approx(17.9, abs=0.1)


def test_history_in_three_formats(triangle):
    options = ["history", "--pulse", triangle, *WHOLE[2:], "--samples=20", "--duration=900 ms", "--contact"]
    expected = BLOCK.history(TRIANGLE, peak_acceleration=4.0, period=0.5, samples=20, duration=0.9, contact=True)
    result = json.loads(run(*options, "--format=json"))
    for name in ("time", "rotation", "displacement", "normal_reaction", "impact_time"):
        assert result[name] == expected[name].values.tolist()
    assert (result["lifts_off"], result["outcome"]) == (0, expected.attrs["outcome"])
    rows = read_csv(run(*options, "--format=csv"))
    assert [float(row["time"]) for row in rows] == expected["time"].values.tolist()
    text = run(*options)
    assert f"{result['largest_friction_demand']:.9g}" in text
    assert "angular_velocity [rad/s]" in text
    assert "friction_demand" not in run(*options[:-1])


def test_spectrum_in_three_formats():
    options = ["spectrum", *WHOLE[:8], "--period-min", "0.3s", "--period-max", "1.2s", "--points", "3"]
    result = json.loads(run(*options, "--format=json"))
    assert result["period"] == pytest.approx([0.3, 0.6, 1.2])
    expected = BLOCK.spectrum("sine", peak_acceleration=4.0, period=result["period"])
    assert result["overturned"] == expected["overturned"].values.tolist()
    assert result["outcome"] == [Outcome(code).name for code in expected["outcome"].values]
    rotation = [math.nan if value is None else value for value in result["rotation"]]
    np.testing.assert_array_equal(rotation, expected["rotation"])
    assert len(read_csv(run(*options, "--format=csv"))) == 3
    assert run(*options).splitlines()[-3].split()[0] == "0.3"
    usual = json.loads(run(*options[:9], "--points=2", "--format=json"))
    assert usual["frequency_ratio"] == pytest.approx([12.0, 0.5])
    assert "--period-max" in refused(*options[:-4], "--period-max", "0.2s")


def test_boundary_in_three_formats():
    options = ["boundary", *UNITS[:6], "--period-min=0.4s", "--period-max=0.8s"]
    result = json.loads(run(*options, "--format=json"))
    assert (min(result["period"]), max(result["period"])) == pytest.approx((0.4, 0.8))
    point = int(np.argmin(np.abs(np.array(result["period"]) - 0.6)))
    period, acceleration = result["period"][point], result["peak_acceleration"][point]
    response = BLOCK.response("sine", peak_acceleration=4.0, period=period)
    assert min(abs(change.value / acceleration - 1.0) for change in response.thresholds) < 1e-9
    assert len(read_csv(run(*options, "--format=csv"))) == len(result["period"])
    assert run(*options).splitlines()[0].split()[:2] == ["curve", "period"]


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
    for name in ("peak_rotation_deg", "displacement", "slenderness"):
        assert float(rows[0][name]) == pytest.approx(single[name], rel=1e-12)
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
    rows = [line.partition(": ")[0].removeprefix(f"{path}, ") for line in printed.stderr.splitlines()]
    assert rows == ["row 3, width", "row 4, peak_acceleration"]
    assert "'big'; allowed: one number" in printed.stderr
    (row,) = csv.DictReader(io.StringIO(printed.stdout))
    assert list(row.values())[:7] == ["A 1", "20 cm", "0,8", "0,4", "500 ms", 'clay; "red"', "?"]
    response = rocking.Block(0.2, 0.8).response("sine", peak_acceleration="0.4 g", period=0.5)
    assert (row["outcome (given)"], row["outcome"]) == ("?", response.outcome.name)
    assert float(row["uplift_acceleration [m/s2]"]) == pytest.approx(response.uplift_acceleration, rel=1e-12)
    table = CliRunner().invoke(app, command).stdout
    assert table.splitlines()[1].split()[:7] == ["A", "1", "-", "-", "-", "-", "yes"]
    answer = json.loads(CliRunner().invoke(app, [*command, "--format=json"]).stdout)
    assert answer["table"]["Material"] == ['clay; "red"']
    assert [bad["row"] for bad in answer["bad_rows"]] == [3, 4]


def test_options_stand_for_what_a_table_lacks():
    table = "Width [cm],Height [cm]\n40,160\n"
    options = ["response", "--pulse", "sine", "--peak-acceleration", "400 gal", "--period", "0.5s", "-"]
    printed = CliRunner().invoke(app, [*options, "--format=json"], input=table)
    single = json.loads(run("response", *WHOLE, "--format=json"))
    assert json.loads(printed.stdout)["displacement"] == [pytest.approx(single["displacement"], rel=1e-12)]
    assert "peak_acceleration" in CliRunner().invoke(app, [*options[:3], "-"], input=table).stderr


def test_options_name_their_units_and_shells_complete_names():
    text = run("response", "--help")
    assert "--width" in text
    assert re.search(r"--width +\[m\]", text)
    assert re.search(r"--peak-acceleration +\[m/s2\]", text)
    completion = {"_ROCKING_COMPLETE": "complete_bash", "COMP_WORDS": "rocking response --pulse ric", "COMP_CWORD": "3"}
    completed = CliRunner().invoke(app, [], env=completion, prog_name="rocking")
    assert completed.stdout.split() == ["ricker", "ricker_antisymmetric"]


def test_no_help_is_cut_off_in_a_window_of_80_columns():
    def commands(group, *names):
        yield names
        for name, command in getattr(group, "commands", {}).items():
            yield from commands(command, *names, name)

    for names in commands(get_command(app)):
        printed = CliRunner().invoke(app, [*names, "--help"], env={"COLUMNS": "80", "TERMINAL_WIDTH": "80"})
        assert "…" not in printed.stdout, names


def test_exit_codes_are_those_of_the_help(monkeypatch, tmp_path):
    def interrupted(*_):
        raise KeyboardInterrupt

    def code(*arguments):
        return CliRunner().invoke(app, list(arguments)).exit_code

    text = " ".join(run("--help").split())
    documented = [int(digits) for digits in re.findall(r"[:;] (\d+) ", text.partition("Exit codes")[2])]
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    sheet = tmp_path / "a.xlsx"
    sheet.write_bytes(b"")
    assert code("assess", str(sheet), "--pga", "0.3g", "--pgv", "0.3m/s") == 1
    codes = [code("response", *WHOLE), code("response", "--pulse", "sine", str(sheet)), code("respons")]
    monkeypatch.setattr("rocking._cli.printing.print_response", interrupted)
    assert [*codes, code("response", *WHOLE)] == documented == [0, 1, 2, 130]


def test_block_that_lifts_off_has_no_friction_demand():
    options = ["history", "--pulse=sine", "--width=1m", "--height=1m", "--peak-acceleration=5g", "--period=0.3s"]
    options += ["--restitution=0.85", "--contact"]
    result = json.loads(run(*options, "--format=json"))
    assert (result["lifts_off"], result["largest_friction_demand"]) == (1, None)
    assert None in result["friction_demand"]
    assert "lifts off" in result["warnings"]
    assert any(row["friction_demand"] == "" for row in read_csv(run(*options, "--format=csv")))
    assert "the block lifts off" in run(*options)


TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")


@pytest.fixture
def triangle(tmp_path):
    path = tmp_path / "triangle.csv"
    path.write_text("time [s],acceleration [g]\n0,0\n0.3,0.5\n0.6,0\n")
    return str(path)


def test_a_pulse_from_a_file(triangle, tmp_path):
    expected = BLOCK.response(TRIANGLE, peak_acceleration=4.0, period=0.5)
    result = json.loads(run("response", "--pulse", triangle, *WHOLE[2:], "--format=json"))
    assert (result["pulse"], result["peak_rotation"]) == ("triangle", expected.peak_rotation)
    assert result["pulse_duration"] == 0.5
    mirrored = json.loads(run("response", f"--pulse=-{triangle}", *WHOLE[2:], "--format=json"))
    assert (mirrored["pulse"], mirrored["peak_rotation"]) == ("-triangle", result["peak_rotation"])
    path = tmp_path / "blocks.csv"
    path.write_text("width [m],height [m],peak_acceleration [g],period [s]\n0.4,1.6,0.4,0.5\n")
    (row,) = read_csv(run("response", "--pulse", triangle, str(path), "--format=csv"))
    block = BLOCK.response(TRIANGLE, peak_acceleration="0.4 g", period=0.5)
    assert float(row["displacement"]) == block.displacement
    path.write_text("0,0\n1,one\n")
    damaged = refused("response", "--pulse", str(path), *WHOLE[2:])
    assert "--pulse" in damaged
    assert "blocks.csv, line 2: one" in damaged


def test_a_name_of_a_pulse_is_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("sine", "sin"):
        (tmp_path / name).write_text("0\n1\n0\n")
    exact = BLOCK.response("sine", peak_acceleration=4.0, period=0.5)
    assert json.loads(run("response", *WHOLE, "--format=json"))["peak_rotation"] == exact.peak_rotation
    assert json.loads(run("response", "--pulse", "sin", *WHOLE[2:], "--format=json"))["pulse"] == "sin"


@pytest.mark.parametrize(
    ("arguments", "option", "allowed"),
    [
        (["response", *UNITS[:-1], "1.5"], "--restitution", "[0, 1]"),
        (["response", *UNITS[:-1], "bouncy"], "--restitution", "or a number"),
        (["response", "--pulse", "sinus", *UNITS[2:]], "--pulse", "one of sine"),
        (["response", *UNITS, "--format=xml"], "--format", "'table', 'csv', 'json'"),
        (["response", *UNITS[:3], "20", *UNITS[4:]], "--width", "missing unit: write 20m (such as 0.3 m"),
        (["response", *UNITS[:3], "-1 m", *UNITS[4:]], "--width", "(0, inf)"),
        (["response", *UNITS[:8], *UNITS[10:]], "--period", "missing"),
        (["response", *UNITS[:2], *UNITS[4:]], "--width", "a body of another kind by --body"),
        (["response", *UNITS[:7], "4", *UNITS[8:]], "--peak-acceleration", "missing unit: write 4m/s2 or 4g (such as"),
        (["response", "--pulse", "sine", "-", "--width", "1m"], "--width", "nothing for a table"),
        (["response", "--pulse", "no.csv", *UNITS[2:]], "--pulse", "no.csv': no such file"),
        (["response", "--body", "hollow(width=40cm)", *UNITS], "--width", "nothing for --body"),
        (["response", "--body", "hollow(width=40cm)", *UNITS[:2], *UNITS[6:]], "--height", "required for hollow"),
        (["history", *UNITS, "--samples", "1"], "--samples", "[2,"),
        (["history", *UNITS, "--duration", "2"], "--duration", "missing unit: write 2s"),
        (["history", *UNITS[2:6]], "--pulse", "--start"),
        (["spectrum", *WHOLE[:8], "--points", "1"], "--points", "greater than or equal to 2"),
        (["boundary", *UNITS[:6], "--period-min", "0.8s", "--period-max", "0.4s"], "--period-max", "(0.8, inf)"),
        (["serve", "--port", "99999"], "--port", "65535"),
        (["serve", "--results", ""], "--results", "the name of a folder"),
        (["serve", "--results", "nowhere"], "--results", "a folder that exists"),
    ],
)
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
    "text", ["hollow(width=40cm, height=1.6m, wall=2cm)", "two_edges(left=12cm, right=18cm, mass_height=40cm)"]
)
def test_bodies_of_other_kinds(text):
    motion = ("--pulse", "sine", "--peak-acceleration", "0.4 g", "--period", "0.5s")
    response = json.loads(run("response", "--body", text, *motion, "--format", "json"))
    expected = rocking.body(text).response("sine", peak_acceleration="0.4 g", period="0.5 s")
    assert response["peak_rotation"] == expected.summary()["peak_rotation"]
    moved = rocking.body(text).history("sine", peak_acceleration="0.4 g", period="0.5 s")
    history = json.loads(run("history", "--body", text, *motion, "--format", "json"))
    assert history["rotation"] == moved["rotation"].values.tolist()
    spectrum = json.loads(run("spectrum", "--body", text, *motion[:4], "--points", "3", "--format", "json"))
    assert len(spectrum["period"]) == len(spectrum["rotation"]) == 3
