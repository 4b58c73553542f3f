/* The shared passes of absorbing layers in double precision. */
#define REAL double
#define NAME(name) name##_double
#define FAST(c) ((c)->pml->fast)
#include "method/consistent/absorbing/pml_fast_steps.h"
