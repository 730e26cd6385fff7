#include "lib/kinds.glsl"

uniform ByKind bears;  // by kind: whether it has any heads
