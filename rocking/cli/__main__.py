"""`python -m rocking.cli`: the `rocking` command."""

from rocking.cli.app import app

app()
