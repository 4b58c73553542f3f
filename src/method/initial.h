/* The state at t = 0 stands with the scene, for exact solutions use it too. */
#include "scene/initial.h"
