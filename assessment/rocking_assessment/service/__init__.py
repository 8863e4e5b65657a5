"""Routes and pages that the package adds to the HTTP service, through the entry point `rocking.service`."""
