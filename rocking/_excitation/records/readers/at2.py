"""PEER AT2: three lines of text, a line with NPTS and DT, then values, five on a line.

The third line states the unit, `ACCELERATION TIME SERIES IN UNITS OF G`; the fourth has one of the forms
`NPTS=  4000, DT= .01000 SEC`, `NPTS 4000 DT 0.01` or, in older files, `4000 0.0100 NPTS, DT`.
"""

from rocking._base.units import unit_name
from rocking._excitation.records.readers.layout import Layout, Samples
from rocking._excitation.records.readers.text_file import TextFile, is_number

UNIT_LINE = 2
COUNT_LINE = 3


def is_at2(file: TextFile) -> bool:
    """Return True if the fourth line states NPTS and DT."""
    return len(file.head) > COUNT_LINE and {"NPTS", "DT"} <= {*_words(file.head[COUNT_LINE])}


def read(file: TextFile, layout: Layout) -> Samples:
    """Read an AT2 file."""
    layout.refuse_columns(file, "AT2")
    if not is_at2(file):
        raise file.error(COUNT_LINE, "no NPTS and DT", "a form such as NPTS=  4000, DT= .01000 SEC")
    words = _words(file.head[COUNT_LINE])
    file.line = COUNT_LINE  # of what is wrong with the words
    if is_number(words[0]):
        count_text, step_text = words[:2]
    else:
        count_text, step_text = words[words.index("NPTS") + 1], words[words.index("DT") + 1]
    count = file.size(COUNT_LINE, count_text, "the number of points NPTS")
    step = file.number(COUNT_LINE, step_text.rstrip("SEC."), "the time step DT [s]")
    unit_line = file.head[UNIT_LINE]
    file.check_words(UNIT_LINE, unit_line)
    remarks: list[str] = []
    unit = layout.agreed_unit(unit_name(unit_line.upper().partition("UNITS OF")[2], "m/s2"), remarks)
    if unit is None:
        raise file.error(UNIT_LINE, unit_line.strip(), "IN UNITS OF G, as AT2 has it; or `unit`")
    agreed_step = layout.agreed_step(step, remarks)
    values = file.values(COUNT_LINE + 1)
    remarks += file.count_remarks(values, count, COUNT_LINE)
    name = file.head[1].strip() or file.name
    return Samples(values, agreed_step or step, unit, name, f"{file.name} (PEER AT2)", remarks)


def _words(line: str) -> list[str]:
    return line.upper().replace("=", " ").replace(",", " ").replace(":", " ").split()
