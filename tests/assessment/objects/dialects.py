"""Tables of known objects in random layouts: what is read is the truth, or is refused with a reason."""

from __future__ import annotations

import csv
import io
import random
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any

from rocking_assessment._objects.tables import ObjectTable

GRAVITY = Decimal("9.80665")
FACTORS = {
    "mm": Decimal("0.001"), "cm": Decimal("0.01"), "m": Decimal(1), "in": Decimal("0.0254"), "ft": Decimal("0.3048"),
    "kg": Decimal(1), "g": Decimal("0.001"), "t": Decimal(1000), "lb": Decimal("0.45359237"), "kN": 1000 / GRAVITY,
    "%": Decimal("0.01"), "": Decimal(1),
}  # fmt: skip
RANGES = {"mm": (40, 2900, 0), "cm": (4, 290, 1), "m": (0.04, 2.9, 3), "in": (2, 110, 2), "ft": (0.2, 9, 2),
          "kg": (1, 900, 1), "g": (100, 90_000, 0), "t": (0.01, 3, 2), "lb": (2, 900, 1), "kN": (0.02, 9, 2),
          "%": (5, 95, 0), "": (0.05, 0.95, 2)}  # fmt: skip
"""Of the numbers in each unit, and their decimals."""

LENGTHS = ("mm", "cm", "m", "in", "ft")
OF = {"width": LENGTHS, "depth": LENGTHS, "height": LENGTHS, "diameter": LENGTHS,
      "mass": ("kg", "g", "t", "lb", "kN"), "friction": ("%", ""), "restitution": ("%", "")}  # fmt: skip

HEADERS: dict[str, tuple[str, ...]] = {
    "name": ("name", "Object", "Title", "Bezeichnung", "Oggetto", "Objet", "Objeto"),
    "number": ("Inventory number", "Inv. no.", "No.", "Inventarnummer", "Accession Number", "ID"),
    "width": ("width", "Breite", "Larghezza", "Largeur", "Ancho", "W", "Width (W)", "base width", "Breadth",
              "Breite / Width", "ΠΛΑΤΟΣ"),
    "depth": ("depth", "Tiefe", "Profondità", "Profondeur", "Profundidad", "D", "Depth D"),
    "height": ("height", "Höhe", "Altezza", "Hauteur", "Altura", "H", "Overall height", "ύψος"),
    "diameter": ("diameter", "Durchmesser", "Diametro", "Diamètre", "Ø", "Ø base", "Dia.", "base diameter"),
    "mass": ("mass", "Weight", "Gewicht", "Peso", "Poids", "Massa"),
    "friction": ("friction", "friction coefficient", "Reibung", "Attrito", "mu", "COF"),
    "restitution": ("restitution", "coefficient of restitution", "eta"),
}  # fmt: skip
DEPTHS = ("thickness", "Dicke", "Épaisseur", "Spessore", "Espesor", "Length", "L", "Länge", "Longueur", "T")
UNKNOWN = ("girth", "front side", "base", "E2", "second base dimension", "Kantenlänge", "Schmalseite")
"""Names of a depth that are read as one, and that are not."""

TEXTS = {"Material": ("marble", "bronze, gilded", "clay; fired"), "Location": ("hall 3", "2nd floor", "stair (m)"),
         "Remarks": ("loan, 12.5 % insured", "see 1,234", "", "60 x 12 x 150 cm"), "Year": ("1920", "1,845", "ca. 300"),
         "Value [CHF]": ("1'200", "12.50", "n/a"), "Made in": ("1780", "Rome"), "Quantity": ("1", "2")}  # fmt: skip
TITLES = (
    ["Collection of the museum"], ["Objects (m)", "Hall 3 (ft)"], ["Inventory", "2024", "12,5", "cm"],
    ["Width, height and depth of objects", "in storage (mm)"], ["Date: 12.05.2026", "Editor: A. B."], [],
    ["Weights in lb", "rooms 1-4"], ["Mass: see list", "Height: see list"], ["Survey 7 (CM)"], ["unit", "hall"],
)  # fmt: skip
MISSING = ("", "-", "n/a", "–", "?", "N/A")
TOTALS = ("Total", "Summe:", "Total (all objects)", "Somma: 3", "Total objects", "Grand total", "Zwischensumme", "SD")


@dataclass
class Dialect:
    """A table, its objects by name, and texts that stay with them."""

    rows: list[list[str | float]]
    objects: dict[str, dict[str, Any]]
    details: dict[str, dict[str, str]] = field(default_factory=dict)
    delimiter: str = ","
    encoding: str = "utf-8"
    end: str = "\n"

    @property
    def raw(self) -> bytes:
        """The table as the bytes of a text."""
        text = io.StringIO(newline="")
        csv.writer(text, delimiter=self.delimiter, lineterminator=self.end).writerows(self.rows)
        return text.getvalue().encode(self.encoding, "replace")


