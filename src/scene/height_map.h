/* Heights from a file: a grid of rows and columns, smooth splines through its values. */
#ifndef SELAS_SCENE_HEIGHT_MAP_H
#define SELAS_SCENE_HEIGHT_MAP_H

#include "base/messages.h"

struct builder;
struct deck_group;
struct ground_model;
struct height_map;

/* Reads x, height (two dimensions) or x, y, height (height_rows.h), on a grid of rows and columns whatever their
 * distances; splines of pieces no shorter than `piece` by least squares. NULL: SELAS_FILE_ERROR or SELAS_NO_MEMORY
 * in messages. */
struct height_map *height_map_read(const char *path, int axes, double datum, double piece,
                                   struct messages *messages);
void height_map_free(struct height_map *map); /* takes NULL */
/* As if such a file had heights, by a function, at points of a grid `step` apart from low to high. */
struct height_map *height_map_sample(double (*height)(const struct ground_model *of, const double place[2]),
                                     const struct ground_model *of, const double low[2], const double high[2],
                                     double step, double piece, struct messages *messages);
double height_map_at(const struct height_map *map,
                     const double place[2]); /* beyond the grid as at its edge */
/* Where the grid reaches, the largest height either way, the largest difference that the splines leave. */
void height_map_extent(const struct height_map *map, int axis, double *low, double *high);
double height_map_most(const struct height_map *map);
double height_map_smoothed(const struct height_map *map);
/* The same of values between low and high. */
double height_map_smoothed_in(const struct height_map *map, const double low[2], const double high[2]);
/* Takes their mean from the heights and gives it. */
double height_map_centre(struct height_map *map);
/* Complains of a word as the messages of reading say. */
void complain_of_heights(struct builder *builder, const struct deck_group *group, const char *word,
                         const struct messages *said);
/* Complains, of word `file`, unless the grid covers the body along the first `axes`. */
void height_map_cover(const struct height_map *map, struct builder *builder, const struct deck_group *group,
                      int axes);

#endif
