/* What a rectangle has of a disc: sums over its corners. Of the part 0 < X < x, 0 < Y < y of the unit disc, x and y at
 * most 1, area and first moment over X are, where the corner (x, y) lies in the disc, xy and x^2 y/2, else
 *
 *   integral of min(y, (1 - X^2)^(1/2))    =  (x (1 - x^2)^(1/2) + y (1 - y^2)^(1/2) + asin x + asin y - pi/2) / 2,
 *   integral of X min(y, (1 - X^2)^(1/2))  =  y (1 - y^2) / 2 + (y^3 - (1 - x^2)^(3/2)) / 3:
 *
 * y up to X = (1 - y^2)^(1/2), the circle from there on. The area is odd in x and y, the moment even in x. */
#include "points/disc.h"

#include <math.h>

static double corner_area(double x, double y)
{
    const double a = fmin(1, fabs(x)), b = fmin(1, fabs(y));
    double area = a * b;
    if (a * a + b * b > 1)
        area = (a * sqrt(1 - a * a) + b * sqrt(1 - b * b) + (asin(a) + asin(b)) - M_PI_2) / 2;
    return (x < 0) == (y < 0) ? area : -area;
}

/* Over X. */
static double corner_moment(double x, double y)
{
    const double a = fmin(1, fabs(x)), b = fmin(1, fabs(y));
    double moment = a * a * b / 2;
    if (a * a + b * b > 1) moment = b * (1 - b * b) / 2 + (b * b * b - pow(1 - a * a, 1.5)) / 3;
    return y < 0 ? -moment : moment;
}

void disc_and_rectangle(const double low[2], const double high[2], double radius, double moment[3])
{
    moment[0] = moment[1] = moment[2] = 0;
    for (int corner = 0; corner < 4; corner++) {
        const double x = (corner % 2 == 0 ? low : high)[0] / radius,
                     y = (corner / 2 == 0 ? low : high)[1] / radius;
        const double sign = corner == 0 || corner == 3 ? 1 : -1;
        moment[0] += sign * radius * radius * corner_area(x, y);
        moment[1] += sign * radius * radius * radius * corner_moment(x, y);
        moment[2] += sign * radius * radius * radius * corner_moment(y, x);
    }
    moment[0] = fmax(0, moment[0]);
}
