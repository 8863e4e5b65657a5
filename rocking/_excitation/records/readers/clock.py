"""Times of day in a column, such as `12:00:00.010` or `2019-02-03T12:00:00,010Z`: seconds since the first of them."""

import re
from dataclasses import replace

from rocking._excitation.records.readers.lines import TextFile

_TIME = (
    r"(?<![\w:./-])(?:\d{1,4}([-/.])\d\d?\1\d{1,4}[T \t,;])?(\d\d?):(\d\d):(\d\d)(?:[.,](\d{1,9}))?"
    r"(?:Z|[+-]\d\d:?\d\d)?(?![\w:.])"
)
CLOCK = re.compile(_TIME, re.ASCII | re.IGNORECASE)
"""A time of day, with a date before it or without."""

_BYTES = re.compile(_TIME.encode(), re.IGNORECASE)
_DAY = 86400 * 10**9  # [ns]


def in_seconds(file: TextFile, first: int) -> TextFile:
    """The file with seconds in place of times of day from a line on, as exact as they are; after midnight they go on.

    Dates are not read: a record is shorter than a day.
    """
    start, last, days = -1, 0, 0

    def seconds(found: re.Match[bytes]) -> bytes:
        nonlocal start, last, days
        if file.stop is not None:
            file.stop.check()
        hour, minute, second, decimals = (found[k] or b"" for k in (2, 3, 4, 5))
        time = (60 * (60 * int(hour) + int(minute)) + int(second)) * 10**9 + int(decimals.ljust(9, b"0"))
        days += time + _DAY // 2 < last
        start, last = time if start < 0 else start, time
        whole, rest = divmod(time + days * _DAY - start, 10**9)
        digits = b"%09d" % rest
        return b"%d.%s" % (whole, digits[: max(len(decimals), len(digits.rstrip(b"0")))])

    begin = file.start_of(first)
    return replace(file, content=file.content[:begin] + _BYTES.sub(seconds, file.content[begin:]))
