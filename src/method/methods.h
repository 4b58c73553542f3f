/* The methods: a table of names. */
#ifndef SELAS_METHOD_METHODS_H
#define SELAS_METHOD_METHODS_H

#include "model/model.h"

/* The table, ended by NULL. */
extern const struct method *const method_table[];
/* NULL if there is none. */
const struct method *method_find(const char *name, const char *variant);
/* Would this method take the scene, without a warning, in place of its own? Its operator is not made. */
bool method_takes(const struct method *method, const struct scene *scene);
/* Takes it this word of &method? */
bool method_has_word(const struct method *method, const char *word);

/* Builds the scene's model by the method that it names. */
selas_status model_create(const struct scene *scene, struct model **model, struct messages *messages);

#endif
