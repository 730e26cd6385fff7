centroid in vec3 color;  // of several samples a pixel, one beyond a ribbon's edge would have any colour
flat in float shown;
#ifdef FOLDS
centroid in vec3 keel;  // how much brighter the face to the right of a fold is than both
#endif
#ifdef TOOTHED
#include "systems/show/blades/toothed.glsl"
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
const float THINNEST = 0.01;  // half a ribbon's width that counts at least [pixel]
const float FAINT = 0.004;  // coverage that is left out: in bytes, it would but be rounded up
noperspective in float aside;
noperspective in float half_width;
#ifdef ORGANS
noperspective in float onward;
flat in float half_length;
#endif
#endif

#ifndef DEEP
#include "systems/show/blades/veins.glsl"

flat in vec2 veined;  // how much is seen of its rib; and of its veins
#ifndef SOFT
in vec2 across;  // from left to right, times how wide it is there; and that
#endif
#endif

out vec4 pixel;

// How much wider a ribbon is drawn than it is, for its edges to be soft.
float drawn_wider() {
#ifdef SOFT
    return 1.0 + 0.5 / max(half_width, THINNEST);
#else
    return 1.0;
#endif
}

void main() {
#ifdef TOOTHED
    vec2 place = among_ligules(drawn_wider()), finely = fwidth(place);
#endif
#if !defined(SOFT) && !defined(DEEP)
    float beside = across.x / across.y, half_wide = 1.0 / fwidth(beside);
#endif
#ifdef SOFT
    float wide = half_width, left = 1.0;
    vec3 seen = color;
#ifndef DEEP
    seen *= across_veins(veined, aside / max(half_width, THINNEST), half_width);
#endif
#ifdef TOOTHED
    if (tooth.z != 0.0) {
        Outline outline = outline_at(aside, place, finely);
        wide *= outline.wide;
        seen *= outline.bright;
        left = outline.covers;
    }
#endif
    float covered = shown * left * clamp(wide + 0.5 - abs(aside), 0.0, min(1.0, 2.0 * wide));
#ifdef ORGANS
    covered *= clamp(half_length + 0.5 - abs(onward), 0.0, min(1.0, 2.0 * half_length));
#endif
    covered = covered < FAINT ? 0.0 : covered;
#ifdef DEEP
    if (covered < depth_threshold(number, clamp(2.0 - 2.0 * half_width, 0.0, 1.0)))
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
#ifndef DEEP
    seen *= across_veins(veined, beside, half_wide);
#endif
#ifdef TOOTHED
    if (tooth.z != 0.0) {
        Outline outline = outline_at(tooth.y, place, finely);
        if (outline.covers < 0.5 || abs(tooth.y) > outline.wide && tooth.z > 0.0)
            discard;
        seen *= outline.bright;
    }
#endif
    pixel = vec4(seen * shown, shown);
#endif
}
