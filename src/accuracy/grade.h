/* Work of a scene, and whether a spacing graded over depth saves of it (doc/theory/graded-spacing.md, section 3). */
#ifndef SELAS_ACCURACY_GRADE_H
#define SELAS_ACCURACY_GRADE_H

#include "accuracy/trial.h"

/* Point-steps that a trial may take, a minute or two on one thread. */
#define ACCURACY_TRIAL_WORK 1e9

/* Points times steps, counted as in the choice of a box; four times where the general operator has damped ground. */
double accuracy_work(const struct scene *scene);

/* That of a choice; INFINITY: there is no such scene. */
double accuracy_work_of(const struct trial *trial, const struct scene_choice *choice);

/* Of absorbing layers at least, for an error. */
long accuracy_layer_points(double accuracy);

enum { GRADE_TEXT = 128 };
/* Sets choice->grading where the scene takes the general operator, the deck says no grading and one at the choice's
 * spacing saves enough of the work (G20b), with words of it; else to 0 and "". */
void accuracy_grade(const struct scene *scene, const struct trial *trial, struct scene_choice *choice,
                    char text[GRADE_TEXT]);

#endif
