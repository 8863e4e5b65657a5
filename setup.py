"""The long description: README.md, of which a package index cannot follow the links into the repository.

All else is in pyproject.toml. The text of such a link stays, a picture goes.
"""

import re
from pathlib import Path

from setuptools import setup

README = Path(__file__).with_name("README.md").read_text(encoding="utf-8")
WITHOUT_PICTURES = re.sub(r"!\[[^]]*\]\((?!https?:)[^)]*\)\n*", "", README)

setup(
    long_description=re.sub(r"\[([^]]*)\]\((?!https?:)[^)]*\)", r"\1", WITHOUT_PICTURES),
    long_description_content_type="text/markdown",
)
