/* The passes of the fused operator in single precision. */
#define REAL float
#define NAME(name) name##_single
#include "method/consistent/fused/passes_over.h"
