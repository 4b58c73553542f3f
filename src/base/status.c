/* Names and glosses of the status codes, from the list in selas.h. */
#include "selas.h"

const char *selas_status_name(selas_status status)
{
    switch (status) {
#define ENTRY(name, value, gloss)                                                                            \
    case name:                                                                                               \
        return #name;
        SELAS_STATUS_LIST(ENTRY)
#undef ENTRY
    }
    return "unknown status";
}

const char *selas_status_gloss(selas_status status)
{
    switch (status) {
#define ENTRY(name, value, gloss)                                                                            \
    case name:                                                                                               \
        return gloss;
        SELAS_STATUS_LIST(ENTRY)
#undef ENTRY
    }
    return "unknown status";
}

const char *selas_version(void)
{
    return SELAS_VERSION;
}
