"""Run time and memory: against the error, against the number of cells, of a new process, of the reproduction."""
