/* Choices: words of the deck that name a member of an enumeration or an entry of a table. One list each, from
 * which come the choices in the table of words (words.c), the enumeration or the table itself, and its names.
 * One addition is one line here. Lines are X(symbol, "word"). */
#ifndef SELAS_DECK_CHOICES_H
#define SELAS_DECK_CHOICES_H

/* What becomes of a list: its symbols, its words by symbol, its words in a message, the range of a word of
 * type WORD_CHOICE. */
#define CHOICE_SYMBOL(symbol, word) symbol,
#define CHOICE_NAME(symbol, word) [symbol] = word,
#define CHOICE_QUOTED(symbol, word) " '" word "'"
#define CHOICE_WORD(symbol, word) "|" word
#define CHOICES(LIST) (&(LIST(CHOICE_WORD))[1])

/* The table of methods: families, each followed by its variants, the first of which is its default;
 * method_SYMBOL is in a folder of its own. Of each: where its points may lie (enum point_places, scene.h). */
#define METHODS(FAMILY, VARIANT)                                                                             \
    FAMILY("smoothed-point")                                                                                 \
    VARIANT(consistent, "smoothed-point", "consistent", POINTS_ON_FACES)                                     \
    VARIANT(paper, "smoothed-point", "paper", POINTS_ON_FACES)                                               \
    VARIANT(cloud, "smoothed-point", "cloud", POINTS_SCATTERED)                                              \
    FAMILY("sph")                                                                                            \
    VARIANT(total_lagrangian, "sph", "total-lagrangian", POINTS_IN_CELLS)                                    \
    VARIANT(updated_lagrangian, "sph", "updated-lagrangian", POINTS_IN_CELLS)

/* The table of time schemes: scheme_SYMBOL is in a file of its own in stepping/. */
#define SCHEMES(X)                                                                                           \
    X(leapfrog, "leapfrog")                                                                                  \
    X(modified_equation, "modified-equation")                                                                \
    X(euler, "euler")                                                                                        \
    X(pc2, "pc2")                                                                                            \
    X(rk4, "rk4")                                                                                            \
    X(rkc, "rkc")                                                                                            \
    X(lsrk54, "lsrk54")

/* The table of exact solutions: exact_SYMBOL is in a file of its own in exact/. */
#define EXACT_SOLUTIONS(X)                                                                                   \
    X(lamb, "lamb")                                                                                          \
    X(layered, "layered")                                                                                    \
    X(stokes, "stokes")                                                                                      \
    X(bar, "bar")                                                                                            \
    X(beam, "beam")                                                                                          \
    X(hole, "hole")                                                                                          \
    X(plane_wave, "plane-wave")                                                                              \
    X(recorded, "file")

/* The table of smoothing kernels: kernel_SYMBOL is in a file of its own in kernel/. */
#define KERNELS(X)                                                                                           \
    X(cubic, "cubic")                                                                                        \
    X(quintic, "quintic")                                                                                    \
    X(wendland, "wendland")

#define ELASTIC_LAWS(X)                                                                                      \
    X(LAW_LINEAR, "linear") /* Hooke, small strain: P = sigma */                                             \
    X(LAW_SAINT_VENANT_KIRCHHOFF,                                                                            \
      "saint-venant-kirchhoff")       /* S = lambda tr(E) I + 2 mu E, any rotation, moderate strain */       \
    X(LAW_NEO_HOOKEAN, "neo-hookean") /* P = mu (F - F^-T) + lambda ln(J) F^-T, large strain */

/* Faces of the box by the axis of their normal, and the edge of the hole. */
#define FACE_NAMES(X)                                                                                        \
    X(FACE_X_LOW, "x-")                                                                                      \
    X(FACE_X_HIGH, "x+")                                                                                     \
    X(FACE_Y_LOW, "y-")                                                                                      \
    X(FACE_Y_HIGH, "y+")                                                                                     \
    X(FACE_Z_LOW, "z-")                                                                                      \
    X(FACE_Z_HIGH, "z+")                                                                                     \
    X(FACE_HOLE, "hole")

#define PLANES(X)                                                                                            \
    X(PLANE_STRAIN, "strain")                                                                                \
    X(PLANE_STRESS, "stress")

#define BODY_SHAPES(X)                                                                                       \
    X(BODY_BOX, "box")                                                                                       \
    X(BODY_HALF_SPACE, "half-space")                                                                         \
    X(BODY_PLATE_WITH_HOLE, "plate-with-hole")                                                               \
    X(BODY_POINTS, "points")

#define BLOCK_SHAPES(X)                                                                                      \
    X(BLOCK_BOX, "box")                                                                                      \
    X(BLOCK_ELLIPSOID, "ellipsoid")

#define TOPOGRAPHY_SHAPES(X)                                                                                 \
    X(TOPOGRAPHY_GAUSSIAN, "gaussian")                                                                       \
    X(TOPOGRAPHY_RIDGE, "ridge")                                                                             \
    X(TOPOGRAPHY_CANYON, "canyon")                                                                           \
    X(TOPOGRAPHY_MODEL, "model")

