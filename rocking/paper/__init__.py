"""The paper: its closed forms for the slender block, its similarity groups and its orientational analysis.

The names serve to compare with the paper and follow its text; unlike the other names of `rocking` they may change
from one version to the next. They are listed in `__init__.pyi` and loaded at first use.

The arguments of all closed forms are described here; a function states only what is special to it.

Parameters
----------
amplitude : array_like
    a = a_g/(g alpha) = 1/slenderness [-], [1, 1e12]. Below 1 the block does not uplift.
frequency_ratio : array_like
    omega = omega_g/p [-], [1e-12, 1e12].
restitution : array_like
    eta, angular velocity after an impact over that before [-], [0, 1].
time : array_like
    tau = p t since uplift [-], [0, inf) in `rotation`, `angular_velocity` and `printed_rotation`, otherwise any value.
pulse : str or AbstractPulse
    Name of a pulse, or a pulse. Functions with this argument take numbers, not arrays, and any amplitude above 0; the
    others have one full sine.

Returns
-------
ndarray
    Of the broadcast shape of the arguments, float64; nan where the event does not occur. Rotations are theta/alpha,
    angular velocities d(theta/alpha)/d tau [-].

Raises
------
InvalidArgumentError
    If a value is out of range, or the shapes do not broadcast.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
