/* The loops of the general operator's sweep in single precision. */
#define REAL float
#define NUMBER int
#define NAME(name) name##_single
#include "method/consistent/general/sweep_over.h"
