/* Memory that runs out on purpose: the linker puts the functions below in the place of those that the library
 * takes and gives back memory by (`--wrap`, see the Makefile), and where GSL does so; the one numbered
 * `allocation_fails` finds none. What they gave and has not come back is counted, with the number that it
 * had. */
#ifndef SELAS_ALLOCATION_H
#define SELAS_ALLOCATION_H

#include <stdbool.h>
#include <stddef.h>

/* From now on the allocation with this number (from 1; 0: none) fails; counts begin anew. */
void allocation_arm(unsigned long number);
/* No more failures; true if one was met. */
bool allocation_disarm(void);
/* Blocks taken since allocation_arm that have not come back, and the number of one of them. */
size_t allocation_kept(unsigned long *number);
/* Where the allocation that failed was asked for, to standard error: addresses for addr2line. */
void allocation_tell(void);

#endif
