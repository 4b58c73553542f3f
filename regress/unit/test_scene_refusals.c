/* Every refusal of scene/: its place in the deck and its advice. */
#include "from_deck.h"

#define ROCK "&material name='rock', density=2, lambda=3, mu=5 /\n"
#define BODY "&body material='rock', low=0,0,0, high=7,7,7, spacing=.5 /\n"
#define BOX "&scene dimension=3, end_time=6 /\n" ROCK BODY
#define SQUARE                                                                                               \
    "&scene dimension=2, end_time=6 /\n" ROCK "&body material='rock', low=0,0, high=7,7, spacing=.5 /\n"
#define BAR "&scene dimension=1, end_time=6 /\n" ROCK "&body material='rock', low=0, high=7, spacing=.5 /\n"

struct refusal {
    const char *deck, *place, *word[3];
};

static void refuse_all(const struct refusal *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *words[4] = {cases[i].word[0], cases[i].word[1], cases[i].word[2], NULL};
        assert_refused(cases[i].deck, cases[i].place, words);
    }
}
#define REFUSE(cases) refuse_all(cases, sizeof(cases) / sizeof(cases)[0])

/* Elastic constants, on line 2. */
#define SOLID(constants)                                                                                     \
    "&scene dimension=3, end_time=6 /\n&material name='rock', density=2, " constants " /\n" BODY

static void materials(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {SOLID("young=1, poisson=.5"), "t.nml:2:44: error:", {"incompressible", "0.499"}},
        {SOLID("young=1, poisson=.6"), "t.nml:2:44: error:", {"-1 < poisson < 0.5"}},
        {SOLID("young=1, poisson=-1"), "t.nml:2:44: error:", {"-1 < poisson < 0.5"}},
        {SOLID("lambda=-.667, mu=1"), "t.nml:2:35: error:", {"3 lambda + 2 mu", "more than 0"}},
        {SOLID("p_speed=1, s_speed=.87"), "t.nml:2:46: error:", {"s_speed", "less than", "0.866"}},
        {SOLID("lambda=1, mu=1, q_p=20"), "t.nml:2:1: error:", {"needs q_p and q_s", "'q_s'"}},
        {SOLID("lambda=1, mu=1, q_p=0, q_s=9, q_frequency=1"), "t.nml:2:", {"0 for 'q_p'", "(0, inf)"}},
        {SOLID("lambda=1, mu=1, q_p=100, q_s=20, q_frequency=1"),
         "t.nml:2:51: error:",
         {"q_p = 100 is too large", "gain energy", "q_s = 45"}},
        {SOLID("lambda=1"), "t.nml:2:35: error:", {"'lambda' needs 'mu'"}},
        {SOLID("shear=1"), "t.nml:2:35: error:", {"'shear' needs 'bulk'"}},
        {SOLID("lambda=1, mu=1, young=2"), "t.nml:2:51: error:", {"exactly one pair"}},
        {SOLID("lambda=1, mu=1, young=2, poisson=0"), "t.nml:2:51: error:", {"exactly one pair"}},
        {SOLID(""), "t.nml:2:1: error:", {"one pair of lambda, mu"}},
        {SOLID("lambda=1e308, mu=1e308"), "t.nml:2:35: error:", {"too large"}},
        {"&scene dimension=3, end_time=6 /\n&material name='rock', density=-2, lambda=3, mu=5 /\n" BODY,
         "t.nml:2:",
         {"density"}},
        {"&scene dimension=3, end_time=6 /\n" ROCK
         "&material name='Rock', density=2, lambda=3, mu=5 /\n" BODY,
         "t.nml:3:11: error:",
         {"already", "&material 1", "another name"}},
        {"&scene dimension=3, end_time=6 /\n" ROCK "&material name='mud', density=2, lambda=3, mu=5 /\n" BODY,
         "t.nml:3:11: error:",
         {"'mud' is used by no &body, &layer or &block"}},
        {"&scene dimension=3, end_time=6 /\n" BODY, "t.nml:1:1: error:", {"no &material"}},
        {"&scene dimension=3, end_time=6 /\n&material name='', density=2, lambda=3, mu=5 /\n" BODY,
         "t.nml:2:11: error:",
         {"empty", "expected a name"}},
    };
    REFUSE(cases);
}

