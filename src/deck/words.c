/* The table of groups and names: the only place where a word of the deck is declared. */
#include "deck/words.h"

#include "deck/choices.h"

#define COUNT(list) (sizeof(list) / sizeof(list)[0])
#define FAMILY_WORD(word) "|" word
#define VARIANT_WORD(symbol, family, word, points) "|" word
#define FAMILY_GLOSS(word) "; " word ":"
#define VARIANT_GLOSS(symbol, family, word, points) " " word
#define KIND_WORD(symbol, word, holds, motion, needs) "|" word
#define NOTHING(...)
#define POSITIVE "(0, inf)"
#define NOT_NEGATIVE "[0, inf)"

/* name, type, most values, default, range or choices, need, gloss */
static const struct word scene_words[] = {
    {"title", WORD_TEXT, 1, "''", NULL, OPTIONAL, "heading of plots and reports"},
    {"dimension", WORD_INTEGER, 1, "3", "[1, 3]", OPTIONAL, "dimensions of space"},
    {"end_time", WORD_REAL, 1, NULL, POSITIVE, OBLIGATORY, "end of the computation [time]"},
    {"accuracy", WORD_REAL, 1, NULL, "(0, 1)", OPTIONAL,
     "wanted relative error, in place of the spacing and of the method's options"},
    {"plane", WORD_CHOICE, 1, "'strain'", CHOICES(PLANES), OPTIONAL,
     "what holds across the plane in 2D and 1D (1D stress: a thin bar)"},
};

