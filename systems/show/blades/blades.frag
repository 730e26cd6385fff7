centroid in vec3 color;  // of several samples a pixel, one beyond a ribbon's edge would have any colour
flat in float shown;
#ifdef FOLDS
centroid in vec3 keel;  // how much brighter the face to the right of a fold is than both
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"

in vec3 tooth;  // which of them, from the root on; from left, -1, to right, 1; how much is seen

// How wide a ribbon with teeth is here, of how wide it is drawn; how bright, of its colour. Those of its sides take turns.
vec2 toothed(float to_side) {
    float up = fract(tooth.x + (to_side > 0.0 ? 0.5 : 0.0)), end = min(up / ENDS_AT, (1.0 - up) / (1.0 - ENDS_AT));
    float wide = mix(1.0, TOOTHED_WIDER * mix(BETWEEN, 1.0, end), tooth.z);
    return vec2(wide / mix(1.0, TOOTHED_WIDER, tooth.z), 1.0 + tooth.z * OUTER * (end - MEAN_END));
}
#endif
#ifdef DEEP
#include "systems/show/deep.glsl"

flat in int number;
#endif
#ifdef PARTED
uniform int part;     // 1: where it hides what is behind it; 2: the rest
flat in float hides;  // coverage from which on it does
#endif
#ifdef SOFT
const float FAINT = 0.004;  // coverage that is left out: in bytes, it would but be rounded up
noperspective in float aside;
noperspective in float half_width;
#ifdef ORGANS
noperspective in float onward;
flat in float half_length;
#endif
#endif

out vec4 pixel;

void main() {
#ifdef SOFT
    float wide = half_width;
    vec3 seen = color;
#ifdef TOOTHED
    if (tooth.z > 0.0) {
        vec2 of_tooth = toothed(aside);
        wide *= of_tooth.x;
        seen *= of_tooth.y;
    }
#endif
    float covered = shown * clamp(wide + 0.5 - abs(aside), 0.0, min(1.0, 2.0 * wide));
#ifdef ORGANS
    covered *= clamp(half_length + 0.5 - abs(onward), 0.0, min(1.0, 2.0 * half_length));
#endif
    covered = covered < FAINT ? 0.0 : covered;
#ifdef DEEP
    if (covered < least_cover(number, clamp(2.0 - 2.0 * half_width, 0.0, 1.0)))
        discard;
#endif
#ifdef PARTED
    if (covered == 0.0 || (covered < hides) == (part == 1))
        discard;
#endif
#ifdef DEEP
    pixel = vec4(0.0);
#elif defined(FOLDS)
    // Each face of a fold is evenly lit: the ramp from side to side, as corners have it, becomes a step.
    pixel = vec4((seen + keel * (clamp(2.0 * aside, -1.0, 1.0) - aside / (half_width + 0.5))) * covered, covered);
#else
    pixel = vec4(seen * covered, covered);
#endif
#else
    vec3 seen = color;
#ifdef TOOTHED
    if (tooth.z > 0.0) {
        vec2 of_tooth = toothed(tooth.y);
        if (abs(tooth.y) > of_tooth.x)
            discard;
        seen *= of_tooth.y;
    }
#endif
    pixel = vec4(seen * shown, shown);
#endif
}
