// Twigs: motion in the wind, size, and which are drawn leaf by leaf.
#include "lib/random.glsl"
#include "systems/trees/tree.glsl"
#include "systems/trees/habit.py"
#include "systems/trees/twig.py"

uniform int form;           // outline of its leaves
uniform int twigs;          // number of its model's twigs
uniform vec3 picture_cover; // coverage of each picture of its card, relative to the first one's
uniform vec3 leaf_shape;    // length, half the greatest width, angle from the twig [usual length of a twig; rad]
#ifdef BAKED
uniform mat4 baked;
#else
uniform vec2 leaf_pixels; // length of a leaf from which on twigs begin to be drawn leaf by leaf, and from which on all are [pixels]
#endif

const uvec4 BYTES_AT = uvec4(0u, 8u, 16u, 24u);  // offsets of the bytes of a number [bits]
const float ASKEW = 0.01;  // keeps two directions from being one
const vec2 CARD_TONES = vec2(0.9, 0.2);  // least tone of a card, and its range
const float NEAREST_TWIG = 0.1;  // least distance of a twig [m]

// Four random numbers from 0 to 1 of a twig's leaf.
vec4 random(int twig, int leaf, int number) {
    return vec4(uvec4(hash3(twig, leaf, number)) >> BYTES_AT & uint(BYTE)) / BYTE;
}

// Picture that its card shows: one with the leaves of as many twigs as it stands for.
float twig_picture(float chance) {
    float more = -log(max(twig_share, LEAST_KEPT)) / log(TWIGS_EACH);
    return clamp(floor(more + chance), 0.0, float(PICTURES) - 1.0);
}

// Size of a twig with such a picture, relative to its own: 0 where it is left out.
float twig_size(float rank, int picture) {
    float shown = min(twig_share * (1.0 - far_fade), 1.0) * foliage;
    float kept = clamp((shown - rank) * RANKS + 0.5, 0.0, 1.0) * min(foliage * RANKS, 1.0);  // none is left without leaves
    return kept * inversesqrt(max(twig_share, LEAST_KEPT) * picture_cover[picture]);
}

#ifndef BAKED
// Normal of a twig's card: needles stand all around their twig, so their card turns to the eye.
vec3 card_normal(Twig twig) {
    if (form != NEEDLES)
        return twig.face;
    vec3 to = to_model(eye - root) - scale * twig.foot;
    return normalize(to - dot(to, twig.along) * twig.along + ASKEW * twig.face);
}

// Share of twigs at a place of its model that are drawn leaf by leaf, by the size of leaves.
float leaf_share(vec3 place) {
    float off = max(distance(eye, root + scale * to_world(place)), NEAREST_TWIG);
    float pixels = scale * leaf_length * pixels_per_metre() / off;
    return clamp((pixels - leaf_pixels.x) / (leaf_pixels.y - leaf_pixels.x), 0.0, 1.0);
}

// Rotation of its leaves by the wind [rad].
float leaf_rotation(vec4 chance) {
    return LEAF_TURNS * min(length(message), 1.0) * swing(mix(LEAF_HERTZ.x, LEAF_HERTZ.y, chance.x), chance.y + phase);
}

// Displacement of a twig's tip by that, relative to its length.
vec3 tip_offset(vec3 face, vec3 aside, float rotation) {
    return rotation * (FLUTTERS.x * face + FLUTTERS.y * aside);
}

// Change of its leaves' normals by that.
vec3 normal_change(vec3 along, vec3 aside, float rotation) {
    return rotation * (aside + 0.5 * along);
}
#endif
