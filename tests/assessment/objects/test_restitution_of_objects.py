"""Restitution of objects by name and share."""

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._objects.objects import Bodies

import rocking
from tests.dimensional.test_restitution import TEXT, by_momentum


def test_an_object_has_the_restitution_of_its_name() -> None:
    """The same as with the number; k = 1 is momentum to the last digit."""
    eta = by_momentum(0.15, 0.6, np.hypot(0.15, 0.6) / np.sqrt(3), 0.7)
    body = Bodies.of([rocking_assessment.Object("a", width=0.3, height=1.2, restitution=TEXT)]).scaled()
    assert body.right.restitution == body.left.restitution == pytest.approx(eta)
    site = rocking_assessment.Site(pga=4.0, pgv=0.6, shapes=["sine", "ricker"])
    named, numeric, full_share, momentum = (
        rocking_assessment.assess(
            rocking_assessment.Object("a", 0.3, 1.2, restitution=restitution), site, sensitivity=False
        ).rows
        for restitution in (TEXT, eta, "kalliontzis(k=1)", "momentum")
    )
    assert named[0]["factor"] == pytest.approx(numeric[0]["factor"], rel=1e-9)
    assert full_share == momentum


def test_a_table_takes_the_name(tmp_path) -> None:
    table = tmp_path / "table.csv"
    table.write_text(f"name,width [m],height [m],restitution\na,0.3,1.2,{TEXT}\n")
    assert rocking_assessment.read_objects(table).objects[0].restitution == TEXT


@pytest.mark.parametrize("wrong", ["kalliontzis", "kalliontzis(0.8)", "kalliontzis(k=0)", "kalliontzis(k=1.1)", "x"])
def test_other_names_are_refused(wrong) -> None:
    with pytest.raises(rocking.InvalidArgumentError, match="restitution"):
        rocking_assessment.Object("a", width=0.3, height=1.2, restitution=wrong)


def test_an_object_off_its_middle_needs_another() -> None:
    with pytest.raises(rocking.InvalidArgumentError, match="not in the middle"):
        rocking_assessment.Object("a", width=0.3, height=1.2, offset_width=0.01, restitution=TEXT)
