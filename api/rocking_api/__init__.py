"""HTTP service: responses of rocking blocks from the data sets of the workflow and from the solver."""