class Writer:
    """Random decisions about one table."""

    def __init__(self, seed: int, *, typed: bool = False) -> None:
        self.dice = random.Random(seed)
        self.typed = typed  # numbers of some cells are numbers, as in a workbook
        pick = self.dice.choice
        self.delimiter = pick(",;\t|")
        self.point = pick(".,")
        self.mixed = self.dice.random() < 0.2
        self.fractions, self.wide = self.dice.random() < 0.5, self.dice.random() < 0.1
        self.grouping = pick(["", " ", "'", "" if self.mixed else "," if self.point == "." else "."])  # of thousands
        if self.delimiter == "," and self.grouping == "." and not typed:
            self.grouping = ""  # between commas, one point is a decimal sign
        self.style = pick(["header", "header", "cells", "line", "column", "columns", "group", "title", "none"])
        kept = ["mass", "friction", "restitution"]
        self.round = self.dice.random() < 0.4
        self.columns = ["width", "height", *(["diameter"] if self.round else [])]
        self.columns += ["depth"] if self.dice.random() < 0.8 else []
        self.columns += [one for one in kept if self.dice.random() < 0.4]
        self.columns += ["name"] if self.dice.random() < 0.9 else []
        self.columns += ["number"] if self.dice.random() < 0.4 or "name" not in self.columns else []
        self.columns += self.dice.sample(sorted(TEXTS), self.dice.randrange(4))
        self.dice.shuffle(self.columns)
        self.units = {one: pick(OF[one]) for one in self.columns if one in OF}
        if self.style in ("column", "group", "title"):
            common = pick(LENGTHS)
            self.units = {one: common if unit in LENGTHS else unit for one, unit in self.units.items()}

    def table(self) -> Dialect:
        """A table in this layout."""
        names = {one: self._header(one) for one in self.columns}
        objects: dict[str, dict[str, Any]] = {}
        body, details = [], {}
        for k in range(self.dice.randint(2, 6)):
            label, values, cells = self._object(k)
            objects[label] = values
            details[label] = {names[one]: str(cells[one]) for one in self.columns if one in TEXTS}
            body.append(cells)
        layout = [self._heading(names), *(self._row(cells) for cells in body), *self._footer()]
        for _ in range(self.dice.choice([0, 0, 1, 3])):
            layout.insert(0, [*self.dice.choice(TITLES)])
        if self.style == "title":
            unit = next(unit for unit in self.units.values() if unit in LENGTHS)
            place = next(k for k, row in enumerate(layout) if row == self._heading(names))
            layout.insert(place, [f"All dimensions in {unit}"])
        rows = [row for one in layout for row in (one if one and isinstance(one[0], list) else [one])]
        if self.dice.random() < 0.3:
            rows.insert(len(rows) - 1, ["" for _ in rows[-1]])
        dialect = Dialect(rows, objects, details, self.delimiter)
        dialect.encoding = self.dice.choice(["utf-8", "utf-8-sig", "utf-16", "cp1252"])
        dialect.end = self.dice.choice(["\n", "\r\n", "\r"])
        return dialect

    def _header(self, one: str) -> str:
        if one in TEXTS:
            return one
        choices = HEADERS[one]
        if one == "depth":
            choices += DEPTHS + (UNKNOWN if self.dice.random() < 0.3 else ())
        name = self.dice.choice(choices)
        return self.dice.choice([name, name, name.upper(), name.lower()])

    def _with_unit(self, one: str, name: str) -> str:
        unit = self.units.get(one, "")
        common = unit in LENGTHS  # one unit of all lengths, elsewhere
        if not unit or not (self.style == "header" or (self.style in ("group", "column", "title") and not common)):
            return name
        words = {"in": ["in", "inch", '"'], "lb": ["lb", "lbs", "pounds"], "%": ["%", "percent"]}.get(unit, [unit])
        written = self.dice.choice(words)
        form = self.dice.choice(["{} [{}]", "{} ({})", "{}, {}", "{} in {}", "{}_{}", "{} {}", "{}({})", "{}/{}"])
        return form.format(name, written)

    def _heading(self, names: dict[str, str]) -> list[Any]:
        if not hasattr(self, "heading"):
            texts = {one: self._with_unit(one, names[one]) for one in self.columns}
            lengths = [one for one in self.columns if self.units.get(one) in LENGTHS]
            self.heading: list[Any] = self._row(texts, header=True)
            if self.style == "line":
                self.heading = [self.heading, self._row({one: self.units.get(one, "") for one in self.columns})]
            elif self.style == "group":
                others = [one for one in self.columns if one not in lengths]
                self.columns = [*others, *lengths]
                unit = self.units[lengths[0]]
                above = ["" for _ in others] + [f"{self.dice.choice(['Dimensions', 'Maße'])} ({unit})"]
                above += [""] * (len(lengths) - 1)
                self.heading = [above, self._row(texts, header=True)]
        return self.heading

    def _row(self, cells: dict[str, Any], *, header: bool = False) -> list[Any]:
        row = []
        for one in self.columns:
            row.append(cells.get(one, ""))
            if self.style == "columns" and one in OF:
                row.append("unit" if header else self.units[one] if str(cells.get(one, "")).strip() else "")
        if self.style == "column":
            row.append("units" if header else next(unit for unit in self.units.values() if unit in LENGTHS))
        return row

    def _number(self, unit: str, low: float | None = None) -> tuple[Any, Decimal]:
        """A cell and its value."""
        least, most, decimals = RANGES[unit]
        value = Decimal(f"{self.dice.uniform(low or least, most):.{decimals}f}")
        beside_unit = self.style == "cells" and unit  # a text, with the decimal sign of the others
        if self.typed and not beside_unit and self.dice.random() < 0.7:
            return float(value), value * FACTORS[unit]
        point = self.dice.choice(".,") if self.mixed and self.dice.random() < 0.4 else self.point
        whole, _, rest = str(value).partition(".")
        if len(whole) > 3 and self.grouping != point:
            whole = f"{whole[:-3]}{self.grouping}{whole[-3:]}"
        text = f"{whole}{point}{rest}" if rest else whole
        if unit == "in" and self.fractions:
            value = Decimal(int(value)) + (part := self.dice.choice([Decimal("0.5"), Decimal("0.375")]))
            text = f"{int(value)}{self.dice.choice([' 1/2', '-1/2', '½'] if part == Decimal('0.5') else [' 3/8', '⅜'])}"
        if self.wide:
            text = text.translate({code: code + 0xFEE0 for code in range(ord("!"), ord("~"))})
        return text, value * FACTORS[unit]

    def _object(self, k: int) -> tuple[str, dict[str, Any], dict[str, Any]]:
        """Label, values and cells of an object."""
        is_round = self.round and self.dice.random() < 0.5
        values, cells = dict[str, Any](), dict[str, Any]()
        for one in self.columns:
            if one == "name":
                cells[one] = f"{self.dice.choice(['vase', 'bust', 'Total Eclipse', 'kouros, young'])} {k}"
            elif one == "number":
                cells[one] = f"{self.dice.choice('AB')}-{k}.{self.dice.randrange(100, 999)}"
            elif one in TEXTS:
                cells[one] = self.dice.choice(TEXTS[one])
            elif one in (("width", "depth") if is_round else ("diameter",)):
                cells[one] = self.dice.choice([*MISSING, "0", "0.0"])
            elif one in ("mass", "friction", "restitution", "depth") and self.dice.random() < 0.2:
                cells[one] = self.dice.choice([*MISSING, *(["0"] if one == "mass" else [])])
            else:
                unit = self.units[one]
                cell, value = self._number(unit)
                own = self.style == "cells" and unit
                cells[one] = f"{cell}{self.dice.choice(['', ' '])}{unit}" if own else cell
                values[one] = value
        label = cells.get("name") or cells.get("number") or ""
        return str(label), values, cells

    def _footer(self) -> list[list[Any]]:
        """Lines below the objects: a total, a note."""
        rows: list[list[Any]] = []
        if self.dice.random() < 0.4:
            sums = {one: self._number(unit)[0] for one, unit in self.units.items() if one != "diameter"}
            if self.style == "cells":
                sums = {one: f"{cell} {self.units[one]}" for one, cell in sums.items()}
            label = {self.columns[0]: self.dice.choice(TOTALS)} if self.columns[0] not in OF else {}
            rows.append(self._row(sums | label if "name" in self.columns or label else {}))
        if self.dice.random() < 0.3:
            rows.append([self.dice.choice(["Note: heights include pedestals", "Sizes as measured; +/- 0,5 cm"])])
        return rows


