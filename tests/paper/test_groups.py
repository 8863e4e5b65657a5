"""Conversion to similarity groups and back; blocks with equal groups have equal scaled responses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking import paper
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.block import Block
from rocking._solver.peak_response import peak_response
from rocking.paper import Groups, GroupSet, Problem

problems = st.builds(
    Problem,
    alpha=st.floats(0.01, 1.2),
    frequency_parameter=st.floats(0.2, 20),
    peak_acceleration=st.floats(0.1, 50),
    pulse_frequency=st.floats(0.1, 100),
    gravity=st.sampled_from([9.80665, 9.81, 1.62]),
)
sets = st.sampled_from(GroupSet)


def assert_same(left: Problem, right: Problem) -> None:
    for name in ("alpha", "frequency_parameter", "peak_acceleration", "pulse_frequency", "gravity"):
        assert float(getattr(left, name)) == pytest.approx(float(getattr(right, name)), rel=1e-13)


@given(problem=problems, group_set=sets)
def test_a_problem_is_found_again_from_its_groups(problem, group_set):
    found, g = paper.groups_of(problem, group_set), problem.gravity
    block = {"alpha": problem.alpha, "frequency_parameter": problem.frequency_parameter}
    pulse = {"peak_acceleration": problem.peak_acceleration, "pulse_frequency": problem.pulse_frequency}
    assert_same(problem, paper.problem_of_block(found, group_set, **block, gravity=g))
    assert_same(problem, paper.problem_of_pulse(found, group_set, **pulse, gravity=g))


@given(problem=problems, group_set=sets, rotation=st.floats(-1, 1), time=st.floats(0, 10), velocity=st.floats(-5, 5))
def test_scaling_of_responses_is_inverted(problem, group_set, rotation, time, velocity):
    there = paper.scaled_rotation(rotation, problem, group_set)
    assert paper.rotation_of_scaled(there, problem, group_set) == pytest.approx(rotation, rel=1e-14)
    assert paper.time_of_scaled(paper.scaled_time(time, problem), problem) == pytest.approx(time, rel=1e-14)
    there = paper.scaled_angular_velocity(velocity, problem, group_set)
    assert paper.angular_velocity_of_scaled(there, problem, group_set) == pytest.approx(velocity, rel=1e-14)


def test_groups_have_the_values_defined_in_the_paper():
    problem = Problem(alpha=0.2, frequency_parameter=2.0, peak_acceleration=4.0, pulse_frequency=8.0, gravity=10.0)
    slender = paper.groups_of(problem, GroupSet.SLENDER_BY_BLOCK)
    assert slender.frequency_ratio == 4  # (3.6)
    assert slender.slenderness == pytest.approx(10 * 0.2 / 4)  # (4.11)
    assert slender.amplitude == pytest.approx(4 / (10 * 0.2))  # (3.6)
    assert paper.scaled_time(3.0, problem) == 6  # (3.6)
    rigid = paper.groups_of(problem, GroupSet.RIGID)
    assert rigid.slenderness == pytest.approx(10 * np.tan(0.2) / 4)  # (5.3), (6.1)
    assert rigid.cos_alpha == pytest.approx(np.cos(0.2))
    scaled = {s: float(paper.scaled_rotation(0.05, problem, s)) for s in GroupSet}
    assert scaled[GroupSet.SLENDER_BY_BLOCK] == pytest.approx(0.05 / 0.2)  # (4.10)
    assert scaled[GroupSet.SLENDER_BY_PULSE] == pytest.approx(0.05 * 10 / 4)  # (4.11), (4.1)
    assert scaled[GroupSet.RIGID] == pytest.approx(0.05 * 10 / 4)  # (5.3)
    assert scaled[GroupSet.RIGID_SMALL_ROTATION] == pytest.approx(0.05 * 10 / (4 * np.cos(0.2)))  # (6.1)
    velocity = paper.scaled_angular_velocity(0.1, problem, GroupSet.SLENDER_BY_PULSE)
    assert velocity == pytest.approx(10 * 0.1 / (2 * 4))  # (4.1)


def test_two_blocks_of_equal_groups_have_equal_scaled_responses():
    eta, wanted = 0.85, Groups(frequency_ratio=4.0, slenderness=0.5)
    peaks = []
    for block in (Block.from_slenderness_angle(0.12, 1.0), Block.from_slenderness_angle(0.24, 3.0)):
        problem = paper.problem_of_block(
            wanted, GroupSet.SLENDER_BY_PULSE, alpha=block.alpha, frequency_parameter=block.frequency_parameter
        )
        found = paper.groups_of(problem, GroupSet.SLENDER_BY_PULSE)
        peak = peak_response(
            "cosine", slenderness=found.slenderness, frequency_ratio=found.frequency_ratio, restitution=eta
        ).peak_rotation
        rotation = paper.rotation_of_scaled(peak, problem, GroupSet.SLENDER_BY_BLOCK)
        peaks.append((float(rotation), float(paper.scaled_rotation(rotation, problem, GroupSet.SLENDER_BY_PULSE))))
    (first, first_scaled), (second, second_scaled) = peaks
    assert first != pytest.approx(second, rel=0.1)
    assert first_scaled == pytest.approx(second_scaled, rel=1e-12)


def test_problem_arrays_broadcast():
    problem = Problem(0.2, np.array([[1.0], [2.0]]), np.array([3.0, 4.0, 5.0]), 8.0)
    assert paper.groups_of(problem, GroupSet.RIGID).frequency_ratio.shape == (2, 1)
    assert paper.scaled_angular_velocity(0.1, problem, GroupSet.RIGID).shape == (2, 3)


@pytest.mark.parametrize("name", ["alpha", "frequency_parameter", "peak_acceleration", "pulse_frequency", "gravity"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_problem_refuses_values_out_of_range(name, value):
    good = {"alpha": 0.2, "frequency_parameter": 2.0, "peak_acceleration": 4.0, "pulse_frequency": 8.0}
    with pytest.raises(InvalidArgumentError, match=f"`{name}`"):
        Problem(**{**good, name: value})


def test_groups_refuse_values_out_of_range():
    with pytest.raises(InvalidArgumentError, match="`slenderness`"):
        Groups(frequency_ratio=1.0, slenderness=0.0)
    with pytest.raises(InvalidArgumentError, match="`cos_alpha`"):
        Groups(frequency_ratio=1.0, slenderness=0.5, cos_alpha=1.0)


def test_blocks_with_other_cos_alpha_are_refused():
    found = paper.groups_of(Problem(0.3, 2.0, 4.0, 8.0), GroupSet.RIGID)
    with pytest.raises(InvalidArgumentError, match="`cos_alpha`"):
        paper.problem_of_block(found, GroupSet.RIGID, alpha=0.2, frequency_parameter=2.0)
    with pytest.raises(InvalidArgumentError, match="`cos_alpha`"):
        paper.problem_of_pulse(found, GroupSet.RIGID, peak_acceleration=8.0, pulse_frequency=8.0)
    slender = Groups(frequency_ratio=1.0, slenderness=3.0)
    with pytest.raises(InvalidArgumentError, match="`alpha`"):
        paper.problem_of_pulse(slender, GroupSet.SLENDER_BY_PULSE, peak_acceleration=9.0, pulse_frequency=8.0)
