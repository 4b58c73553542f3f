/* Neighbours by linked cells: points are sorted into cells no smaller than the radius (counting sort, so that
 * members of a cell ascend); the candidates of a point are its own and the adjoining cells. */
#include "points/neighbours.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Squared distance; the first `dimension` components count. */
static inline double distance_squared(const int dimension, const double *a, const double *b)
{
    double sum = 0;
    for (int c = 0; c < dimension; c++)
        sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/* Makes room for `count` elements of `size` bytes; content is lost. */
static bool grow(void *array, size_t *room, size_t count, size_t size)
{
    void *old;
    memcpy(&old, array, sizeof old);
    array_free(old);
    void *fresh = array_new(count, size);
    memcpy(array, &fresh, sizeof fresh);
    if (room != NULL) *room = fresh != NULL ? count : 0;
    return fresh != NULL;
}

static bool grow_points(struct neighbours *n, size_t points, bool lists)
{
    if (points < n->point_room && (n->start != NULL || !lists)) return true;
    return (!lists || grow(&n->start, NULL, points + 1, sizeof *n->start)) &&
           grow(&n->cell_member, NULL, points, sizeof *n->cell_member) &&
           grow(&n->cell_of, &n->point_room, points + 1, sizeof *n->cell_of);
}

/* Lays the cells over the bounding box: as small as the radius allows, but not many more than points. */
static selas_status lay_cells(struct neighbours *n, struct messages *messages)
{
    double high[3] = {0};
    for (int c = 0; c < 3; c++) {
        n->corner[c] = 0;
        n->cells[c] = 1;
        n->cell_size[c] = n->radius;
    }
    for (size_t i = 0; i < n->points; i++)
        for (int c = 0; c < n->dimension; c++) {
            const double x = n->position[3 * i + (size_t)c];
            if (!isfinite(x))
                return fail(messages, SELAS_BAD_ARGUMENT, "point %zu has a coordinate that is not finite",
                            i + 1);
            if (i == 0 || x < n->corner[c]) n->corner[c] = x;
            if (i == 0 || x > high[c]) high[c] = x;
        }
    const double most = pow(4.0 * (double)n->points + 64, 1.0 / n->dimension);
    double total = 1;
    for (int c = 0; c < n->dimension; c++) {
        const double length = high[c] - n->corner[c];
        double cells = floor(length / n->radius);
        /* a long thin cloud may have more cells along it, as long as the product stays within bounds */
        if (cells < 1) cells = 1;
        if (cells > 4.0 * (double)n->points + 64) cells = 4.0 * (double)n->points + 64;
        n->cells[c] = (size_t)cells;
        total *= cells;
    }
    if (total > 4.0 * (double)n->points + 64)
        for (int c = 0; c < n->dimension; c++)
            if ((double)n->cells[c] > most) n->cells[c] = (size_t)most;
    size_t count = 1;
    for (int c = 0; c < n->dimension; c++) {
        const double length = high[c] - n->corner[c];
        if (n->cells[c] > 1) n->cell_size[c] = length / (double)n->cells[c];
        count *= n->cells[c];
    }
    if (count + 1 > n->cell_room && !grow(&n->cell_start, &n->cell_room, count + 1, sizeof *n->cell_start))
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu cells of neighbours", count);
    memset(n->cell_start, 0, (count + 1) * sizeof *n->cell_start);
    return SELAS_OK;
}

/* Cell along one axis, clamped to the cells there are. */
static long cell_along(const struct neighbours *n, int axis, double x)
{
    if (n->cells[axis] == 1) return 0;
    const double cell = floor((x - n->corner[axis]) / n->cell_size[axis]);
    if (cell < 0) return 0;
    const double last = (double)(n->cells[axis] - 1);
    return (long)(cell > last ? last : cell);
}

static size_t cell_number(const struct neighbours *n, const long cell[3])
{
    return (size_t)cell[0] + n->cells[0] * ((size_t)cell[1] + n->cells[1] * (size_t)cell[2]);
}

static void fill_cells(struct neighbours *n)
{
    const size_t count = n->cells[0] * n->cells[1] * n->cells[2];
    for (size_t i = 0; i < n->points; i++) {
        long cell[3] = {0};
        for (int c = 0; c < n->dimension; c++)
            cell[c] = cell_along(n, c, n->position[3 * i + (size_t)c]);
        n->cell_of[i] = (uint32_t)cell_number(n, cell);
        n->cell_start[n->cell_of[i] + 1]++;
    }
    for (size_t k = 0; k < count; k++)
        n->cell_start[k + 1] += n->cell_start[k];
    /* cell_start is moved on while filling and moved back after */
    for (size_t i = 0; i < n->points; i++)
        n->cell_member[n->cell_start[n->cell_of[i]]++] = (uint32_t)i;
    for (size_t k = count; k > 0; k--)
        n->cell_start[k] = n->cell_start[k - 1];
    n->cell_start[0] = 0;
}

/* Range of cells that hold everything within the radius of x. */
static void cell_range(const struct neighbours *n, const double *place, double radius, long low[3],
                       long high[3])
{
    for (int c = 0; c < 3; c++) {
        low[c] = high[c] = 0;
        if (c >= n->dimension) continue;
        low[c] = cell_along(n, c, place[c] - radius);
        high[c] = cell_along(n, c, place[c] + radius);
    }
}

/* Insertion sort: the rows are short and made of ascending runs. */
static void sort(uint32_t *index, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const uint32_t value = index[i];
        size_t j = i;
        for (; j > 0 && index[j - 1] > value; j--)
            index[j] = index[j - 1];
        index[j] = value;
    }
}

