/* The general operator's sweep in double precision; in this order: each needs those before. */
#define REAL double
#define NAME(name) name##_double
#include "method/consistent/general/sweep_rows.h"

#include "method/consistent/general/sweep_planes.h"

#include "method/consistent/general/sweep_step.h"
