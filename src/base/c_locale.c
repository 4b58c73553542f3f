#include "base/c_locale.h"

struct c_locale c_locale_begin(void)
{
    const locale_t own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return (struct c_locale){own, uselocale(own)};
}

void c_locale_end(const struct c_locale *locale)
{
    if (locale->own == (locale_t)0) return;
    uselocale(locale->host);
    freelocale(locale->own);
}
