"""One module for each picture; `rocking.plot` gives their functions."""
