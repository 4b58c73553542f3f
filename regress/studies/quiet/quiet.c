/* Energy of a run over time (doc/theory/absorbing-faces.md, section 5): a deck and overrides as for selas; prints,
 * for the windows of time ending at 10, 30, 100, 300 and 1000, the largest kinetic plus strain energy. */
#include "selas.h"

#include <math.h>
#include <stdio.h>

static int run(selas_simulation *simulation)
{
    static const double window[] = {10, 30, 100, 300, 1000};
    const double end = selas_end_time(simulation);
    double largest = 0;
    size_t next = 0;
    while (selas_time(simulation) < end) {
        double kinetic, strain;
        if (selas_step(simulation, 10) != SELAS_OK || selas_energy(simulation, &kinetic, &strain) != SELAS_OK)
            return 1;
        largest = fmax(largest, kinetic + strain);
        if (selas_time(simulation) < fmin(window[next], end)) continue;
        printf("| %.1e ", largest);
        fflush(stdout);
        largest = 0;
        if (next < 4) next++;
    }
    printf("|\n");
    return 0;
}

int main(int count, char **word)
{
    selas_simulation *simulation = NULL;
    if (count < 2) return 2;
    int bad = selas_open_deck_with(word[1], (size_t)count - 2, (const char *const *)word + 2, &simulation) !=
              SELAS_OK;
    if (!bad) bad = run(simulation);
    if (bad) fprintf(stderr, "quiet: %s\n", selas_message(simulation));
    selas_close(&simulation);
    return bad;
}