/* What gather() does, for a constant dimension. Cells in sequence along x hold members in sequence. */
static inline size_t gather_in(const int dimension, const struct neighbours *n, const double *place,
                               double radius, size_t not_this, size_t room, uint32_t *index)
{
    const double limit = radius * radius;
    long low[3], high[3], cell[3];
    size_t count = 0;
    cell_range(n, place, radius, low, high);
    for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++)
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++) {
            cell[0] = low[0];
            const size_t first = cell_number(n, cell), last = first + (size_t)(high[0] - low[0]);
            for (size_t m = n->cell_start[first]; m < n->cell_start[last + 1]; m++) {
                const size_t j = n->cell_member[m];
                if (j == not_this) continue;
                if (!(distance_squared(dimension, place, n->position + 3 * j) < limit)) continue;
                if (count < room) index[count] = (uint32_t)j;
                count++;
            }
        }
    return count;
}

/* Gathers the points within a radius of a place except `not_this`; only the first `room` are written. */
static size_t gather(const struct neighbours *n, const double *place, double radius, size_t not_this,
                     size_t room, uint32_t *index)
{
    return n->dimension == 1   ? gather_in(1, n, place, radius, not_this, room, index)
           : n->dimension == 2 ? gather_in(2, n, place, radius, not_this, room, index)
                               : gather_in(3, n, place, radius, not_this, room, index);
}

/* Checks what a search is asked for and sorts the points into cells. */
static selas_status sort_points(struct neighbours *n, int dimension, size_t points, const double *position,
                                double radius, bool lists, struct messages *messages)
{
    if (!(radius > 0) || !isfinite(radius))
        return fail(messages, SELAS_BAD_ARGUMENT, "the radius %g of the neighbours must be positive", radius);
    if (points >= UINT32_MAX)
        return fail(messages, SELAS_BAD_ARGUMENT, "%zu points are more than neighbours can number", points);
    n->dimension = dimension;
    n->points = points;
    n->position = position;
    n->radius = radius;
    if (!grow_points(n, points, lists))
        return fail(messages, SELAS_NO_MEMORY, "no memory for the neighbours of %zu points", points);
    const selas_status status = lay_cells(n, messages);
    if (status == SELAS_OK) fill_cells(n);
    return status;
}

