"""Compiled event loop: intervals of the pulse, impacts, chatter, final outcome."""
