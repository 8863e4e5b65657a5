"""Responses under recorded ground motions: exact arcs of slender blocks, Taylor steps of rigid ones."""
