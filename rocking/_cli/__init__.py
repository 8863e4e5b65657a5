"""The `rocking` command."""
