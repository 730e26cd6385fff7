// Depth of what covers pixels only in part: written where it covers at least half of one. What is thinner than a pixel, or is
// the mean of many that are, covers no pixel so far: it writes depth in as many pixels as it covers in all, drawn by lot
// (Enderton, Sintorn, Shirley, Luebke, Stochastic Transparency, 2010). So as much is seen past many as past all of them drawn.
#include "lib/random.glsl"

// How much something must cover to write depth, by its number: half, and any part where all of it is `thin`, which is 0 to 1.
float least_cover(int number, float thin) {
    return 0.5 + thin * (unit(hash3(int(gl_FragCoord.x), int(gl_FragCoord.y), number)) - 0.5);
}
