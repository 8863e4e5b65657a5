"""ESM ASCII files (Engineering Strong-Motion database, DYNA format): 64 lines `KEY: value`, then one value a line."""

from rocking._excitation.records.readers.lines import TextFile, agreed_step, agreed_unit, joined, parse_unit
from rocking._excitation.records.record import Record

HEADER_LINES = 64


def is_esm(file: TextFile) -> bool:
    """Whether the header has the keys of the format."""
    keys = {line.split(":", 1)[0].strip().upper() for line in file.head[:HEADER_LINES] if ":" in line}
    return {"SAMPLING_INTERVAL_S", "UNITS"} <= keys or {"SAMPLING_INTERVAL_S", "NDATA"} <= keys


def read(file: TextFile, unit: str | None, time_step: float | None) -> Record:
    """Read an ESM file; arguments and errors as for `read_record`."""
    header: dict[str, tuple[int, str]] = {}
    first = 0
    while first < len(file.head) and ":" in file.head[first]:
        key, value = file.head[first].split(":", 1)
        header[key.strip().upper()] = first, value.strip()
        first += 1

    def entry(key: str) -> tuple[int, str]:
        if key not in header:
            raise file.error(None, f"no header line {key}", f"one within {HEADER_LINES} lines `KEY: value`")
        return header[key]

    kind = header.get("DATA_TYPE", (0, "ACCELERATION"))
    if kind[1].upper() not in ("ACCELERATION", ""):
        raise file.error(kind[0], kind[1], "DATA_TYPE: ACCELERATION")
    line, text = entry("SAMPLING_INTERVAL_S")
    step = agreed_step(file, line, file.positive(line, text, "the sampling interval [s]"), time_step)
    unit_line, unit_text = header.get("UNITS", (line, ""))
    stated = parse_unit(unit_text)
    if unit_text and stated is None and unit is None:
        raise file.error(unit_line, unit_text, "a unit of acceleration, such as cm/s^2")
    agreed = agreed_unit(file, unit_line, stated, unit)
    count_line, count_text = entry("NDATA")
    count = file.count(count_line, count_text, "the number of values NDATA")
    values = file.values(first)
    remarks = file.checked_count(values, count, count_line)
    codes = [header.get(key, (0, ""))[1] for key in ("NETWORK", "STATION_CODE", "LOCATION", "STREAM")]
    name = ".".join(codes).strip(".") or file.name
    event = header.get("EVENT_NAME", (0, ""))[1] or header.get("EVENT_ID", (0, ""))[1]
    source = joined([f"{file.name} (ESM ASCII)", event])
    return Record(values, step, agreed, name=name, source=source, remarks=remarks)
