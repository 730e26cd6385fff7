// What is read of litter and low leaves on the ground, in the mean over a pixel.
#include "lib/random.glsl"
#include "lib/soil.glsl"
#include "systems/show/carpet/footprint.glsl"

const float LITTER_SHARPER = 0.4;  // how much finer texels are than what is read, in levels: filtering takes grain away
const int HALF_OF_BITS = 65536;
const vec2 WAVES = vec2(2.9, 0.15);  // of the squares' borders, which would be seen if they were straight [1/m]; as parts of a side

// Where in the square that repeats a place of the ground is taken from, in its sides: squares side by side would show as a lattice
// from above. So each is shifted by its own way, and has almost all of it.
vec2 taken_from(vec2 at) {
    ivec2 square = ivec2(floor(at / LITTER_SIDE + WAVES.y * abs(fract(WAVES.x * at.yx) - 0.5)));
    uint drawn = scramble(uint(HALF_OF_BITS * square.x + square.y));
    return at / LITTER_SIDE + vec2(drawn % uint(HALF_OF_BITS), drawn / uint(HALF_OF_BITS)) / float(HALF_OF_BITS);
}

#ifdef ANISOTROPIC
const float SHARPENED = exp2(-LITTER_SHARPER) / LITTER_SIDE;

// From a low angle a pixel is a long stripe of ground: the sampler is anisotropic.
vec2 lying_seen(vec2 at, vec2 dx, vec2 dy, float bare) {
    return textureGrad(repeating, taken_from(at), dx * SHARPENED, dy * SHARPENED).gb;
}
#else
const float LITTER_PARTS = 4.0;  // a long stripe is taken in so many parts at most, one behind the other
const float BARE_ENOUGH = 0.2;   // how much of the ground is to be seen between grass for all of them to count
const float ONE_PART = 0.1;      // a stripe counts as longer than so many parts from so much of the next on

// From a low angle a pixel is a long stripe of ground. Anisotropic filtering costs a processor too much: parts of the stripe are
// read that lie one behind another along the line of sight, fewer where little of the ground is `bare`, seen between the
// grass. Each part is read at the one level that fits best; where one part is enough, two levels share it.
vec2 lying_seen(vec2 at, vec2 dx, vec2 dy, float bare) {
    vec2 along = dot(dx, dx) > dot(dy, dy) ? dx : dy, sum = vec2(0.0);
    float parts = min(1.0 / narrowed(dx, dy), mix(1.0, LITTER_PARTS, min(bare / BARE_ENOUGH, 1.0)));
    float count = max(ceil(parts - ONE_PART), 2.0);
    float level = log2(length(along) * float(textureSize(repeating, 0).x) / (LITTER_SIDE * parts)) - LITTER_SHARPER;
    float apart = max(2.0 - parts, 0.0) / count;  // levels from a part to the next
    vec2 step = along * ((1.0 - 1.0 / parts) / ((count - 1.0) * LITTER_SIDE)), first = taken_from(at) - 0.5 * (count - 1.0) * step;
    float part = 0.0;
    do  // a rasteriser in software goes through the body once more where a loop asks first
        sum += textureLod(repeating, first + part * step, level + (part - 0.5 * count + 0.5) * apart).gb;
    while (++part < count);
    return sum / count;
}
#endif
