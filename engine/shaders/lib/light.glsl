// Everything about light: normals, shadows, surfaces, haze and tone mapping. Light is linear radiance.
#include "lib/surface.glsl"
#include "lib/soil.glsl"
#include "lib/tone.glsl"
