"""What measurements say: blocks from traces of rotation and from tests on a shaking table, old rocks and the hazard."""
