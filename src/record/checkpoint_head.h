/* The head of a checkpoint: 512 bytes of text before HDF5's own. It says who wrote the file, how long it is,
 * and the checksums of head and body, so that a file that is cut short or has a flipped bit anywhere is known
 * before HDF5 sees it. */
#ifndef SELAS_RECORD_CHECKPOINT_HEAD_H
#define SELAS_RECORD_CHECKPOINT_HEAD_H

#include "parallel/ranks.h"

enum { CHECKPOINT_HEAD = 512, CHECKPOINT_ROUNDING = 16 };

/* "fused", or "plain": how the kernels of this process round, on which bits depend (base/processor.h). */
const char *checkpoint_rounding(void);

/* Together: writes the head of the finished file and brings all of it on the disk. */
selas_status checkpoint_seal(const char *path, struct ranks *ranks, struct messages *messages);
/* Together: false, with the reason in why[size], unless the file is a whole checkpoint of this version and byte order;
 * of one that is, why[] has the commit that wrote it, rounding[] how that process rounded ("" if it does not say). Each
 * rank reads its share of it, and answers true where only others could not. */
bool checkpoint_whole(const char *path, struct ranks *ranks, char *why, size_t size,
                      char rounding[CHECKPOINT_ROUNDING]);

#endif
