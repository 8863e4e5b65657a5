/* Contacts of the two lower corners of a block with the ground, for Siconos: benchmarks/accuracy/siconos_block.py.

q holds the centre of mass relative to the ground, horizontal and upward [m], and the rotation [rad], counter-clockwise
positive. Compiled with HALF_WIDTH and HALF_HEIGHT [m]; the matrices of Siconos are stored by columns. */

#include <math.h>

static void gap(double corner, const double *q, double *y) /* height and place of a corner */
{
    y[0] = q[1] + corner * sin(q[2]) - HALF_HEIGHT * cos(q[2]);
    y[1] = q[0] + corner * cos(q[2]) + HALF_HEIGHT * sin(q[2]);
}

static void jacobian(double corner, const double *q, double *y) /* of both, by the three coordinates */
{
    y[0] = 0.0, y[2] = 1.0, y[4] = corner * cos(q[2]) + HALF_HEIGHT * sin(q[2]);
    y[1] = 1.0, y[3] = 0.0, y[5] = HALF_HEIGHT * cos(q[2]) - corner * sin(q[2]);
}

#define CORNER(name, place)                                                                                            \
    void gap_##name(unsigned n, const double *q, unsigned m, double *y, unsigned k, double *z) { gap(place, q, y); }   \
    void jacobian_##name(unsigned n, const double *q, unsigned m, double *y, unsigned k, double *z)                    \
    {                                                                                                                  \
        jacobian(place, q, y);                                                                                         \
    }

CORNER(left, -HALF_WIDTH)
CORNER(right, HALF_WIDTH)
