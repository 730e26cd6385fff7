// Depth of fragments that cover their pixel in part: written from a coverage of one half on. Things thinner than a pixel, and
// texels that are means of many of them, cover no pixel so far. They write depth in a random part of their pixels, as large as
// their coverage (stochastic transparency: Enderton, Sintorn, Shirley, Luebke 2010). So many of them let as much through as if
// blended.
#include "lib/random.glsl"

// Coverage from which on a thing writes depth: one half, or for a thing that is `thin` (0 to 1) a random threshold by its number.
float depth_threshold(int number, float thin) {
    return 0.5 + thin * (unit(hash3(int(gl_FragCoord.x), int(gl_FragCoord.y), number)) - 0.5);
}
