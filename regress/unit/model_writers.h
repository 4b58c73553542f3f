/* Small models of the ground in each format, for tests: values that are linear along the axes of the model, so
 * that what lies between them is exact. */
#ifndef MODEL_WRITERS_H
#define MODEL_WRITERS_H

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* density, p_speed, s_speed, q_p, q_s at a place along the model's axes, z downward. */
static inline void field(double x, double y, double z, double value[5])
{
    value[3] = 100 + .05 * x + .02 * z;
    value[4] = 60 + .02 * y + .01 * z;
    value[0] = 2000 + .1 * x - .05 * y + .02 * z;
    value[1] = 4000 + .3 * x + .1 * y + .2 * z;
    value[2] = 2000 + .05 * x - .1 * y + .1 * z;
}
/* Elevations of the ground and of what lies over it. */
static inline double ground_of(double x, double y)
{
    return 100 + .02 * x + .01 * y;
}
static inline double water_of(double x, double y)
{
    return 130 + .01 * x + .01 * y;
}

enum { MOST_NUMBERS = 4000 };

/* --- rfile --- */

struct rfile_writer {
    FILE *file;
    int swapped, single;
};

static inline void put(const struct rfile_writer *writer, const void *number, size_t bytes)
{
    unsigned char byte[8];
    memcpy(byte, number, bytes);
    for (size_t i = 0; i < bytes; i++)
        fputc(byte[writer->swapped ? bytes - 1 - i : i], writer->file);
}
static inline void put_integer(const struct rfile_writer *writer, int value)
{
    put(writer, &value, sizeof value);
}
static inline void put_real(const struct rfile_writer *writer, double value)
{
    put(writer, &value, sizeof value);
}
static inline void put_value(const struct rfile_writer *writer, double value)
{
    const float single = (float)value;
    if (writer->single)
        put(writer, &single, sizeof single);
    else
        put(writer, &value, sizeof value);
}

/* Two blocks, 1000 x 1000, from 200 above the sea to 1200 below it; with `air` no rock above the ground. */
static inline void write_rfile(const char *path, int swapped, int single, int air)
{
    static const double head[3][3] = {{500, 0, 0}, {500, 100, -200}, {1000, 400, 400}};
    static const int n[3][4] = {{1, 3, 3, 1}, {5, 3, 3, 7}, {5, 2, 2, 3}};
    const struct rfile_writer writer = {fopen(path, "wb"), swapped, single};
    put_integer(&writer, 1);
    put_integer(&writer, single ? 4 : 8);
    put_integer(&writer, 1);
    put_real(&writer, 30);
    put_real(&writer, -122);
    put_real(&writer, 37);
    put_integer(&writer, 4);
    fputs("tmer", writer.file);
    put_integer(&writer, 3);
    for (int b = 0; b < 3; b++) {
        for (int i = 0; i < 3; i++)
            put_real(&writer, head[b][i]);
        for (int i = 0; i < 4; i++)
            put_integer(&writer, n[b][i]);
    }
    for (int b = 0; b < 3; b++)
        for (int i = 0; i < n[b][1]; i++)
            for (int j = 0; j < n[b][2]; j++)
                for (int k = 0; k < n[b][3]; k++) {
                    const double x = i * head[b][0], y = j * head[b][0], z = head[b][2] + k * head[b][1];
                    double value[5];
                    field(x, y, z, value);
                    for (int c = 0; c < 5 && air && z < -ground_of(x, y); c++)
                        value[c] = -999;
                    for (int c = 0; c < n[b][0]; c++)
                        put_value(&writer, b == 0 ? ground_of(x, y) : value[c]);
                }
    fclose(writer.file);
}

/* --- HDF5 --- */