static const struct word method_words[] = {
    {"name", WORD_CHOICE, 1, "'smoothed-point'", &(METHODS(FAMILY_WORD, NOTHING))[1], OPTIONAL,
     "family of methods"},
    {"variant", WORD_CHOICE, 1, NULL, &(METHODS(NOTHING, VARIANT_WORD))[1], OPTIONAL,
     "form of the method" METHODS(FAMILY_GLOSS, VARIANT_GLOSS)},
    {"degree", WORD_INTEGER, 1, NULL, "[1, 4]", OPTIONAL,
     "degree of the B-splines (consistent); else 2, on layered ground 4"},
    {"ends", WORD_CHOICE, 1, NULL, "open|mapped", EXPERT, "knots at the faces (consistent)"},
    {"mass", WORD_CHOICE, 1, NULL, "exact|vc1|vc2|vc3", OPTIONAL,
     "inverse of the mass: exact, or by 1 to 3 van Cittert sweeps (consistent); else vc3, on layered ground "
     "exact"},
    {"operator", WORD_CHOICE, 1, NULL, "layered|general", OPTIONAL,
     "for level layers, or for ground that varies in all directions; else as the ground needs (consistent)"},
    {"tuned", WORD_LOGICAL, 1, NULL, NULL, EXPERT,
     "tune the splines for short waves (consistent, degree 4, exact mass; the default on layered ground)"},
    {"depth_mass", WORD_CHOICE, 1, NULL, "exact|same", EXPERT,
     "mass in the stiffness over depth beside sweeps: exact, or the same as elsewhere (consistent)"},
    {"dissipation", WORD_REAL, 1, NULL, NOT_NEGATIVE, EXPERT,
     "damping rate of the shortest waves beside sweeps [fastest speed / spacing]; else none"},
    {"fused", WORD_LOGICAL, 1, NULL, NULL, EXPERT,
     "fuse the operator's passes where possible, the default (consistent)"},
    {"quiet", WORD_REAL, 1, NULL, "[0, 1e-6]", EXPERT,
     "leave out what moves less than this part of the largest displacement (consistent, masses vc1 to vc3); "
     "else 1e-12; "
     "0: all"},
    {"symmetry", WORD_LOGICAL, 1, ".true.", NULL, EXPERT, "use the scene's mirror planes"},
    {"precision", WORD_CHOICE, 1, "'double'", "double|single", EXPERT, "precision of the state"},
    {"kernel", WORD_CHOICE, 1, NULL, CHOICES(KERNELS), OPTIONAL, "smoothing kernel (paper, sph)"},
    {"smoothing_length", WORD_REAL, 1, NULL, "(0, 10]", OPTIONAL, "smoothing length [spacings] (paper, sph)"},
    {"filter", WORD_REAL, 1, NULL, "[0, 1]", OPTIONAL, "strength of the filter (paper: alpha of Eq 35)"},
    {"filter_form", WORD_CHOICE, 1, NULL, "increment|displacement", EXPERT,
     "what the filter of Eq 35 acts on (paper)"},
    {"deconvolution", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "de-convolve the histories (paper: Eq 38)"},
    {"row_sums", WORD_CHOICE, 1, NULL, "as-printed|zero", EXPERT,
     "K u_b as printed, or K (u_b - u_a) (paper)"},
    {"volume_factors", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "F^V of Eqs 24 and 25 (paper)"},
    {"area_factors", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "F^A of Eqs 26 and 27 (paper)"},
    {"kernel_correction", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "alpha of Eqs 28 and 29 (paper)"},
    {"boundary_term", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "Gamma of Eqs 15 and 22 (paper)"},
    {"load_sum", WORD_CHOICE, 1, NULL, "distributed|local", EXPERT,
     "Eq 19 as sum(W_ab A_b T_b), or as printed T_a sum(W_ab A_b) (paper)"},
    {"patch_overlap", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "a patch carries exactly its area (paper)"},
    {"viscosity_alpha", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL, "linear artificial viscosity (sph)"},
    {"viscosity_beta", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL, "quadratic artificial viscosity (sph)"},
    {"artificial_stress", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL,
     "artificial stress: epsilon of Eq 22 (updated-lagrangian)"},
    {"gradient_correction", WORD_LOGICAL, 1, NULL, NULL, EXPERT,
     "kernel gradient correction L (updated-lagrangian)"},
    {"jaumann", WORD_LOGICAL, 1, NULL, NULL, EXPERT, "Jaumann rate of the stress (updated-lagrangian)"},
    {"forces", WORD_CHOICE, 1, NULL, "published|adjoint", EXPERT,
     "Eq 19, or the adjoint of the velocity gradient (updated-lagrangian)"},
    {"hourglass", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL, "hourglass control (sph, cloud)"},
    {"gradient", WORD_CHOICE, 1, NULL, "linear|quadratic|central", OPTIONAL,
     "exact for such fields, or central differences on a lattice (total-lagrangian)"},
    {"mechanisms", WORD_INTEGER, 1, NULL, "[1, 8]", OPTIONAL,
     "relaxation mechanisms of damped ground (consistent, total-lagrangian, reference 'layered'); else 3"},
    {"law", WORD_CHOICE, 1, NULL, CHOICES(ELASTIC_LAWS), OPTIONAL, "elastic law (total-lagrangian)"},
};

static const struct word stepping_words[] = {
    {"scheme", WORD_CHOICE, 1, NULL, CHOICES(SCHEMES), OPTIONAL, "time scheme"},
    {"time_step", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "time step [time]"},
    {"courant", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "time step [spacing over the fastest wave speed]"},
    {"safety", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "time step [fraction of the measured limit], else .9"},
    {"stages", WORD_INTEGER, 1, NULL, "[2, 1000]", OPTIONAL, "stages of rkc; else chosen"},
    {"max_stages", WORD_INTEGER, 1, NULL, "[2, 1000]", EXPERT, "most stages that rkc may choose"},
    {"rule", WORD_CHOICE, 1, "'measured'", "measured|paper", EXPERT,
     "stages of rkc: from the measured spectrum, or by Eq 28 of He & Seaid"},
    {"unwarp", WORD_LOGICAL, 1, NULL, NULL, EXPERT,
     "time-dispersion transform: take leapfrog's error out of the histories"},
    {"force", WORD_LOGICAL, 1, ".false.", NULL, EXPERT, "run beyond the stability limit all the same"},
};

