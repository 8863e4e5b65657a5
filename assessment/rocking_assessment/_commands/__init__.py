"""The commands that the package adds to `rocking`, through entry points of the group `rocking.commands`."""