selas_status neighbours_cells(struct neighbours *n, int dimension, size_t points, const double *position,
                              double radius, struct messages *messages)
{
    return sort_points(n, dimension, points, position, radius, false, messages);
}

/* Rows of the points from .. end - 1 of points in cells. */
static selas_status make_rows(struct neighbours *n, size_t from, size_t end, bool with_self,
                              struct messages *messages)
{
    const size_t points = n->points;
    const double radius = n->radius;
#pragma omp parallel for schedule(static)
    for (size_t i = from; i < end; i++)
        n->start[i + 1] = gather(n, n->position + 3 * i, radius, with_self ? points : i, 0, NULL);
    for (size_t i = 0; i <= from; i++)
        n->start[i] = 0;
    for (size_t i = from; i < end; i++)
        n->start[i + 1] += n->start[i];
    const size_t pairs = n->start[end];
    for (size_t i = end; i < points; i++)
        n->start[i + 1] = pairs;
    /* some room to spare, so that a slowly changing set of moving points does not take memory again and again
     */
    if ((pairs > n->pair_room || n->index == NULL) &&
        !grow(&n->index, &n->pair_room, pairs + (n->index != NULL ? pairs / 8 : 0), sizeof *n->index))
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu pairs of neighbours", pairs);
#pragma omp parallel for schedule(static)
    for (size_t i = from; i < end; i++) {
        uint32_t *row = n->index + n->start[i];
        const size_t count = n->start[i + 1] - n->start[i];
        gather(n, n->position + 3 * i, radius, with_self ? points : i, count, row);
        sort(row, count);
    }
    return SELAS_OK;
}

selas_status neighbours_find(struct neighbours *n, int dimension, size_t points, const double *position,
                             double radius, bool with_self, struct messages *messages)
{
    const selas_status status = sort_points(n, dimension, points, position, radius, true, messages);
    return status == SELAS_OK ? make_rows(n, 0, points, with_self, messages) : status;
}

selas_status neighbours_find_some(struct neighbours *n, int dimension, size_t points, const double *position,
                                  double radius, size_t from, size_t end, struct messages *messages)
{
    const selas_status status = sort_points(n, dimension, points, position, radius, true, messages);
    return status == SELAS_OK ? make_rows(n, from, end, false, messages) : status;
}

size_t neighbours_within(const struct neighbours *n, const double place[3], double radius, size_t room,
                         uint32_t *index)
{
    const size_t count = gather(n, place, radius, n->points, room, index);
    sort(index, count < room ? count : room);
    return count;
}

size_t neighbours_at(const struct neighbours *n, const double place[3], size_t room, uint32_t *index)
{
    return neighbours_within(n, place, n->radius, room, index);
}

size_t neighbours_nearest(const struct neighbours *n, const double place[3])
{
    long low[3], high[3], cell[3];
    size_t nearest = n->points;
    double least = n->radius * n->radius;
    cell_range(n, place, n->radius, low, high);
    for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++)
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
            for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++) {
                const size_t number = cell_number(n, cell);
                for (size_t m = n->cell_start[number]; m < n->cell_start[number + 1]; m++) {
                    const size_t j = n->cell_member[m];
                    const double distance = distance_squared(n->dimension, place, n->position + 3 * j);
                    if (distance > least || (distance == least && j >= nearest)) continue;
                    least = distance;
                    nearest = j;
                }
            }
    return nearest;
}

size_t neighbours_bytes(const struct neighbours *n)
{
    const size_t list = n->start != NULL ? sizeof *n->start : 0;
    return n->point_room * (list + sizeof *n->cell_member + sizeof *n->cell_of) +
           n->pair_room * sizeof *n->index + n->cell_room * sizeof *n->cell_start;
}

void neighbours_free(struct neighbours *n)
{
    array_free(n->start);
    array_free(n->index);
    array_free(n->cell_start);
    array_free(n->cell_member);
    array_free(n->cell_of);
    *n = (struct neighbours){0};
}