static const struct word material_words[] = {
    {"name", WORD_TEXT, 1, NULL, NULL, OBLIGATORY, "name that bodies and layers use"},
    {"density", WORD_REAL, 1, NULL, POSITIVE, OBLIGATORY, "density [mass/volume]"},
    {"lambda", WORD_REAL, 1, NULL, NULL, OPTIONAL, "first Lame constant [stress]"},
    {"mu", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "second Lame constant [stress]"},
    {"young", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "Young's modulus [stress]"},
    {"poisson", WORD_REAL, 1, NULL, NULL, OPTIONAL, "Poisson's ratio, between -1 and 0.5"},
    {"p_speed", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "speed of P waves [length/time]"},
    {"s_speed", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "speed of S waves [length/time]"},
    {"bulk", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "bulk modulus [stress]"},
    {"shear", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "shear modulus [stress]"},
    {"q_p", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL,
     "quality Q of P waves; without q_p and q_s there is no damping"},
    {"q_s", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "quality Q of S waves"},
    {"q_frequency", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL,
     "frequency at which elastic constants and Q are meant [1/time]; else the centroid of the source's "
     "spectrum"},
    {"q_power", WORD_REAL, 1, NULL, "(-1, 1)", OPTIONAL,
     "Q grows as this power of the frequency; else it is constant"},
};

static const struct word body_words[] = {
    {"name", WORD_TEXT, 1, "'body'", NULL, OPTIONAL, "name that layers use"},
    {"material", WORD_TEXT, 1, NULL, NULL, OPTIONAL, "name of a material; not needed if all is layers"},
    {"shape", WORD_CHOICE, 1, "'box'", CHOICES(BODY_SHAPES), OPTIONAL, "shape"},
    {"low", WORD_REAL, 3, NULL, NULL, OPTIONAL, "lowest corner [length]"},
    {"high", WORD_REAL, 3, NULL, NULL, OPTIONAL, "highest corner [length]"},
    {"hole_centre", WORD_REAL, 3, NULL, NULL, OPTIONAL, "centre of the hole [length]"},
    {"hole_radius", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "radius of the hole [length]"},
    {"file", WORD_FILE, 1, NULL, NULL, OPTIONAL, "points of the body, HDF5 or text"},
    {"spacing", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "distance of neighbouring points [length]"},
    {"grading", WORD_REAL, 1, NULL, "[1, 4]", OPTIONAL,
     "let the spacing over depth grow with the speed, up to so many times 'spacing'"},
    {"arrangement", WORD_CHOICE, 1, "'lattice'", CHOICES(ARRANGEMENTS), OPTIONAL,
     "arrangement of the points"},
    {"rotation", WORD_REAL, 3, "0, 0, 0", NULL, OPTIONAL, "turn about x, then y, then z [degrees]"},
    {"jitter", WORD_REAL, 1, "0", "[0, 0.5]", OPTIONAL, "random shift of the points [spacings]"},
    {"seed", WORD_INTEGER, 1, "1", "[0, 2147483647]", OPTIONAL, "seed of the random shift"},
};

/* What loads and boundaries with a prescribed motion share: their history. */
#define HISTORY_WORDS                                                                                         \
    {"amplitude",                                                                                             \
     WORD_REAL,                                                                                               \
     1,                                                                                                       \
     "1",                                                                                                     \
     NULL,                                                                                                    \
     OPTIONAL,                                                                                                \
     "factor on the time function [stress, force, length, ...]"},                                             \
        {"history", WORD_CHOICE, 1, NULL, CHOICES(HISTORY_KINDS), OPTIONAL, "time function"},                 \
        {"duration", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "length of the triangle [time]"},                \
        {"frequency", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "frequency of ricker and sine-burst [1/time]"}, \
        {"delay",                                                                                             \
         WORD_REAL,                                                                                           \
         1,                                                                                                   \
         NULL,                                                                                                \
         NULL,                                                                                                \
         OPTIONAL,                                                                                            \
         "time of the peak (ricker, gaussian) or the middle (error-function) [time]"},                        \
        {"width",                                                                                             \
         WORD_REAL,                                                                                           \
         1,                                                                                                   \
         NULL,                                                                                                \
         POSITIVE,                                                                                            \
         OPTIONAL,                                                                                            \
         "standard deviation (gaussian, rate of error-function), time constant (brune) [time]"},              \
        {"cycles", WORD_REAL, 1, "5", POSITIVE, OPTIONAL, "cycles of the Hann-windowed sine-burst"},          \
        {"file", WORD_FILE, 1, NULL, NULL, OPTIONAL, "table of the time function: columns time, value"},      \
        {"start", WORD_REAL, 1, "0", NOT_NEGATIVE, OPTIONAL, "when the time function begins [time]"},         \
    {                                                                                                         \
        "smoothing", WORD_REAL, 1, "0", NOT_NEGATIVE, OPTIONAL,                                               \
            "convolve with the cubic B-spline on [0, smoothing] [time]"                                       \
    }

