"""Parameters and responses of the routes."""
