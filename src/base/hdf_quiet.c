#include "base/hdf_quiet.h"

#include <errno.h>

struct quiet quiet_begin(void)
{
    struct quiet quiet = {0};
    errno = 0;
    H5Eget_auto2(H5E_DEFAULT, &quiet.function, &quiet.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return quiet;
}

void quiet_end(struct quiet quiet)
{
    H5Eset_auto2(H5E_DEFAULT, quiet.function, quiet.data);
}