static const struct word boundary_words[] = {
    {"face", WORD_CHOICE, 8, NULL, &(FACE_NAMES(CHOICE_WORD) "|all")[1], OBLIGATORY, "faces"},
    {"kind", WORD_CHOICE, 1, NULL, &(BOUNDARY_KINDS(KIND_WORD))[1], OBLIGATORY, "what the faces do"},
    {"layer", WORD_CHOICE, 1, NULL, CHOICES(ABSORBERS), OPTIONAL,
     "how a transmitting face absorbs: dampers or an absorbing layer; else a layer if possible"},
    {"layer_points", WORD_INTEGER, 1, NULL, "[1, 1000]", OPTIONAL,
     "thickness of the absorbing layer [points]"},
    {"layer_thickness", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "the same as a length [length]"},
    {"layer_reflection", WORD_REAL, 1, NULL, "(0, 1)", OPTIONAL, "the same as a wanted reflection"},
    {"always", WORD_LOGICAL, 1, ".false.", NULL, EXPERT,
     "keep absorbing layers that nobody sees by end_time"},
    {"normal_factor", WORD_REAL, 1, "1", NOT_NEGATIVE, EXPERT, "Lysmer-Kuhlemeyer factor on the P impedance"},
    {"shear_factor", WORD_REAL, 1, "1", NOT_NEGATIVE, EXPERT, "Lysmer-Kuhlemeyer factor on the S impedance"},
    {"direction", WORD_REAL, 3, NULL, NULL, OPTIONAL, "direction of the prescribed motion"},
    {"slip", WORD_LOGICAL, 1, ".false.", NULL, OPTIONAL, "leave the other components free"},
    HISTORY_WORDS,
};

static const struct word layer_words[] = {
    {"body", WORD_TEXT, 1, NULL, NULL, OPTIONAL, "name of the body"},
    {"material", WORD_TEXT, 1, NULL, NULL, OBLIGATORY, "name of a material"},
    {"top", WORD_REAL, 1, NULL, NOT_NEGATIVE, OBLIGATORY,
     "depth of the upper face [length]; of a tilted one at x = y = 0, of one from a file at its datum"},
    {"file", WORD_FILE, 1, NULL, NULL, OPTIONAL,
     "heights of the upper face; formats as of topography%file (consistent, operator 'general')"},
    {"datum", WORD_REAL, 1, "0", NULL, OPTIONAL, "height of the file that lies at depth top [length]"},
    {"dip", WORD_REAL, 1, "0", "[0, 80]", OPTIONAL,
     "angle of the upper face below the horizontal [degrees] (consistent, operator 'general')"},
    {"strike", WORD_REAL, 1, "0", NULL, OPTIONAL,
     "direction along which a tilted face is level, from x towards y; it deepens towards strike + 90; in 2D "
     "-90 (default) or 90 [degrees]"},
    {"bottom", WORD_TEXT, 1, NULL, NULL, OPTIONAL,
     "material that the layer reaches at its lower face, speeds, density and 1/Q going evenly with depth "
     "(consistent, operator 'general')"},
};