static inline void put_numbers(hid_t place, const char *name, int count, const double *value)
{
    const hid_t space = H5Screate_simple(1, (const hsize_t[]){(hsize_t)count}, NULL);
    const hid_t attribute = H5Acreate2(place, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, value);
    H5Aclose(attribute);
    H5Sclose(space);
}
static inline void put_one(hid_t place, const char *name, double value)
{
    put_numbers(place, name, 1, &value);
}
/* Another number in the attribute of a file or, if not NULL, a group of it. */
static inline void put_other(const char *path, const char *group, const char *name, double value)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT),
                place = H5Gopen2(file, group != NULL ? group : "/", H5P_DEFAULT);
    H5Adelete(place, name);
    put_one(place, name, value);
    H5Gclose(place);
    H5Fclose(file);
}
/* Texts of varying length, as h5py writes them, or all of one length. */
static inline void put_words(hid_t place, const char *name, int count, const char *const *word, int varying)
{
    char fixed[10][16] = {{0}};
    for (int i = 0; i < count; i++)
        snprintf(fixed[i], sizeof fixed[i], "%s", word[i]);
    const hid_t type = H5Tcopy(H5T_C_S1),
                space = H5Screate_simple(1, (const hsize_t[]){(hsize_t)count}, NULL);
    H5Tset_size(type, varying ? H5T_VARIABLE : sizeof fixed[0]);
    const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, varying ? (const void *)word : (const void *)fixed);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}
/* A data set, left open. */
static inline hid_t put_set(hid_t place, const char *name, int rank, const hsize_t *n, const double *value)
{
    const hid_t space = H5Screate_simple(rank, n, NULL);
    const hid_t set =
        H5Dcreate2(place, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value);
    H5Sclose(space);
    return set;
}

