"""The text of one sheet: the process of the page of objects that reads spreadsheets."""

from __future__ import annotations

import sys
from pathlib import Path

from rocking_api.limited_process import print_result

from rocking.extension import MAX_CHARACTERS, InvalidArgumentError, csv_of_sheet


def main(path: str) -> None:
    """Print the first sheet of a file as CSV, or an error."""

    def read() -> dict[str, str]:
        text = csv_of_sheet(Path(path).read_bytes(), "table")
        if len(text) > MAX_CHARACTERS:
            raise InvalidArgumentError("table", len(text), f"a table of at most {MAX_CHARACTERS} characters")
        return {"text": text}

    print_result(read)


if __name__ == "__main__":
    main(*sys.argv[1:])
