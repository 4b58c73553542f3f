/* The general operator's sweep in single precision; in this order: each needs those before. */
#define REAL float
#define NAME(name) name##_single
#include "method/consistent/general/sweep_rows.h"

#include "method/consistent/general/sweep_planes.h"

#include "method/consistent/general/sweep_step.h"
