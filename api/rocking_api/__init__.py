"""The HTTP service: answers about rocking blocks from the data sets of the workflow and from the solver."""
