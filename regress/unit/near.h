/* cmocka with its headers, and a check of doubles that says what it saw. */
#ifndef NEAR_H
#define NEAR_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#undef fail /* the library has a function of this name (base/messages.h) */
#undef fail_msg
#define fail_msg(...)                                                                                        \
    do {                                                                                                     \
        print_error(__VA_ARGS__);                                                                            \
        print_error("\n");                                                                                   \
        _fail(__FILE__, __LINE__);                                                                           \
    } while (0)

#define assert_near(value, expected, tolerance)                                                              \
    do {                                                                                                     \
        const double near_value = (value), near_expected = (expected), near_tolerance = (tolerance);         \
        if (!(fabs(near_value - near_expected) <= near_tolerance)) {                                         \
            print_error("%s = %.17g, expected %.17g within %g (off by %g)\n", #value, near_value,            \
                        near_expected, near_tolerance, near_value - near_expected);                          \
            _fail(__FILE__, __LINE__);                                                                       \
        }                                                                                                    \
    } while (0)

#endif
