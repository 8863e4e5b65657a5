"""A Chromium for the tests of the page: the installed one, else one from a package manager.

`python -m tests.api.explorer.chromium` finds one, fetches it if there is none, and prints its path. Only root can
install a system package; others get the headless build inside an npm package, unpacked into build/chromium. A build
without windows is preferred: the complete browser takes 0.7 s of a processor more for each page that a test opens.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

SHELL = "chromium-headless-shell"
NAMES = (SHELL, "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
UNPACKED = Path(__file__).parents[3] / "build" / "chromium"
PACKAGE = "@sparticuz/chromium@147.0.0"  # the last for Node.js 20; x86-64 Linux, with the libraries it needs
HOW = (
    f"the tests of the page need Chromium: as root, apt-get install {SHELL}; or have npm and node on the path; or set "
    "ROCKING_CHROMIUM to one; `make browser` then finds or fetches it. ROCKING_NO_BROWSER=1 leaves these tests out"
)

FONTS = f"""<?xml version="1.0"?>
<fontconfig>
<dir>/usr/share/fonts</dir><dir>{UNPACKED / "fonts"}</dir><cachedir>{UNPACKED / "cache"}</cachedir>
</fontconfig>
"""
"""The package brings a font, for machines without any, but looks for it where the package's own host keeps it."""

# Python has no Brotli of its own
PROGRAM = """const fs = require('fs'); for (const f of process.argv.slice(1))
fs.writeFileSync(f.slice(0, -3), require('zlib').brotliDecompressSync(fs.readFileSync(f)))"""

FLAGS = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync", "--hide-scrollbars"),
)


@dataclass(frozen=True)
class Chromium:
    """An executable, and what it needs beside it."""

    path: Path
    flags: tuple[str, ...] = FLAGS
    environment: dict[str, str] = field(default_factory=dict)


def find() -> Chromium | None:
    """The Chromium named by ROCKING_CHROMIUM, the machine's own, or the one that `fetch` unpacked."""
    named = os.environ.get("ROCKING_CHROMIUM")
    for path in filter(None, [named] if named else map(shutil.which, NAMES)):
        return Chromium(Path(path))
    executable = UNPACKED / "chromium"
    if executable.exists():
        libraries = {"LD_LIBRARY_PATH": str(UNPACKED / "lib" / "lib"), "FONTCONFIG_PATH": str(UNPACKED)}
        return Chromium(executable, (*FLAGS, "--no-zygote"), libraries)
    return None


def fetch() -> None:
    """Install the system's package as root, or else unpack the npm package."""
    if os.geteuid() == 0 and shutil.which("apt-get"):
        with contextlib.suppress(subprocess.SubprocessError):
            _run("apt-get", "update")
            _run("apt-get", "install", "--yes", "--no-install-recommends", SHELL)
            return
    with npm_package(PACKAGE) as package:
        parts = package / "bin"
        _run("node", "-e", PROGRAM, *map(str, parts.glob("*.br")))
        for path in parts.glob("*.tar"):
            with tarfile.open(path) as packed:
                packed.extractall(parts / "lib" if "al2023" in path.name else parts, filter="data")
        for path in (*parts.glob("*.tar"), *parts.glob("*.br")):
            path.unlink()
        (parts / "chromium").chmod(0o755)
        (parts / "fonts.conf").write_text(FONTS)
        shutil.rmtree(UNPACKED, ignore_errors=True)
        UNPACKED.parent.mkdir(exist_ok=True)
        shutil.move(parts, UNPACKED)


@contextlib.contextmanager
def npm_package(name: str) -> Iterator[Path]:
    """The unpacked folder of a package of the npm registry."""
    with tempfile.TemporaryDirectory() as scratch:
        _run("npm", "pack", "--silent", name, folder=scratch)
        (archive,) = Path(scratch).glob("*.tgz")
        with tarfile.open(archive) as packed:
            packed.extractall(scratch, filter="data")
        yield Path(scratch) / "package"


def _run(*command: str, folder: str | None = None) -> None:
    subprocess.run(command, cwd=folder, capture_output=True, check=True, timeout=300)


if __name__ == "__main__":
    try:
        if find() is None:
            sys.stderr.write("Fetching Chromium for the tests of the page ...\n")
            fetch()
    except (OSError, subprocess.SubprocessError) as error:
        sys.stderr.write(f"{error}\nGoing on without: these tests will be skipped.\n")
    found = find()
    sys.stdout.write(f"{found.path if found else HOW}\n")