static const struct word model_words[] = {
    {"file", WORD_FILE, 1, NULL, NULL, OBLIGATORY,
     "plain grid or GeoModelGrids (HDF5), SW4's rfile or sfile, SPECFEM's tomography_model.xyz"},
    {"origin", WORD_REAL, 3, NULL, NULL, OPTIONAL,
     "where x = y = 0 of the body lies, in the file's coordinates [length]; else its corner (plain grids: 0, "
     "0, 0); third value: z of the file at z = 0 (plain grids), or the elevation of face z- (else)"},
    {"depth", WORD_CHOICE, 1, "'ground'", "ground|sea", OPTIONAL,
     "depths are below the file's ground, or below elevation 0 or the third value of origin; 'sea' always "
     "beside &topography (plain grids: by their own z)"},
    {"azimuth", WORD_REAL, 1, NULL, NULL, OPTIONAL,
     "direction of the body's x, clockwise from north [degrees]; else that of the file's x (plain grids, "
     "rfile, "
     "sfile) or y (GeoModelGrids, tomography_model.xyz)"},
    {"damped", WORD_LOGICAL, 1, ".true.", NULL, OPTIONAL, "use the file's q_p and q_s, if it has them"},
    {"q_frequency", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "as of &material"},
    {"q_power", WORD_REAL, 1, NULL, "(-1, 1)", OPTIONAL, "as of &material"},
};

static const struct word topography_words[] = {
    {"shape", WORD_CHOICE, 1, NULL, CHOICES(TOPOGRAPHY_SHAPES), OPTIONAL,
     "hill, ridge or valley with the profile of a Gaussian, or the ground of the &model"},
    {"height", WORD_REAL, 1, NULL, NULL, OPTIONAL,
     "height of hill or ridge, depth of the canyon, from face z- [length]"},
    {"centre", WORD_REAL, 2, NULL, NULL, OPTIONAL, "centre of the shape: x, y; in 2D x [length]"},
    {"width", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL,
     "standard deviation of the profile [length]; steepest slope .61 height / width"},
    {"azimuth", WORD_REAL, 1, "0", NULL, OPTIONAL,
     "direction of ridge or canyon, from x towards y [degrees]"},
    {"file", WORD_FILE, 1, NULL, NULL, OPTIONAL,
     "heights above face z-, in place of a shape: text, x y height a line (2D: x height), each x with each "
     "y; HDF5: x, y, height [nx, ny], or z [ny, nx] as in netCDF-4"},
    {"datum", WORD_REAL, 1, "0", NULL, OPTIONAL, "height of the file that lies at face z- [length]"},
    {"depth", WORD_REAL, 1, NULL, POSITIVE, EXPERT,
     "depth below face z- at which the lattice is level again [length]; else the body's lower end, or 6 "
     "heights"},
};

static const struct word block_words[] = {
    {"material", WORD_TEXT, 1, NULL, NULL, OBLIGATORY, "name of a material"},
    {"shape", WORD_CHOICE, 1, "'box'", CHOICES(BLOCK_SHAPES), OPTIONAL, "shape"},
    {"centre", WORD_REAL, 3, NULL, NULL, OBLIGATORY, "centre, in the body's own frame [length]"},
    {"size", WORD_REAL, 3, NULL, POSITIVE, OBLIGATORY, "edges, or axes of the ellipsoid [length]"},
};

static const struct word initial_words[] = {
    {"kind", WORD_CHOICE, 1, "'rest'", CHOICES(INITIAL_KINDS), OPTIONAL, "state at t = 0"},
    {"velocity", WORD_REAL, 3, NULL, NULL, OPTIONAL, "of uniform-velocity [length/time]"},
    {"amplitude", WORD_REAL, 1, NULL, NULL, OPTIONAL, "of beam-mode [c0], plane-wave, gaussian [length]"},
    {"wave", WORD_CHOICE, 1, "'p'", "p|s", OPTIONAL, "kind of plane wave"},
    {"direction", WORD_REAL, 3, NULL, NULL, OPTIONAL,
     "of propagation (plane-wave) or displacement (gaussian)"},
    {"polarisation", WORD_REAL, 3, NULL, NULL, OPTIONAL, "direction of motion of an S wave"},
    {"wavelength", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "of a train of plane waves [length]"},
    {"centre", WORD_REAL, 3, NULL, NULL, OPTIONAL,
     "of the gaussian or the pulse; phase 0 of the train [length]"},
    {"width", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL,
     "standard deviation of the gaussian or of a plane pulse [length]"},
};

