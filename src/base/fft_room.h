/* FFTW ends the program where its planner finds no memory and cannot be told otherwise. */
#ifndef SELAS_FFT_ROOM_H
#define SELAS_FFT_ROOM_H

#include <stdbool.h>
#include <stddef.h>

/* Is there memory for plans of transforms of so many numbers? Ask before each plan is made. (Room for them is
 * taken and given back; another thread may take it in between.) */
bool fft_room(size_t length);

#endif
