// Texture of litter and low leaves on the ground, averaged over a pixel.
#include "lib/random.glsl"
#include "lib/soil.glsl"
#include "systems/show/carpet/footprint.glsl"

const int HALF_OF_BITS = 65536;
const vec2 WAVES = vec2(2.9, 0.15);  // waves of the squares' borders, as straight ones would show: wave number [1/m]; amplitude, in sides

// Texture coordinates of a place. Each square of the tiling has its own random offset, as equal squares would show as a lattice from
// above. Coordinates begin in each square: beside a triangle that reaches behind the eye places are endless, and a software rasteriser's
// anisotropic filter would go through all texels up to there.
vec2 tiled_place(vec2 at) {
    vec2 square = floor(at / LITTER_SIDE + WAVES.y * abs(fract(WAVES.x * at.yx) - 0.5));
    ivec2 number = ivec2(square);
    uint random_bits = scramble(uint(HALF_OF_BITS * number.x + number.y));
    vec2 offset = vec2(random_bits % uint(HALF_OF_BITS), random_bits / uint(HALF_OF_BITS)) / float(HALF_OF_BITS);
    return at / LITTER_SIDE - square + offset;
}

#ifdef ANISOTROPIC
const float SHARPENED = exp2(-LITTER_SHARPER) / LITTER_SIDE;

// At a low angle the footprint is a long stripe of ground: the sampler is anisotropic.
vec2 litter_at(vec2 at, vec2 dx, vec2 dy, float bare) {
    return textureGrad(repeating, tiled_place(at), dx * SHARPENED, dy * SHARPENED).gb;
}
#else
const float LITTER_PARTS = 4.0;  // most parts of a long stripe, one behind the other
const float BARE_ENOUGH = 0.2;   // fraction of the ground seen between grass at which all parts are read
const float ONE_PART = 0.1;      // fraction of a further part that is left out

// At a low angle the footprint is a long stripe of ground. Anisotropic filtering is too slow on a processor: parts of the stripe are read
// one behind another along the line of sight, fewer where little of the ground is `bare`, seen between the grass. Each part is read at
// the single level that fits best; where one part is enough, it is read at two levels.
vec2 litter_at(vec2 at, vec2 dx, vec2 dy, float bare) {
    vec2 along = dot(dx, dx) > dot(dy, dy) ? dx : dy, sum = vec2(0.0);
    float parts = min(1.0 / narrowed(dx, dy), mix(1.0, LITTER_PARTS, min(bare / BARE_ENOUGH, 1.0)));
    float count = max(ceil(parts - ONE_PART), 2.0);
    float level = log2(length(along) * float(textureSize(repeating, 0).x) / (LITTER_SIDE * parts)) - LITTER_SHARPER;
    float apart = max(2.0 - parts, 0.0) / count;  // mip levels from a part to the next
    vec2 step = along * ((1.0 - 1.0 / parts) / ((count - 1.0) * LITTER_SIDE)), first = tiled_place(at) - 0.5 * (count - 1.0) * step;
    float part = 0.0;
    do  // a software rasteriser executes the body once more where a loop tests first
        sum += textureLod(repeating, first + part * step, level + (part - 0.5 * count + 0.5) * apart).gb;
    while (++part < count);
    return sum / count;
}
#endif
