/* GSL's handler of errors set aside (see the header). How many have done so and what the host had are kept
 * here because GSL has one handler for all. */
#include "base/gsl_errors.h"

#include <gsl/gsl_errno.h>
#include <pthread.h>
#include <stddef.h>

static struct {
    pthread_mutex_t lock;
    size_t users;
    gsl_error_handler_t *host;
} aside = {.lock = PTHREAD_MUTEX_INITIALIZER};

/* A handler of this library's own, told from a host's by its address. */
static void nothing(const char *reason, const char *file, int line, int error)
{
    (void)reason;
    (void)file;
    (void)line;
    (void)error;
}

void gsl_errors_returned(void)
{
    pthread_mutex_lock(&aside.lock);
    gsl_error_handler_t *const before = gsl_set_error_handler(nothing);
    if (before != nothing) aside.host = before; /* also where the host set another one meanwhile */
    aside.users++;
    pthread_mutex_unlock(&aside.lock);
}

void gsl_errors_as_before(void)
{
    pthread_mutex_lock(&aside.lock);
    if (--aside.users == 0) {
        gsl_error_handler_t *const now = gsl_set_error_handler(aside.host);
        if (now != nothing) gsl_set_error_handler(now);
    }
    pthread_mutex_unlock(&aside.lock);
}