/* A body, on line 3. */
#define THING(words) "&scene dimension=3, end_time=6 /\n" ROCK "&body " words " /\n"
#define PLATE(words)                                                                                         \
    "&scene dimension=2, end_time=6 /\n" ROCK "&body material='rock', low=0,0, high=1,1, spacing=.1, " words \
    " /\n"

static void bodies(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {"&scene dimension=3, end_time=6 /\n" ROCK, "t.nml:1:1: error:", {"no &body"}},
        {THING("material='sand', low=0,0,0, high=7,7,7, spacing=.5"),
         "t.nml:3:7: error:",
         {"no &material is named 'sand'", "expected 'rock'"}},
        {THING("low=0,0,0, high=7,7,7, spacing=.5"), "t.nml:3:1: error:", {"needs material"}},
        {THING("material='rock', high=7,7,7, spacing=.5"), "t.nml:3:1: error:", {"shape 'box' needs low"}},
        {THING("material='rock', shape='half-space', spacing=.5"),
         "t.nml:3:1: error:",
         {"fitted around loads and receivers"}},
        {THING("material='rock', shape='half-space', low=0,0,0, spacing=.5"),
         "t.nml:3:1: error:",
         {"shape 'half-space' needs high"}},
        {THING("material='rock', shape='half-space', low=0,0,1, high=7,7,7, spacing=.5"),
         "t.nml:3:44: error:",
         {"z = 0", "expected low = 0"}},
        {THING("material='rock', low=0,0, high=7,7,7, spacing=.5"),
         "t.nml:3:24: error:",
         {"low has 2 values; expected 3"}},
        {THING("material='rock', low=0,0,7, high=7,7,7, spacing=.5"),
         "t.nml:3:35: error:",
         {"not above low", "along z"}},
        {THING("material='rock', low=0,0,0, high=7,7,7"), "t.nml:3:1: error:", {"needs spacing"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=.3"),
         "t.nml:3:47: error:",
         {"does not divide the edge of 7 along x", "0.3043478261"}},
        {THING("material='rock', low=0,0,0, high=6,4,7, spacing=.9"),
         "t.nml:3:47: error:",
         {"along x", "divides every edge is 1"}},
        {THING("material='rock', low=0,0,0, high=1,1,1.41421356, spacing=.1"),
         "t.nml:3:56: error:",
         {"along z", "change low or high"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=9"),
         "t.nml:3:47: error:",
         {"nearest", "is 7"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=1e-5"),
         "t.nml:3:47: error:",
         {"points need at least", "GB", "expected a spacing above"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=1e-300"),
         "t.nml:3:47: error:",
         {"points need at least"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=.5, arrangement='radial'"),
         "t.nml:3:59: error:",
         {"'plate-with-hole'", "expected 'lattice'"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=.5, hole_radius=1"),
         "t.nml:3:59: error:",
         {"'hole_radius' does not belong to shape 'box'"}},
        {THING("material='rock', low=0,0,0, high=7,7,7, spacing=.5, file='p.txt'"),
         "t.nml:3:59: error:",
         {"'file' does not belong to shape 'box'"}},
        {THING("material='rock', shape='points', low=0,0,0, high=7,7,7, spacing=.5"),
         "t.nml:3:1: error:",
         {"shape 'points' needs file"}},
        {THING("material='rock', shape='plate-with-hole', low=0,0,0, high=7,7,7, spacing=.5"),
         "t.nml:3:24: error:",
         {"dimension = 2"}},
        {PLATE("shape='plate-with-hole', hole_radius=.3"), "t.nml:3:1: error:", {"needs hole_centre"}},
        {PLATE("shape='plate-with-hole', hole_centre=0,0"), "t.nml:3:1: error:", {"needs hole_radius"}},
        {PLATE("shape='plate-with-hole', hole_centre=0,0, hole_radius=2"),
         "t.nml:3:97: error:",
         {"takes away the whole plate"}},
        {PLATE("shape='plate-with-hole', hole_centre=3,1, hole_radius=2"),
         "t.nml:3:97: error:",
         {"misses the plate", "between 2 and"}},
        {PLATE("rotation=1,0,0"), "t.nml:3:55: error:", {"about z alone", "0, 0, ANGLE"}},
        {"&scene dimension=1, end_time=6 /\n" ROCK
         "&body material='rock', low=0, high=7, spacing=.5, rotation=0,0,9 /\n",
         "t.nml:3:51: error:",
         {"one dimension cannot be turned"}},
        {BAR "&layer material='rock', top=1 /\n", "t.nml:4:1: error:", {"dimension = 2 or 3"}},
        {SQUARE "&layer material='rock', top=1, dip=5, strike=30 /\n",
         "t.nml:4:39: error:",
         {"along x", "-90"}},
        {BOX "&layer material='mud', top=1 /\n", "t.nml:4:8: error:", {"no &material is named 'mud'"}},
        {BOX "&layer material='rock', top=7 /\n", "t.nml:4:25: error:", {"below the body", "less than 7"}},
        {BOX "&layer material='rock', top=1, body='x' /\n", "t.nml:4:32: error:", {"no &body is named 'x'"}},
        {BOX "&layer material='rock', top=1 /\n&layer material='rock', top=1 /\n",
         "t.nml:5:25: error:",
         {"&layer 1 begins at depth 1 already"}},
    };
    REFUSE(cases);
}

static void faces(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {BOX "&boundary face='z-','x-','z-', kind='fixed' /\n",
         "t.nml:4:11: error:",
         {"'z-' is named twice"}},
        {BOX "&boundary face='all', kind='fixed' /\n&boundary face='y+', kind='free' /\n",
         "t.nml:5:11: error:",
         {"'y+' is named twice", "&boundary 1"}},
        {BOX "&boundary face='hole', kind='free' /\n",
         "t.nml:4:11: error:",
         {"no face 'hole'", "x- x+ y- y+ z- z+"}},
        {SQUARE "&boundary face='z-', kind='free' /\n",
         "t.nml:4:11: error:",
         {"no face 'z-'", "x- x+ y- y+"}},
        {PLATE("shape='plate-with-hole', hole_centre=0,0, hole_radius=.3") "&boundary face='hole', "
                                                                           "kind='fixed' /\n",
         "t.nml:4:24: error:",
         {"hole can only be free"}},
        {BOX "&boundary face='x-', kind='fixed', amplitude=2 /\n",
         "t.nml:4:36: error:",
         {"'amplitude' does not belong to kind 'fixed'"}},
        {BOX "&boundary face='x-', kind='fixed', slip=T /\n",
         "t.nml:4:36: error:",
         {"'slip' does not belong"}},
        {BOX "&boundary face='x-', kind='free', layer='pml' /\n",
         "t.nml:4:35: error:",
         {"'layer' does not belong to kind 'free'"}},
        {BOX "&boundary face='x-', kind='transmitting', layer='lysmer', layer_points=8 /\n",
         "t.nml:4:59: error:",
         {"'lysmer', which has no thickness"}},
        {BOX "&boundary face='x-', kind='transmitting', layer_points=8 /\n"
             "&stepping scheme='rk4' /\n",
         "t.nml:4:43: error:",
         {"'lysmer', which has no thickness (absorbing layers need stepping%scheme"}},
        {BOX "&boundary face='x-', kind='transmitting', layer_points=8, layer_thickness=1 /\n",
         "t.nml:4:59: error:",
         {"give one of layer_points, layer_thickness and layer_reflection"}},
        {BOX "&boundary face='x-', kind='transmitting', layer='pml', normal_factor=2 /\n",
         "t.nml:4:56: error:",
         {"does not belong to layer 'pml'"}},
        {BOX "&boundary face='x-', kind='transmitting', layer='pml', layer_points=8, layer_reflection=.1 /\n",
         "t.nml:4:72: error:",
         {"give one of"}},
        {BOX "&boundary face='x-', kind='velocity', history='step' /\n",
         "t.nml:4:1: error:",
         {"needs direction"}},
        {BOX "&boundary face='x-', kind='velocity', direction=0,0,0, history='step' /\n",
         "t.nml:4:39: error:",
         {"direction is zero"}},
        {BOX "&boundary face='x-', kind='velocity', direction=1,0,0 /\n",
         "t.nml:4:1: error:",
         {"needs history", "'triangle'"}},
        {BOX "&boundary face='x-', kind='velocity', direction=1,1,0, slip=T, history='step' /\n",
         "t.nml:4:56: error:",
         {"slip needs a direction along an axis"}},
    };
    REFUSE(cases);
}

/* A load, on line 4. */
#define LOAD(words) BOX "&load " words " /\n"
#define PATCH "face='z-', shape='square', "
#define PUSH ", direction=0,0,1, history='step'"

static void loads(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {LOAD("shape='face', direction=0,0,1, history='step'"), "t.nml:4:1: error:", {"needs face"}},
        {LOAD("face='hole', shape='face', direction=0,0,1, history='step'"),
         "t.nml:4:7: error:",
         {"no traction can act on a face 'hole'"}},
        {"&scene dimension=3, end_time=6 /\n" ROCK "&body material='rock', shape='half-space', spacing=.5 /\n"
         "&load face='z+', shape='square', centre=0,0,4, size=1,1" PUSH ", amplitude=1 /\n",
         "t.nml:4:7: error:",
         {"a half-space has one face, 'z-'"}},
        {LOAD("face='z-', direction=0,0,1, history='step'"), "t.nml:4:1: error:", {"needs shape"}},
        {LOAD(PATCH "size=1,1" PUSH), "t.nml:4:1: error:", {"needs centre (3 values)"}},
        {LOAD(PATCH "centre=1,1,0" PUSH), "t.nml:4:1: error:", {"0 values of size; expected 2"}},
        {LOAD(PATCH "centre=1,1,0, size=1" PUSH), "t.nml:4:48: error:", {"1 value of size; expected 2"}},
        {LOAD("face='z-', shape='disc', centre=1,1,0, size=1,1" PUSH),
         "t.nml:4:46: error:",
         {"2 values of size; expected 1", "diameter"}},
        {LOAD("face='z-', shape='point', centre=1,1,0, size=1" PUSH),
         "t.nml:4:47: error:",
         {"'size' does not belong to shape 'point'"}},
        {LOAD("face='z-', shape='face', centre=1,1,0" PUSH),
         "t.nml:4:32: error:",
         {"'centre' does not belong to shape 'face'"}},
        {LOAD(PATCH "centre=1,1,.25, size=1,1" PUSH),
         "t.nml:4:34: error:",
         {"lies 0.25 off the face 'z-'", "1, 1, 0"}},
        {LOAD(PATCH "centre=1,1,.25, size=1,1" PUSH
                    " /\n&topography shape='gaussian', height=.5, centre=1,1, width=2, depth=3"),
         "t.nml:4:34: error:",
         {"lies 0.75", "1, 1, -0.5"}},
        {LOAD(PATCH "centre=7.5,1,0, size=1,1" PUSH), "t.nml:4:34: error:", {"beyond the face 'z-'"}},
        {LOAD("face='z-', shape='disc', centre=7.4,7.4,0, size=1" PUSH),
         "t.nml:4:32: error:",
         {"beyond the face 'z-'"}},
        {LOAD("face='z-', shape='point', centre=7.1,1,0" PUSH),
         "t.nml:4:33: error:",
         {"beyond the face 'z-'"}},
        {LOAD(PATCH "centre=1,1,0, size=1,1, direction=0,0,0, history='step'"),
         "t.nml:4:58: error:",
         {"direction is zero"}},
        {LOAD(PATCH "centre=1,1,0, size=1,1, direction=0,1, history='step'"),
         "t.nml:4:58: error:",
         {"direction has 2 values; expected 3"}},
        {LOAD(PATCH "centre=1,1,0, size=1,1, history='step'"),
         "t.nml:4:1: error:",
         {"a traction needs direction (3 values)"}},
        {LOAD(PATCH "centre=1,1,0, size=1,1, direction=0,0,1"), "t.nml:4:1: error:", {"needs history"}},
        {LOAD(PATCH "centre=1,1,0, size=1,1, velocity=0,0,1" PUSH),
         "t.nml:4:58: error:",
         {"leads off the face"}},
        {LOAD("face='z-', shape='face', velocity=1,0,0" PUSH), "t.nml:4:32: error:", {"cannot move"}},
        {LOAD("face='z-', shape='face', moment=1,0,0,0,0,0" PUSH),
         "t.nml:4:32: error:",
         {"'moment' does not belong to a traction"}},
        {SQUARE "&load face='x-', shape='face', direction=0,0,1, history='step' /\n",
         "t.nml:4:32: error:",
         {"expected 2"}},
        {SQUARE "&load face='z-', shape='face', direction=0,1, history='step' /\n",
         "t.nml:4:7: error:",
         {"face 'z-' of this body"}},
        {SQUARE "&load face='x-', shape='square', centre=0,1, size=1,1, direction=0,1, history='step' /\n",
         "t.nml:4:46: error:",
         {"expected 1"}},
        {BAR "&load face='x-', size=1, direction=1, history='step' /\n",
         "t.nml:4:18: error:",
         {"'size' does not belong to a traction in 1D"}},
        {LOAD("kind='body-force', face='z-', direction=0,0,1, history='step'"),
         "t.nml:4:26: error:",
         {"'face' does not belong to a body force"}},
        {LOAD("kind='body-force', shape='disc', direction=0,0,1, history='step'"),
         "t.nml:4:26: error:",
         {"whole body", "'point'"}},
        {LOAD("kind='body-force', centre=1,1,1, direction=0,0,1, history='step'"),
         "t.nml:4:26: error:",
         {"shape 'point'"}},
        {LOAD("kind='body-force', shape='point', centre=1,1,8, direction=0,0,1, history='step'"),
         "t.nml:4:41: error:",
         {"outside the body", "1, 1, 7"}},
        {LOAD("kind='moment-tensor', moment=1,0,0,0,0,0, history='step'"),
         "t.nml:4:1: error:",
         {"needs centre"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, history='step'"),
         "t.nml:4:1: error:",
         {"expected 6: xx yy zz xy yz zx"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, moment=6*0.0, history='step'"),
         "t.nml:4:43: error:",
         {"moment is zero"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, moment=6*1.0, direction=0,0,1, history='step'"),
         "t.nml:4:57: error:",
         {"'direction' does not belong to a moment tensor"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, moment=6*1.0, mechanism=0,90,0, history='step'"),
         "t.nml:4:57: error:",
         {"not both"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, mechanism=0,90, history='step'"),
         "t.nml:4:43: error:",
         {"2 values", "strike, dip, rake"}},
        {LOAD("kind='moment-tensor', centre=1,1,1, mechanism=90,135,0, history='step'"),
         "t.nml:4:43: error:",
         {"dip of 135", "[0, 90]"}},
        {LOAD("kind='body-force', direction=0,0,1, mechanism=0,90,0, history='step'"),
         "t.nml:4:43: error:",
         {"'mechanism' does not belong to a body force"}},
        {SQUARE "&load kind='moment-tensor', centre=1,1, mechanism=0,90,0, history='step' /\n",
         "t.nml:4:41: error:",
         {"needs scene%dimension = 3"}},
        {SQUARE "&load kind='moment-tensor', centre=1,1, moment=1,1,1,0,0,0, history='step' /\n",
         "t.nml:4:41: error:",
         {"beyond the scene's 2 dimensions"}},
    };
    REFUSE(cases);
}

/* A history, on line 4 from column 45. */
#define HISTORY(words) BOX "&load face='z-', shape='face', direction=0,0,1, " words " /\n"

static void histories(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {HISTORY("history='triangle'"), "t.nml:4:1: error:", {"history 'triangle' needs duration"}},
        {HISTORY("history='ricker', frequency=1"), "t.nml:4:1: error:", {"history 'ricker' needs delay"}},
        {HISTORY("history='ricker', delay=1"), "t.nml:4:1: error:", {"history 'ricker' needs frequency"}},
        {HISTORY("history='gaussian', delay=1"), "t.nml:4:1: error:", {"history 'gaussian' needs width"}},
        {HISTORY("history='sine-burst'"), "t.nml:4:1: error:", {"history 'sine-burst' needs frequency"}},
        {HISTORY("history='table'"), "t.nml:4:1: error:", {"history 'table' needs file"}},
        {HISTORY("history='table', file='/nowhere/t.txt'"),
         "t.nml:4:66: error:",
         {"the table cannot be used", "/nowhere/t.txt"}},
        {HISTORY("history='step', duration=1"),
         "t.nml:4:65: error:",
         {"'duration' does not belong to history 'step'"}},
        {HISTORY("history='triangle', duration=1, frequency=1"),
         "t.nml:4:81: error:",
         {"'frequency' does not belong to history 'triangle'"}},
        {HISTORY("history='gaussian', delay=1, width=1, cycles=3"),
         "t.nml:4:87: error:",
         {"'cycles' does not belong to history 'gaussian'"}},
        {HISTORY("history='step', file='t'"), "t.nml:4:65: error:", {"'file' does not belong"}},
    };
    REFUSE(cases);
}

static void receivers_and_outputs(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {BOX "&receiver name='a', position=3,3,7.001 /\n",
         "t.nml:4:21: error:",
         {"outside the body", "3, 3, 7"}},
        {BOX "&receiver name='a', position=3,3 /\n", "t.nml:4:21: error:", {"2 values; expected 3"}},
        {BOX "&receiver name='', position=3,3,3 /\n", "t.nml:4:11: error:", {"empty"}},
        {BOX "&receiver name='a/b', position=3,3,3 /\n", "t.nml:4:11: error:", {"'/'", "file name"}},
        {BOX "&receiver name='../a', position=3,3,3 /\n", "t.nml:4:11: error:", {"'/'"}},
        {BOX "&receiver name='.a', position=3,3,3 /\n", "t.nml:4:11: error:", {"begins with '.'"}},
        {BOX "&receiver name='a b', position=3,3,3 /\n", "t.nml:4:11: error:", {"' '", "file name"}},
        {BOX "&receiver name='a.exact', position=3,3,3 /\n", "t.nml:4:11: error:", {".exact"}},
        {BOX "&receiver name='Ground', position=3,3,3 /\n", "t.nml:4:11: error:", {"'Ground.png' is a plot"}},
        {BOX "&receiver name='snapshot_1', position=3,3,3 /\n", "t.nml:4:11: error:", {"another name"}},
        {BOX "&receiver name='a23456789012345678901234567890123456789012345678901234567890123456789', "
             "position=3,3,3 /\n",
         "t.nml:4:11: error:",
         {"too long", "63"}},
        {BOX "&receiver name='a', position=3,3,3 /\n&receiver name='A', position=1,3,3 /\n",
         "t.nml:5:11: error:",
         {"a receiver 'A' already (&receiver 1)"}},
        {BOX "&receiver name='a', position=3,3,3 /\n&profile name='a', from=0,0,0, to=1,1,1 /\n",
         "t.nml:5:10: error:",
         {"a receiver 'a' already"}},
        {PLATE("shape='plate-with-hole', hole_centre=0,0, hole_radius=.3") "&receiver name='a', "
                                                                           "position=.1,.1 /\n",
         "t.nml:4:21: error:",
         {"lies in the hole"}},
        {BOX "&profile name='a', from=0,0,0, to=1,1,8 /\n", "t.nml:4:32: error:", {"last point", "1, 1, 7"}},
        {BOX "&profile name='a', from=0,0,-1, to=1,1,1 /\n", "t.nml:4:20: error:", {"first point"}},
        {BOX "&profile name='a', from=0,0,0, to=1,1,1, times=1,7 /\n",
         "t.nml:4:42: error:",
         {"7 is after scene%end_time = 6"}},
        {BOX "&snapshot fields='velocity' /\n", "t.nml:4:1: error:", {"every", "times"}},
        {BOX "&snapshot every=1, times=1,2 /\n", "t.nml:4:20: error:", {"not both"}},
        {BOX "&snapshot every=1, region=0,0,0,1,1 /\n", "t.nml:4:20: error:", {"5 values; expected 6"}},
        {BOX "&snapshot every=1, region=0,0,2,1,1,1 /\n",
         "t.nml:4:20: error:",
         {"along z", "lowest corner first"}},
        {BOX "&reference kind='lamb', file='x' /\n", "t.nml:4:25: error:", {"'file' does not belong"}},
        {BOX "&reference kind='file' /\n", "t.nml:4:1: error:", {"needs file"}},
        {BOX "&output directory='' /\n", "t.nml:4:9: error:", {"directory is empty"}},
    };
    REFUSE(cases);
}

#define ACCURATE                                                                                             \
    "&scene dimension=3, end_time=6, accuracy=.01 /\n" ROCK "&body material='rock', shape='half-space' /\n"
#define SEEN_PATCH                                                                                           \
    "&receiver name='r', position=1,0,0 /\n&load face='z-', shape='square', centre=0,0,0, size=1,1, "        \
    "direction=0,0,1, history='gaussian', width=.3, delay=2 /\n"

static void settings(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {"&scene dimension=3, end_time=6, plane='stress' /\n" ROCK BODY,
         "t.nml:1:33: error:",
         {"no meaning in three dimensions"}},
        {"&scene dimension=3, end_time=6, accuracy=.01 /\n" ROCK BODY,
         "t.nml:3:47: error:",
         {"'spacing' does not belong to a deck with scene%accuracy"}},
        {"&scene dimension=3, end_time=6, accuracy=.01 /\n" ROCK BODY,
         "t.nml:1:33: error:",
         {"no table of errors", "patches, forces and moment tensors on half-spaces", "give body%spacing"}},
        {ACCURATE "&method degree=3 /\n" SEEN_PATCH, "t.nml:4:9: error:", {"'degree' does not belong"}},
        {ACCURATE "&stepping courant=.2 /\n" SEEN_PATCH, "t.nml:4:11: error:", {"'courant' does not belong"}},
        {ACCURATE "&output low_pass=9 /\n" SEEN_PATCH, "t.nml:4:9: error:", {"'low_pass' does not belong"}},
        {ACCURATE
         "&load face='z-', shape='point', centre=0,0,0, direction=0,0,1, history='gaussian', width=.3, "
         "delay=2 /\n",
         "t.nml:1:33: error:",
         {"no table of errors", "with receivers"}},
        {"&scene dimension=1, end_time=6, accuracy=.01 /\n" ROCK
         "&body material='rock', shape='box', low=0, high=4 /\n&receiver name='r', position=2 /\n"
         "&initial kind='plane-wave', wave='p', direction=1, centre=1, wavelength=.5, amplitude=1 /\n",
         "t.nml:1:33: error:",
         {"no table of errors", "plane pulses"}},
        {"&scene dimension=2, end_time=6, accuracy=.01 /\n" ROCK
         "&body material='rock', shape='box', low=0,0, high=1,8 /\n&receiver name='r', position=.5,3 /\n"
         "&block material='rock', centre=.5,1, size=1,1 /\n"
         "&initial kind='plane-wave', wave='p', direction=0,1, centre=0,4, width=.5, amplitude=1 /\n",
         "t.nml:1:33: error:",
         {"no table of errors", "a body of one rock"}},
        {ACCURATE
         "&receiver name='r', position=1,0,0 /\n&load face='z-', shape='square', centre=0,0,0, size=1,1, "
         "velocity=.1,0,0, direction=0,0,1, history='gaussian', width=.3, delay=2 /\n",
         "t.nml:1:33: error:",
         {"no table of errors", "loads that do not move"}},
        {ACCURATE SEEN_PATCH "&method name='sph' /\n",
         "t.nml:1:33: error:",
         {"no table of errors", "'consistent'"}},
        {BOX "&method variant='total-lagrangian' /\n",
         "t.nml:4:9: error:",
         {"'smoothed-point' has no variant", "'paper' or 'cloud'"}},
        {BOX "&method name='sph', variant='paper' /\n",
         "t.nml:4:21: error:",
         {"'total-lagrangian' or 'updated-lagrangian'"}},
        {BOX "&stepping time_step=.1, safety=.9 /\n",
         "t.nml:4:25: error:",
         {"one of time_step, courant and safety"}},
        {BOX "&stepping time_step=7 /\n", "t.nml:4:11: error:", {"longer than scene%end_time = 6"}},
        {BOX "&stepping stages=5, max_stages=9 /\n", "t.nml:4:21: error:", {"not both"}},
    };
    REFUSE(cases);
}

static void initial_states(void **unused)
{
    (void)unused;
    static const struct refusal cases[] = {
        {BOX "&initial kind='rest', amplitude=1 /\n",
         "t.nml:4:23: error:",
         {"'amplitude' does not belong to initial kind 'rest'"}},
        {BOX "&initial kind='uniform-velocity' /\n", "t.nml:4:1: error:", {"needs velocity"}},
        {BOX "&initial kind='beam-mode' /\n", "t.nml:4:1: error:", {"needs amplitude"}},
        {BAR "&initial kind='beam-mode', amplitude=.01 /\n", "t.nml:4:10: error:", {"one dimension"}},
        {BOX "&initial kind='plane-wave', direction=1,0,0, amplitude=1 /\n",
         "t.nml:4:1: error:",
         {"needs wavelength", "or width"}},
        {BOX
         "&initial kind='plane-wave', direction=1,0,0, amplitude=1, wavelength=1, width=1, centre=0,0,0 /\n",
         "t.nml:4:73: error:",
         {"either wavelength", "not both"}},
        {BOX "&initial kind='plane-wave', direction=1,0,0, amplitude=1, width=1 /\n",
         "t.nml:4:1: error:",
         {"a pulse needs centre"}},
        {BOX "&initial kind='plane-wave', direction=1,0,0, wavelength=1 /\n",
         "t.nml:4:1: error:",
         {"needs amplitude"}},
        {BOX "&initial kind='plane-wave', direction=0,0,0, wavelength=1, amplitude=1 /\n",
         "t.nml:4:29: error:",
         {"direction is zero"}},
        {BOX "&initial kind='plane-wave', direction=1,0,0, wavelength=1, amplitude=1, polarisation=0,1,0 /\n",
         "t.nml:4:73: error:",
         {"'polarisation' does not belong to a P wave"}},
        {BOX "&initial kind='plane-wave', wave='s', direction=1,0,0, wavelength=1, amplitude=1 /\n",
         "t.nml:4:1: error:",
         {"an S wave needs polarisation"}},
        {BOX "&initial kind='plane-wave', wave='s', direction=1,0,0, wavelength=1, amplitude=1, "
             "polarisation=1,1,0 /\n",
         "t.nml:4:83: error:",
         {"not across the direction", "0, 0.7071067812, 0"}},
        {BOX "&initial kind='plane-wave', wave='s', direction=1,0,0, wavelength=1, amplitude=1, "
             "polarisation=-2,0,0 /\n",
         "t.nml:4:83: error:",
         {"not along it"}},
        {BAR "&initial kind='plane-wave', wave='s', direction=1, wavelength=1, amplitude=1 /\n",
         "t.nml:4:29: error:",
         {"no S waves in one dimension"}},
        {BOX "&initial kind='gaussian', centre=1,1,1, width=1, direction=1,0,0 /\n",
         "t.nml:4:1: error:",
         {"needs amplitude"}},
        {BOX "&initial kind='gaussian', centre=1,1,1, amplitude=1, direction=1,0,0 /\n",
         "t.nml:4:1: error:",
         {"needs width"}},
        {BOX
         "&initial kind='gaussian', centre=1,1,1, width=1, amplitude=1, direction=1,0,0, velocity=1,1,1 /\n",
         "t.nml:4:80: error:",
         {"'velocity' does not belong"}},
    };
    REFUSE(cases);
}

/* All errors of a deck come in one pass. */
static void all_at_once(void **unused)
{
    (void)unused;
    struct from_deck d = from_text("&scene dimension=3, end_time=6 /\n"
                                   "&material name='rock', density=2, young=3, poisson=.5 /\n"
                                   "&body material='rock', low=0,0,0, high=7,7,7, spacing=.3 /\n"
                                   "&boundary face='z-', kind='fixed', slip=T /\n"
                                   "&load face='z-', shape='face', history='step' /\n"
                                   "&initial kind='beam-mode' /\n"
                                   "&receiver name='a', position=9,9,9 /\n"
                                   "&snapshot /\n",
                                   0, NULL);
    assert_int_equal(d.status, SELAS_BAD_DECK);
    assert_int_equal(d.messages.errors, 7);
    from_deck_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials),   cmocka_unit_test(bodies),
        cmocka_unit_test(faces),       cmocka_unit_test(loads),
        cmocka_unit_test(histories),   cmocka_unit_test(receivers_and_outputs),
        cmocka_unit_test(settings),    cmocka_unit_test(initial_states),
        cmocka_unit_test(all_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