static const struct word load_words[] = {
    {"name", WORD_TEXT, 1, NULL, NULL, OPTIONAL, "name for hosts of the library"},
    {"kind", WORD_CHOICE, 1, "'traction'", CHOICES(LOAD_KINDS), OPTIONAL, "kind of load"},
    {"face", WORD_CHOICE, 1, NULL, CHOICES(FACE_NAMES), OPTIONAL, "face on which a traction acts"},
    {"shape", WORD_CHOICE, 1, NULL, CHOICES(LOAD_SHAPES), OPTIONAL, "where it acts"},
    {"centre", WORD_REAL, 3, NULL, NULL, OPTIONAL, "centre of the patch, or the point [length]"},
    {"depth", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL,
     "depth below the surface, in place of the centre's last value [length]"},
    {"size", WORD_REAL, 2, NULL, POSITIVE, OPTIONAL, "edges of the square, or diameter of the disc [length]"},
    {"direction", WORD_REAL, 3, NULL, NULL, OPTIONAL, "direction of the force"},
    {"moment", WORD_REAL, 6, NULL, NULL, OPTIONAL, "moment tensor: xx yy zz xy yz zx [force length]"},
    {"mechanism", WORD_REAL, 3, NULL, NULL, OPTIONAL,
     "double couple of unit moment, in place of moment: strike (from x towards y), dip, rake, z down "
     "[degrees]"},
    {"sources", WORD_FILE, 1, NULL, NULL, OPTIONAL,
     "file of point forces or moment tensors, text or HDF5: place, values, amplitude, start"},
    {"velocity", WORD_REAL, 3, NULL, NULL, OPTIONAL,
     "velocity of a moving patch [length/time]; else at rest"},
    HISTORY_WORDS,
};

static const struct word receiver_words[] = {
    {"name", WORD_TEXT, 1, NULL, NULL, OBLIGATORY, "name of the history's files"},
    {"position", WORD_REAL, 3, NULL, NULL, OBLIGATORY, "position [length]"},
    {"depth", WORD_REAL, 1, NULL, NOT_NEGATIVE, OPTIONAL,
     "depth below the surface, in place of the position's last value [length]"},
};

static const struct word profile_words[] = {
    {"name", WORD_TEXT, 1, NULL, NULL, OBLIGATORY, "name of the profile's file"},
    {"from", WORD_REAL, 3, NULL, NULL, OBLIGATORY, "first point [length]"},
    {"to", WORD_REAL, 3, NULL, NULL, OBLIGATORY, "last point [length]"},
    {"points", WORD_INTEGER, 1, "101", "[2, 1000000]", OPTIONAL, "number of points"},
    {"times", WORD_REAL, LIST_SIZE, NULL, NOT_NEGATIVE, OPTIONAL, "when [time]; else at the end"},
    {"fields", WORD_CHOICE, 7, "'velocity'", CHOICES(FIELDS), OPTIONAL, "fields to write"},
};

static const struct word snapshot_words[] = {
    {"every", WORD_REAL, 1, NULL, POSITIVE, OPTIONAL, "time between snapshots [time]"},
    {"times", WORD_REAL, LIST_SIZE, NULL, NOT_NEGATIVE, OPTIONAL, "when [time], in place of every"},
    {"fields", WORD_CHOICE, 7, "'velocity'", CHOICES(FIELDS), OPTIONAL, "fields to write"},
    {"region", WORD_REAL, 6, NULL, NULL, OPTIONAL,
     "lowest, then highest corner [length]; else the whole body; with &topography before the surface is "
     "raised"},
};

