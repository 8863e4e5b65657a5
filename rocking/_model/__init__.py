"""Block, reactions, energy margin, outcome and response types."""
