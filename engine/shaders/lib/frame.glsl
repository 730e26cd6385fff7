// What every program knows of a frame, and of the kinds of grass.
#include "systems/frame/block.py"
#include "lib/kinds.glsl"
