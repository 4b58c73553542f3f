/* The loops of the layers' shared passes in single precision. */
#define REAL float
#define NAME(name) name##_single
#include "method/consistent/absorbing/pml_loops.h"