/* Two grids, 1000 x 1000, ground, a surface at 300 + .1 x, bottom at 1200. `place` 0: the middle surface crosses the bottom. */
static inline double sfile_surface(int s, double x, double y)
{
    return s == 0 ? -ground_of(x, y) : s == 1 ? 300 + .1 * x : 1200;
}
static inline void write_sfile(const char *path, double lift)
{
    static const char *const names[] = {"Rho", "Cp", "Cs", "Qp", "Qs"};
    static const hsize_t n[2][3] = {{5, 5, 4}, {3, 3, 3}}, surfaces[3][2] = {{5, 5}, {5, 5}, {3, 3}};
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t all = H5Gcreate2(file, "Material_model", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                interfaces = H5Gcreate2(file, "Z_interfaces", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    static double value[5][MOST_NUMBERS];
    put_numbers(file, "Origin longitude, latitude, azimuth", 3, (const double[]){-122, 37, 30});
    put_one(file, "Attenuation", 1);
    put_one(file, "ngrids", 2);
    char name[32];
    for (int s = 0; s < 3; s++) {
        const double step = 1000. / (double)(surfaces[s][0] - 1);
        for (hsize_t i = 0; i < surfaces[s][0] * surfaces[s][1]; i++)
            value[0][i] =
                sfile_surface(s, (double)(i / surfaces[s][1]) * step, (double)(i % surfaces[s][1]) * step) -
                (s == 1 ? lift : 0);
        snprintf(name, sizeof name, "z_values_%d", s);
        H5Dclose(put_set(interfaces, name, 2, surfaces[s], value[0]));
    }
    for (int g = 0; g < 2; g++) {
        const double step = 1000. / (double)(n[g][0] - 1);
        snprintf(name, sizeof name, "grid_%d", g);
        const hid_t grid = H5Gcreate2(all, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        put_one(grid, "Horizontal grid size", step);
        for (hsize_t i = 0; i < n[g][0] * n[g][1] * n[g][2]; i++) {
            double here[5];
            const double x = (double)(i / n[g][2] / n[g][1]) * step,
                         y = (double)(i / n[g][2] % n[g][1]) * step;
            const double part = (double)(i % n[g][2]) / (double)(n[g][2] - 1);
            field(x, y, (1 - part) * sfile_surface(g, x, y) + part * sfile_surface(g + 1, x, y), here);
            for (int c = 0; c < 5; c++)
                value[c][i] = here[c];
        }
        for (int c = 0; c < 5; c++)
            H5Dclose(put_set(grid, names[c], 3, n[g], value[c]));
        H5Gclose(grid);
    }
    H5Gclose(interfaces);
    H5Gclose(all);
    H5Fclose(file);
}

/* GeoModelGrids: 1000 x 2000 x 1500, y towards 60 degrees; two blocks, the upper one with places along x and z
 * one by one. The values are linear in the blocks' own depth. `floor`: 1 the ground below the top, 2 no top and the
 * ground 400 lower, 3 no top. */
static inline void write_blocks(const char *path, int floor, const char *unit, double no_data)
{
    enum { VALUES = 5 };
    static const hsize_t n[2][4] = {{4, 3, 4, VALUES}, {2, 2, 3, VALUES}}, flat[3] = {2, 2, 1};
    static const double x_of[2][4] = {{0, 200, 500, 1000}, {0, 1000}},
                        z_of[2][4] = {{0, 50, 200, 500}, {500, 1000, 1500}};
    static double value[MOST_NUMBERS];
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t blocks = H5Gcreate2(file, "blocks", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                surfaces = H5Gcreate2(file, "surfaces", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    put_words(file, "data_values", VALUES, (const char *const[]){"Vs", "Qp", "density", "vp", "Qs"}, 1);
    put_words(file, "data_units", VALUES, (const char *const[]){"m/s", "none", "g/cm**3", unit, "none"}, 0);
    put_words(file, "data_layout", 1, (const char *const[]){"vertex"}, 1);
    put_one(file, "origin_x", 500000);
    put_one(file, "origin_y", 4000000);
    put_one(file, "y_azimuth", 60);
    put_one(file, "dim_z", 1500);
    for (int s = floor < 2 ? 0 : 1; s < (floor ? 2 : 1); s++) {
        for (int i = 0; i < 4; i++)
            value[i] = s == 0 ? water_of(i / 2 * 1000, i % 2 * 2000)
                              : ground_of(i / 2 * 1000, i % 2 * 2000) - (floor == 2 ? 400 : 0);
        const hid_t set = put_set(surfaces, s == 0 ? "top_surface" : "topography_bathymetry", 3, flat, value);
        put_one(set, "x_resolution", 1000);
        put_one(set, "y_resolution", 2000);
        H5Dclose(set);
    }
    for (int b = 0; b < 2; b++) {
        const double step = 2000. / (double)(n[b][1] - 1);
        for (hsize_t i = 0; i < n[b][0] * n[b][1] * n[b][2]; i++) {
            double here[5];
            field(x_of[b][i / n[b][2] / n[b][1]], (double)(i / n[b][2] % n[b][1]) * step,
                  z_of[b][i % n[b][2]], here);
            value[VALUES * i] = b == 0 && i % n[b][2] == 0 && no_data != 0 ? no_data : here[2];
            value[VALUES * i + 1] = here[3];
            value[VALUES * i + 2] = here[0] / 1000;
            value[VALUES * i + 3] = here[1];
            value[VALUES * i + 4] = here[4];
        }
        const hid_t set = put_set(blocks, b == 0 ? "upper" : "lower", 4, n[b], value);
        double up[4];
        for (int k = 0; k < 4; k++)
            up[k] =
                b == 0 ? -z_of[b][3 - k] : -z_of[b][k]; /* listed upward, which says nothing of the values */
        if (b == 0) {
            put_numbers(set, "x_coordinates", 4, x_of[b]);
            put_one(set, "y_resolution", step);
            put_numbers(set, "z_coordinates", 4, up);
        } else { /* the older names */
            put_one(set, "resolution_horiz", 1000);
            put_numbers(set, "y_coordinates", 2, (const double[]){0, 2000});
            put_one(set, "resolution_vert", 500);
            put_one(set, "z_top", up[0]);
        }
        H5Dclose(set);
    }
    H5Gclose(blocks);
    H5Gclose(surfaces);
    H5Fclose(file);
}

/* The same with the places along x of the upper block in the other order. */
static inline void turn_places(const char *path)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT),
                set = H5Dopen2(file, "blocks/upper", H5P_DEFAULT);
    H5Adelete(set, "x_coordinates");
    put_numbers(set, "x_coordinates", 4, (const double[]){1000, 500, 200, 0});
    H5Dclose(set);
    H5Fclose(file);
}

/* The same with a top of ridges 4 times as far apart as its values, along x. */
static inline void put_ridges(const char *path, double height, double step)
{
    enum { VALUES = 801 };
    static double value[2 * VALUES];
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    for (int i = 0; i < 2 * VALUES; i++)
        value[i] = height * (i % VALUES % 4 == 0 ? 1 : i % VALUES % 4 == 2 ? -1 : 0);
    H5Ldelete(file, "surfaces/top_surface", H5P_DEFAULT);
    const hid_t set = put_set(file, "surfaces/top_surface", 3, (const hsize_t[]){2, VALUES, 1}, value);
    put_one(set, "x_resolution", 1000);
    put_one(set, "y_resolution", step);
    H5Dclose(set);
    H5Fclose(file);
}

/* --- tomography_model.xyz --- */

/* 3 x 4 x 5 values, 500 x 300 x 200 apart from (1000, 2000, -700) on, or downward from 100; line `wrong` (of the
 * values, from 1) is `text`; only the first `lines` values; `damped`: with Q, of the value of this number -999. */
static inline void write_damped_text(const char *path, int downward, int wrong, const char *text, int lines,
                                     int damped)
{
    FILE *file = fopen(path, "w");
    const double from = downward ? 100 : -700, to = -600 - from, step = downward ? -200 : 200;
    fprintf(file,
            "# a model\r\n1000 2000 %g 2000 2900 %g # corners\n\n500 300 %g\n3 4 5\n1000 9000 500 2200 1000 "
            "4000\n",
            from, to, step);
    for (int i = 0; i < 60 && i < lines; i++) {
        const double x = i % 3 * 500, y = i / 3 % 4 * 300, z = from + i / 12 * step;
        double value[5];
        field(x, y, -z, value);
        if (i + 1 == wrong)
            fputs(text, file);
        else
            fprintf(file, "%.9g %.9g %.9g %.12g %.12g %.12g", 1000 + x, 2000 + y, z, value[1], value[2],
                    value[0]);
        if (i + 1 != wrong && damped)
            fprintf(file, " %.12g %.12g", i + 1 == damped ? -999 : value[3], value[4]);
        if (i + 1 != wrong) fputs("\n", file);
    }
    fclose(file);
}
static inline void write_text(const char *path, int downward, int wrong, const char *text, int lines)
{
    write_damped_text(path, downward, wrong, text, lines, 0);
}

/* --- Plain grid --- */

/* 3 x 2 x 4 values, 400 x 900 x 300 apart from 0 on; with Q times `q`, where that is not 0. */
static inline void write_plain(const char *path, double q)
{
    static const char *const names[] = {"density", "p_speed", "s_speed", "q_p", "q_s"};
    static double value[5][MOST_NUMBERS];
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    put_numbers(file, "origin", 3, (const double[]){0, 0, 0});
    put_numbers(file, "spacing", 3, (const double[]){400, 900, 300});
    for (int i = 0; i < 24; i++) {
        double here[5];
        field(i / 8 * 400, i / 4 % 2 * 900, i % 4 * 300, here);
        for (int c = 0; c < 5; c++)
            value[c][i] = c < 3 ? here[c] : q * here[c];
    }
    for (int c = 0; c < (q != 0 ? 5 : 3); c++)
        H5Dclose(put_set(file, names[c], 3, (const hsize_t[]){3, 2, 4}, value[c]));
    H5Fclose(file);
}

#endif
