/* The program selas: one more host of the library. */
#include "selas.h"

#include <stdio.h>

int main(void)
{
    printf("selas %s\n", selas_version());
    return 0;
}
