/* Numbers with a decimal point, whatever locale the host has set. */
#ifndef SELAS_BASE_C_LOCALE_H
#define SELAS_BASE_C_LOCALE_H

#include <locale.h>

struct c_locale {
    locale_t own, host;
};

/* The calling thread has the locale "C" until the end. */
struct c_locale c_locale_begin(void);
void c_locale_end(const struct c_locale *locale);

#endif
