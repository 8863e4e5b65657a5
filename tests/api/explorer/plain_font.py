"""A font whose letters are bars, for pictures that are the same on every machine.

Every character is as wide as any other, so that lines break at the same places whatever fonts a machine has, and the
height of its bar depends on the character, so that another number or unit is another picture. A configuration of
fontconfig makes it the only font that a browser finds.
"""

from pathlib import Path

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen

EM = 1000
WIDTH = 560  # of a character [1/1000 em]
HEIGHTS = range(100, 800, 47)  # of bars [1/1000 em]; neighbours in the alphabet differ by most of the range
CHARACTERS = range(0x20, 0x3000)

CONFIGURATION = """<?xml version="1.0"?>
<fontconfig><dir>{folder}</dir><cachedir>{folder}/cache</cachedir></fontconfig>
"""


def install(folder: Path) -> Path:
    """Write the font and the configuration into a folder; the path of the configuration (FONTCONFIG_FILE)."""
    names = [f"bar{height}" for height in HEIGHTS]
    glyphs = {name: _bar(height) for name, height in zip(names, HEIGHTS, strict=True)}
    blank = TTGlyphPen(None).glyph()
    font = FontBuilder(EM, isTTF=True)
    font.setupGlyphOrder([".notdef", "space", *names])
    font.setupCharacterMap(
        {code: "space" if chr(code).isspace() else names[7 * code % len(names)] for code in CHARACTERS}
    )
    font.setupGlyf({".notdef": blank, "space": blank, **glyphs})
    font.setupHorizontalMetrics(dict.fromkeys([".notdef", "space", *names], (WIDTH, 0)))
    font.setupHorizontalHeader(ascent=850, descent=-250)
    font.setupNameTable({"familyName": "Bars", "styleName": "Regular"})
    font.setupOS2(sTypoAscender=850, sTypoDescender=-250, usWinAscent=850, usWinDescent=250)
    font.setupPost()
    font.save(folder / "bars.ttf")
    configuration = folder / "fonts.conf"
    configuration.write_text(CONFIGURATION.format(folder=folder))
    return configuration


def _bar(height):
    pen = TTGlyphPen(None)
    pen.moveTo((40, 0))
    for point in ((40, height), (WIDTH - 40, height), (WIDTH - 40, 0)):
        pen.lineTo(point)
    pen.closePath()
    return pen.glyph()
