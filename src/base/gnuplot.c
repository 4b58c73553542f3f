/* Plots off-screen by gnuplot, started with posix_spawn. */
#include "base/gnuplot.h"

#include "base/safe_file.h"

#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

bool gnuplot_begin(struct gnuplot *plot, struct messages *messages)
{
    plot->script = tmpfile();
    plot->data = tmpfile();
    if (plot->script != NULL && plot->data != NULL) return true;
    warn(messages, "no plots: no temporary file: %s", strerror(errno));
    if (plot->script != NULL) fclose(plot->script);
    if (plot->data != NULL) fclose(plot->data);
    return false;
}

void gnuplot_discard(struct gnuplot *plot)
{
    fclose(plot->script);
    fclose(plot->data);
}

/* Starts gnuplot with the script as its input; returns errno. */
static int spawn(const struct gnuplot *plot, FILE *complaints, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0) return error;
    /* first out of the way of 0..3, then to their places */
    const int script = dup(fileno(plot->script));
    const int said = fileno(complaints);
    const int data = dup(fileno(plot->data));
    if (script < 0 || data < 0) error = errno;
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, script, 0);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, said, 1);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, said, 2);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, data, 3);
    char program[] = "gnuplot", dash[] = "-";
    char *const words[] = {program, dash, NULL};
    if (error == 0) error = posix_spawnp(child, program, &actions, NULL, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (script >= 0) close(script);
    if (data >= 0) close(data);
    return error;
}

/* First line of gnuplot's complaints that says something. */
static void first_words(FILE *complaints, char *text, size_t size)
{
    text[0] = '\0';
    rewind(complaints);
    while (fgets(text, (int)size, complaints) != NULL) {
        text[strcspn(text, "\n")] = '\0';
        if (text[strspn(text, " \t^")] != '\0' && strstr(text, "warning") == NULL) return;
    }
}

bool gnuplot_run(struct gnuplot *plot, const char *what, struct messages *messages)
{
    FILE *complaints = tmpfile();
    int error = complaints == NULL ? errno : 0;
    if (error == 0 && (fflush(plot->script) != 0 || fflush(plot->data) != 0)) error = errno;
    int status = 0;
    if (error == 0) {
        rewind(plot->script);
        rewind(plot->data);
        pid_t child = 0;
        error = spawn(plot, complaints, &child);
        while (error == 0 && waitpid(child, &status, 0) < 0)
            if (errno != EINTR) error = errno;
    }
    char words[400] = "";
    if (complaints != NULL) first_words(complaints, words, sizeof words);
    if (error == ENOENT || (error == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 127))
        warn(messages, "no plots of %s: gnuplot is not installed", what);
    else if (error != 0)
        warn(messages, "no plots of %s: %s", what, strerror(error));
    else if (status != 0)
        warn(messages, "no plots of %s: gnuplot failed: %s", what, words);
    if (complaints != NULL) fclose(complaints);
    gnuplot_discard(plot);
    return error == 0 && status == 0;
}

void gnuplot_quote(FILE *script, const char *text)
{
    fputc('\'', script);
    for (; *text != '\0'; text++) {
        if (*text == '\'') fputc('\'', script);
        fputc((unsigned char)*text < ' ' ? ' ' : *text, script);
    }
    fputc('\'', script);
}

void gnuplot_page(FILE *script, int width, int height, int top, const char *title)
{
    fprintf(script, "reset\nset terminal pngcairo size %d,%d font 'DejaVu Sans,13'\nset label 1 ", width,
            height);
    gnuplot_quote(script, title);
    fprintf(script, " at screen 0.5, screen %.5f center noenhanced font 'DejaVu Sans,16'\n",
            1.0 - 0.5 * top / height);
    fprintf(script, "set grid lc rgb '#dddddd' lw 1 lt 1\nset border lw 1.2\nset tics nomirror\n"
                    "set xzeroaxis lc rgb '#999999' lt 1\nset key samplen 3 horizontal right bottom at graph "
                    "1, graph 1.005\n");
}

void gnuplot_panel(FILE *script, int width, int height, int top, int bottom)
{
    fprintf(script, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n", 130.0 / width,
            (width - 50.0) / width);
    fprintf(script, "set tmargin at screen %.5f\nset bmargin at screen %.5f\n",
            1.0 - (double)top / (double)height, 1.0 - (double)bottom / (double)height);
}

void gnuplot_range(FILE *script, double low, double high, int tics)
{
    const double room = high > low ? 0.08 * (high - low) : fmax(fabs(high), 1.0);
    fprintf(script, "set yrange [%.9g:%.9g]\nset ytics %.9g\n", low - room, high + room,
            gnuplot_tic_step(high - low + 2.0 * room, tics));
}

void gnuplot_time_axis(FILE *script, bool last, const char *unit)
{
    if (last)
        fprintf(script, "set xlabel 'time%s'\nset format x '%%g'\n", unit);
    else
        fprintf(script, "unset xlabel\nset format x ''\n");
}

double gnuplot_tic_step(double range, double wanted)
{
    const double rough = range / wanted;
    const double power = pow(10.0, floor(log10(rough)));
    const double lead = rough / power;
    return power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
}

void gnuplot_output(FILE *script, const char *folder, const char *name)
{
    char *path = NULL, *temporary = NULL;
    if (safe_file_names(folder, name, &path, &temporary, NULL) != SELAS_OK) return;
    fputs("set output ", script);
    gnuplot_quote(script, temporary);
    fputc('\n', script);
    free(path);
    free(temporary);
}

void gnuplot_keep(const char *folder, const char *name, bool good, struct messages *messages)
{
    char *path = NULL, *temporary = NULL;
    if (safe_file_names(folder, name, &path, &temporary, messages) != SELAS_OK) return;
    if (good)
        safe_file_commit(temporary, path, messages);
    else
        remove(temporary);
    free(path);
    free(temporary);
}
