"""The scaled complementary error function of a SIMD vector."""

from typing import Any

from rocking._numba.compilation import SimdVector, kernel

CENTRE = 3.75  # x at which the variable t of the polynomial is 0 (Shepherd & Laframboise 1981)


@kernel
def scaled_erfc(x: SimdVector) -> Any:
    """exp(x^2) erfc(x) for x >= 0, with a relative error below 8e-16.

    (1 + 2 x) exp(x^2) erfc(x) is a polynomial of degree 23 in t = (x - 3.75)/(x + 3.75), the Chebyshev series on
    [-1, 1] in powers of t; the next terms add up to 6e-17.
    """
    shifted, doubled = x + CENTRE, 1.0 + 2.0 * x
    inverse = 1.0 / (shifted * doubled)
    t = (x - CENTRE) * (doubled * inverse)
    s = t * t
    even = (
        1.2375126308378275
        + s * (0.0035854154854790257
        + s * (-0.10880393014244462
        + s * (-0.05869339857664934
        + s * (-0.009746579683265262
        + s * (0.000293714378044958
        + s * (5.164652974177416e-05
        + s * (-1.1438048033346894e-05
        + s * (1.7419821586224816e-06
        + s * (-2.4857126248016745e-07
        + s * (3.197926671666804e-08
        + s * -2.623107347133476e-09))))))))))
    )  # fmt: skip
    odd = (
        -0.14024059858554697
        + s * (0.0822767384901452
        + s * (0.09230432116037748
        + s * (0.028362277418956406
        + s * (0.0017556258528952954
        + s * (-0.0002901540805408417
        + s * (2.238423915508223e-05
        + s * (-9.73559896736775e-07
        + s * (-5.7218230603224086e-08
        + s * (2.3263508708859124e-08
        + s * (-3.744210080962018e-09
        + s * 3.1114333809799254e-10))))))))))
    )  # fmt: skip
    return (even + t * odd) * (shifted * inverse)