static const struct word output_words[] = {
    {"directory", WORD_TEXT, 1, NULL, NULL, OPTIONAL, "folder of the results; else output/DECKNAME"},
    {"checkpoint_every", WORD_INTEGER, 1, "0", NOT_NEGATIVE, OPTIONAL, "steps between checkpoints; 0: none"},
    {"checkpoint_minutes", WORD_REAL, 1, "30", NOT_NEGATIVE, OPTIONAL,
     "minutes by the clock between checkpoints; 0: none"},
    {"plots", WORD_LOGICAL, 1, ".true.", NULL, OPTIONAL, "draw the PNGs"},
    {"length_unit", WORD_TEXT, 1, NULL, NULL, OPTIONAL,
     "unit of length as axes and report name it; nothing is converted"},
    {"time_unit", WORD_TEXT, 1, NULL, NULL, OPTIONAL, "the same of time"},
    {"history_step", WORD_REAL, 1, "0", NOT_NEGATIVE, OPTIONAL,
     "time between rows of the histories [time]; 0: every step"},
    {"low_pass", WORD_REAL, 1, "0", NOT_NEGATIVE, OPTIONAL,
     "zero-phase low-pass of the histories: exp(-(w/low_pass)^4) [angle/time]; 0: none"},
    {"balance", WORD_LOGICAL, 1, NULL, NULL, OPTIONAL,
     "count what damped materials take in the balance of energy, at the cost of operator calls"},
};

static const struct word reference_words[] = {
    {"kind", WORD_CHOICE, 1, NULL, CHOICES(EXACT_SOLUTIONS), OBLIGATORY, "exact solution"},
    {"file", WORD_FILE, 1, NULL, NULL, OPTIONAL,
     "of kind 'file': a history, or a folder with one of each receiver"},
    {"tolerance", WORD_REAL, 1, NULL, "[1e-10, 0.1]", OPTIONAL,
     "wanted relative L2 error of velocity (lamb, layered: else 1e-6)"},
    {"spectrum", WORD_CHOICE, 1, NULL, "constant-q|scheme", OPTIONAL,
     "constant Q (default), or the relaxation mechanisms of a run (layered)"},
    {"stress", WORD_LOGICAL, 1, NULL, NULL, OPTIONAL,
     "exact histories of stress, too (layered, point sources)"},
};

/* doc/NEWS.md: a word that goes has a line here, {group, old, now, version}. */
static const struct retired_word retired[] = {{NULL, NULL, NULL, NULL}};

#define GROUP(name, occurrence, gloss)                                                                       \
    {                                                                                                        \
#name, occurrence, gloss, name##_words, COUNT(name##_words), retired                                 \
    }
static const struct word_group groups[] = {
    GROUP(scene, GROUP_ALWAYS, "what is computed"),
    GROUP(method, GROUP_ALWAYS, "how it is computed: method and its options"),
    GROUP(stepping, GROUP_ALWAYS, "time integration; one of time_step, courant and safety"),
    GROUP(material, GROUP_MANY,
          "one elastic material; one pair of lambda, mu / young, poisson / p_speed, s_speed / bulk, shear"),
    GROUP(body, GROUP_ONCE, "the body of points"),
    GROUP(boundary, GROUP_MANY, "what one or more faces do; others are free (of a half-space: absorbing)"),
    GROUP(layer, GROUP_MANY, "ground that varies with depth; below the last layer it goes on"),
    GROUP(model, GROUP_ONCE,
          "the ground from a file, in place of materials and layers (consistent, operator 'general')"),
    GROUP(block, GROUP_MANY,
          "another material in a part of the ground, over layers and earlier blocks (consistent, operator "
          "'general')"),
    GROUP(topography, GROUP_ONCE,
          "the surface of the ground, where it is not level (consistent, operator 'general')"),
    GROUP(initial, GROUP_ONCE, "state at t = 0"),
    GROUP(load, GROUP_MANY, "traction or other source"),
    GROUP(receiver, GROUP_MANY, "a place where histories are taken"),
    GROUP(profile, GROUP_MANY, "values along a line"),
    GROUP(snapshot, GROUP_MANY, "fields to HDF5 and XDMF"),
    GROUP(output, GROUP_ALWAYS, "where results go and what else is written"),
    GROUP(reference, GROUP_ONCE, "exact solution to compare with"),
};
static const struct word_table table = {groups, COUNT(groups)};

const struct word_table *deck_words(void)
{
    return &table;
}
