// All about light: how a place lies to it, what shades it, surfaces and what they send to the eye, haze, and what is shown.
// Light is linear radiance.
#include "lib/surface.glsl"
#include "lib/soil.glsl"
#include "lib/tone.glsl"
