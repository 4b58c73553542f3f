/* GSL ends the program where a call of it fails, lacks of memory too, unless its handler of errors is another
 * one. The handler is one for the whole process: it may be the host's own, and threads share it. Between
 * these two calls GSL tells of errors by what its functions return, and the host's handler stands again once
 * no thread is in between. */
#ifndef SELAS_GSL_ERRORS_H
#define SELAS_GSL_ERRORS_H

/* Call in pairs; pairs may be nested and stand in several threads at a time. */
void gsl_errors_returned(void);
void gsl_errors_as_before(void);

#endif
