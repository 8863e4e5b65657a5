"""`python -m rocking._cli`: the `rocking` command."""

from rocking._cli.app import app

app()