def errors_of(table: ObjectTable, dialect: Dialect) -> list[str]:
    """What a table says that is not true."""
    found, refused = [], {one.row for one in table.bad_rows}
    for one in table.objects:
        truth = dialect.objects.get(one.name)
        if truth is None:
            found.append(f"{one.name} is no object")
            continue
        sides = sorted(float(truth[name]) for name in ("width", "depth") if name in truth)
        read = sorted(float(side) for side in (one.width, one.depth) if side is not None)  # type: ignore[arg-type]
        pairs = [(read, sides)]
        for name in ("height", "diameter", "mass", "friction", "restitution"):
            value = getattr(one, name)
            known = [float(truth[name])] if name in truth else []
            pairs.append(([] if value in (None, "momentum") else [value], known))
        for ours, theirs in pairs:
            if len(ours) != len(theirs) or any(abs(a - b) > 1e-9 * abs(b) for a, b in zip(ours, theirs, strict=True)):
                found.append(f"{one.name}: {ours} for {theirs}")
        for header, text in dialect.details[one.name].items():
            if text and text not in (one.details.get(header), str(one.details.get(header, "")).strip()):
                found.append(f"{one.name}: {header} {text!r} is lost")
    if len(table.objects) + len(refused) < len(dialect.objects):
        found.append(f"{len(dialect.objects) - len(table.objects) - len(refused)} objects are lost")
    return found
