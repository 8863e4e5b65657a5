"""Checks of free-standing bodies by standards and classical criteria: one module a document, one function a clause.

Floats and arrays in SI units. None of them is the equation of motion: `docs/assessment/standards.md` has a table of
clauses with the state of their sources, `docs/assessment/checks.md` how often each agrees with the exact outcome.
Arrays broadcast. A check is True where the body passes.

Parameters of all functions; a function states only what is special to it.

Parameters
----------
half_width : array_like
    b, distance of the edge from the vertical through the centre of mass [m], > 0; the smaller one of two.
mass_height : array_like
    h, height of the centre of mass above the base [m], > 0; alpha = atan(b/h), R^2 = b^2 + h^2.
gyration : array_like, optional
    r, radius of gyration about the centre of mass [m], > 0; by default R/sqrt(3), a uniform rectangle.

Raises
------
InvalidArgumentError
    If a value is out of range, or the shapes do not broadcast.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
