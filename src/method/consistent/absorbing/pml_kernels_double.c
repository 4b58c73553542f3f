/* The loops of the layers' shared passes in double precision. */
#define REAL double
#define NAME(name) name##_double
#include "method/consistent/absorbing/pml_loops.h"
