"""Event-by-event solution of the equation of motion."""
