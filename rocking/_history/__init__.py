"""Time histories and contact forces."""
