"""ESM ASCII (Engineering Strong-Motion database, DYNA 1.2): 64 lines `KEY: value`, then one value a line."""

from rocking._base.units import unit_name
from rocking._excitation.records.readers.layout import Layout, Samples
from rocking._excitation.records.readers.text_file import TextFile

HEADER_LINES = 64


def is_esm(file: TextFile) -> bool:
    """Return True if the file starts with the key EVENT_NAME and has the key SAMPLING_INTERVAL_S."""
    if not file.head[0].startswith("EVENT_NAME:"):
        return False
    return any(line.startswith("SAMPLING_INTERVAL_S:") for line in file.head[:HEADER_LINES])


def read(file: TextFile, layout: Layout) -> Samples:
    """Read an ESM file."""
    layout.refuse_columns(file, "ESM")
    lines: dict[str, int] = {}
    texts: dict[str, str] = {}
    for k, line in enumerate(file.head[:HEADER_LINES]):
        key, _, text = line.partition(":")
        lines[key] = k
        texts[key] = text.strip()
    for key in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS"):
        if key not in texts:
            raise file.error(None, f"no header line {key}", f"{HEADER_LINES} lines `KEY: value`".replace("`", ""))
    kind = texts.get("DATA_TYPE", "ACCELERATION")
    if kind != "ACCELERATION":
        raise file.error(lines["DATA_TYPE"], kind, "DATA_TYPE: ACCELERATION")
    step = file.number(lines["SAMPLING_INTERVAL_S"], texts["SAMPLING_INTERVAL_S"], "the sampling interval [s]")
    count = file.size(lines["NDATA"], texts["NDATA"], "the number of values")
    remarks: list[str] = []
    unit = layout.agreed_unit(unit_name(texts["UNITS"], "m/s2"), remarks)
    if unit is None:
        raise file.error(lines["UNITS"], texts["UNITS"], "a unit of acceleration, such as cm/s^2; or `unit`")
    values = file.values(HEADER_LINES)
    remarks += file.count_remarks(values, count, lines["NDATA"])
    codes = [texts.get(key, "") for key in ("NETWORK", "STATION_CODE", "LOCATION", "STREAM")]
    event = texts.get("EVENT_NAME") or texts.get("EVENT_ID", "")
    source = "; ".join(filter(None, [f"{file.name} (ESM ASCII)", event]))
    name = ".".join(codes).strip(".") or file.name
    return Samples(values, layout.agreed_step(step, remarks) or step, unit, name, source, remarks)
