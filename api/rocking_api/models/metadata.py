"""Model of every response in SI units: equations, assumptions, limits of use."""

from __future__ import annotations

from pydantic import BaseModel

from rocking_api.models.quantity import said

ASSUMPTIONS = (
    "The block is rigid, rectangular and of uniform density.",
    "The motion is plane: the ground moves horizontally, parallel to a face of the block.",
    "The ground is rigid, and the block rocks about its corners; it neither slides nor leaves the ground.",
    "An impact is instantaneous: the angular velocity is multiplied by the coefficient of restitution.",
    "The block starts at rest, and only the stated ground motion acts on it; horizontal, and vertical if stated.",
)

DISCLAIMER = (
    "The numbers solve these equations to the stated error. They are no design values: small changes of a block, its "
    "base or the ground motion can change the outcome, and real contacts, materials and ground motions differ from the "
    "model. Their use is the responsibility of the engineer."
)

REFERENCE = (
    "Dimitrakopoulos E. G., DeJong M. J. (2012), Revisiting the rocking block: closed-form solutions and similarity "
    "laws, Proceedings of the Royal Society A 468, 2294-2318"
)


class Equation(BaseModel):
    """An equation of the model, with its number in the reference."""

    number: str = said("number in the reference")
    formula: str = said("formula in plain text")
    meaning: str = said("what it states")


EQUATIONS = (
    Equation(number="2.1", formula="|u_g''| >= g b/h", meaning="uplift of a block at rest, tan(alpha) = b/h"),
    Equation(
        number="2.2",
        formula="theta'' = -p^2 [sin(alpha sgn(theta) - theta) + (u_g''/g) cos(alpha sgn(theta) - theta)]",
        meaning="rocking about a corner, p^2 = 3 g/(4 R), R^2 = b^2 + h^2",
    ),
    Equation(number="2.3", formula="theta'(after) = eta theta'(before)", meaning="impact at theta = 0"),
    Equation(
        number="2.4",
        formula="eta = 1 - (3/2) sin^2(alpha)",
        meaning="coefficient of restitution of Housner, unless a number is given",
    ),
)


class Metadata(BaseModel):
    """Model, assumptions and limits of use."""

    model: str = said("model in one line")
    equations: list[Equation] = said("equations that were solved")
    assumptions: list[str] = said("assumptions, one sentence each")
    disclaimer: str = said("limits of use")
    reference: str = said("publication whose equation numbers are used")


METADATA = Metadata(
    model="free-standing rigid block on rigid ground that rocks about its corners, equation (2.2)",
    equations=list(EQUATIONS),
    assumptions=list(ASSUMPTIONS),
    disclaimer=DISCLAIMER,
    reference=REFERENCE,
)
"""That of every response in SI units."""

GROUPS_METADATA = METADATA.model_copy(
    update={
        "model": "free-standing rigid block on rigid ground that rocks about its corners, in dimensionless groups: "
        "equation (2.2) with a slenderness angle, its slender limit (3.1) without",
        "equations": [
            *EQUATIONS,
            Equation(
                number="3.1",
                formula="d2y/dtau2 = y - sgn(y) - u_g''/(g tan(alpha))",
                meaning="rocking in the slender limit, y = theta/alpha, tau = p t",
            ),
        ],
    }
)
"""That of every response in groups, under `/v1/metadata`: it is longer than most of these responses."""
