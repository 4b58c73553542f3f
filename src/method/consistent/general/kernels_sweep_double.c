/* The loops of the general operator's sweep in double precision. */
#define REAL double
#define NUMBER long long
#define NAME(name) name##_double
#include "method/consistent/general/sweep_over.h"
