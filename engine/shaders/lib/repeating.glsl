// A texture that repeats over the land: the clouds' map and the litter's pattern.
#include "systems/light/repeating.py"

uniform sampler2D repeating;  // density of clouds; root of the ground's brightness, and coverage by low leaves
