/* The shared passes of absorbing layers in single precision. */
#define REAL float
#define NAME(name) name##_single
#define FAST(c) ((c)->pml->single)
#include "method/consistent/absorbing/pml_fast_steps.h"
