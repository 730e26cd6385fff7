// Leaves: their outlines, and how they send light.
#include "systems/trees/habit.py"

uniform int form;
uniform vec3 dark;   // pigments: of leaves, and of bark
uniform vec3 bright;
uniform vec3 bark;
uniform float rough; // how deeply bark is furrowed; below 0 it has bands across

// Half the width of a leaf at a part of its length, of its greatest.
float half_width(float along) {
    if (form == LANCE)
        return sin(3.1416 * pow(along, 0.8));
    if (form == DELTOID)
        return smoothstep(-0.02, 0.2, along) * pow(1.0 - along, 0.85) * 1.12;
    if (form == LOBED)
        return pow(along, 0.55) * pow(1.0 - along, 0.35) * 1.38 * (0.8 + 0.2 * cos(along * 26.0));
    return 1.95 * pow(along, 0.55) * pow(1.0 - along, 0.8);
}

// How much of a pixel is leaf, at a place on its quad: across from -1 to 1, and along from 0 to 1.
float leaf_cover(vec2 on) {
    if (form == NEEDLES) {  // pairs of needles that part from their foot
        float fan = on.x / (0.25 + 0.75 * on.y), each = abs(fract(fan * 3.5) - 0.5) * 2.0;
        float needle = each - 0.5 - 0.2 * on.y, soft = max(fwidth(fan) * 7.0, 1e-4);
        float ends = clamp((1.0 - 0.18 * abs(fan) - on.y) / max(fwidth(on.y), 1e-4) + 0.5, 0.0, 1.0);
        return mix(clamp(needle / soft + 0.5, 0.0, 1.0), 0.45, clamp(soft - 0.8, 0.0, 1.0)) * ends * step(abs(fan), 1.0);
    }
    float inside = half_width(clamp(on.y, 0.001, 0.999)) - abs(on.x);
    return clamp(inside / max(fwidth(inside), 1e-4) + 0.5, 0.0, 1.0);
}

const vec3 LEAF_THROUGH = vec3(0.92, 1.08, 0.42);  // light that leaves let through, of what they send back: more yellow
const float SENDS = 1.25;  // what a white face sends of the sun's light from straight ahead, of what a leaf facing all ways does
const float STREWN = 0.45;  // of a twig's leaves that face all ways, whatever its face is

// What leaves with this face send to the eye of the sun's light.
vec3 leaf_sends(vec3 normal, vec3 ray) {
    float lit = dot(normal, sun) * -sign(dot(normal, ray)), facing = dot(ray, sun);
    vec3 one = SENDS * (max(lit, 0.0) + max(-lit, 0.0) * LEAF_THROUGH);
    float back = 0.5 - 0.5 * facing, against = 1.0 - back;
    return mix(one, back * sqrt(back) + against * sqrt(against) * LEAF_THROUGH, STREWN);
}

// The pigment of leaves, dark to bright, or of bark.
vec3 pigment_of(float tone, float wood) {
    return mix(mix(dark, bright, tone), bark, wood);
}
