"""Conversion between SI units and the similarity groups of the rocking block, (3.6), (4.10), (4.11), (5.3), (6.1)."""

from rocking.groups.control import Groups as Groups
from rocking.groups.control import GroupSet as GroupSet
from rocking.groups.control import Problem as Problem
from rocking.groups.control import groups_of as groups_of
from rocking.groups.control import problem_of_block as problem_of_block
from rocking.groups.control import problem_of_pulse as problem_of_pulse
from rocking.groups.response import angular_velocity_of_scaled as angular_velocity_of_scaled
from rocking.groups.response import rotation_of_scaled as rotation_of_scaled
from rocking.groups.response import rotation_scale as rotation_scale
from rocking.groups.response import scaled_angular_velocity as scaled_angular_velocity
from rocking.groups.response import scaled_rotation as scaled_rotation
from rocking.groups.response import scaled_time as scaled_time
from rocking.groups.response import time_of_scaled as time_of_scaled
