/* The passes of the fused operator in double precision. */
#define REAL double
#define NAME(name) name##_double
#include "method/consistent/fused/passes_over.h"