#define ARRANGEMENTS(X)                                                                                      \
    X(ARRANGEMENT_LATTICE, "lattice")                                                                        \
    X(ARRANGEMENT_RADIAL, "radial")                                                                          \
    X(ARRANGEMENT_EQUALLY_RADIAL, "equally-radial")                                                          \
    X(ARRANGEMENT_CONFORMAL, "conformal")

/* Kinds of boundaries and what they mean (struct boundary_meaning, scene/boundary.h): what is held, which
 * time derivative of the displacement the time function is (NO_MOTION: none), what a method must be able to
 * do. A kind with an ability of its own is refused by all methods that do not have it. */
#define BOUNDARY_KINDS(X)                                                                                    \
    X(BOUNDARY_FREE, "free", HOLDS_NOTHING, NO_MOTION, 0)                                                    \
    X(BOUNDARY_FIXED, "fixed", HOLDS_ALL, NO_MOTION, CAN_HOLD)                                               \
    X(BOUNDARY_ROLLER, "roller", HOLDS_NORMAL, NO_MOTION, CAN_HOLD)                                          \
    X(BOUNDARY_SYMMETRY, "symmetry", HOLDS_NORMAL, NO_MOTION, CAN_HOLD | CAN_MIRROR)                         \
    X(BOUNDARY_TRANSMITTING, "transmitting", HOLDS_NOTHING, NO_MOTION, CAN_DAMP)                             \
    X(BOUNDARY_VELOCITY, "velocity", HOLDS_ALL, 1, CAN_HOLD | CAN_MOVE)                                      \
    X(BOUNDARY_DISPLACEMENT, "displacement", HOLDS_ALL, 0, CAN_HOLD | CAN_MOVE)

/* How a transmitting face absorbs: dampers (Lysmer & Kuhlemeyer 1969), or an absorbing layer (C-PML). */
#define ABSORBERS(X)                                                                                         \
    X(ABSORBER_LYSMER, "lysmer")                                                                             \
    X(ABSORBER_PML, "pml")

#define LOAD_KINDS(X)                                                                                        \
    X(LOAD_TRACTION, "traction")                                                                             \
    X(LOAD_BODY_FORCE, "body-force")                                                                         \
    X(LOAD_MOMENT_TENSOR, "moment-tensor")

#define LOAD_SHAPES(X)                                                                                       \
    X(LOAD_SQUARE, "square")                                                                                 \
    X(LOAD_DISC, "disc")                                                                                     \
    X(LOAD_FACE, "face")                                                                                     \
    X(LOAD_POINT, "point")

/* Time functions of loads and moved faces. */
#define HISTORY_KINDS(X)                                                                                     \
    X(HISTORY_TRIANGLE, "triangle") /* 0 -> 1 at duration/2 -> 0 at duration (Ding et al. 2006, Eq 43) */    \
    X(HISTORY_STEP, "step")         /* 1 for t >= 0 (1/2 at t = 0 where a value is asked for) */             \
    X(HISTORY_RICKER, "ricker")     /* (1 - 2 a) exp(-a), a = (pi frequency (t - delay))^2 */                \
    X(HISTORY_GAUSSIAN, "gaussian") /* exp(-(t - delay)^2 / (2 width^2)) */                                  \
    X(HISTORY_SINE_BURST,                                                                                    \
      "sine-burst")           /* sin(2 pi f t) (1 - cos(2 pi f t / cycles)) / 2, t <= cycles / f */          \
    X(HISTORY_TABLE, "table") /* straight lines between rows `t value` of a file; its last value after it */ \
    X(HISTORY_BRUNE, "brune") /* 1 - (1 + t/width) exp(-t/width): of rate t/width^2 exp(-t/width) (1970) */  \
    X(HISTORY_ERROR_FUNCTION,                                                                                \
      "error-function") /* integral of a Gaussian of unit area: erfc((delay - t)/(sqrt(2) width))/2 */

#define INITIAL_KINDS(X)                                                                                     \
    X(INITIAL_REST, "rest")                                                                                  \
    X(INITIAL_UNIFORM_VELOCITY, "uniform-velocity")                                                          \
    X(INITIAL_BEAM_MODE, "beam-mode")                                                                        \
    X(INITIAL_PLANE_WAVE, "plane-wave")                                                                      \
    X(INITIAL_GAUSSIAN, "gaussian")

#define FIELDS(X)                                                                                            \
    X(SELAS_DISPLACEMENT, "displacement")                                                                    \
    X(SELAS_VELOCITY, "velocity")                                                                            \
    X(SELAS_ACCELERATION, "acceleration")                                                                    \
    X(SELAS_STRESS, "stress")                                                                                \
    X(SELAS_STRAIN, "strain")                                                                                \
    X(SELAS_PRESSURE, "pressure")                                                                            \
    X(SELAS_ENERGY, "energy")

#endif
