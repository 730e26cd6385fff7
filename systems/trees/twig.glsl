// Twigs of trees: how they stand in the wind, how large they are drawn, and which of them leaf by leaf.
#include "lib/random.glsl"
#include "systems/trees/tree.glsl"
#include "systems/trees/habit.py"
#include "systems/trees/twig.py"

uniform int form;         // of its leaves
uniform int twigs;        // of its model
uniform vec4 card;        // how far it reaches: left and right, from its foot back, and along [of a twig's usual length]
uniform vec3 hides;       // by picture of its card: how much that covers, of what the first does
uniform float usual;      // usual length of a twig [m]
uniform vec3 leaf_shape;  // length, half the greatest width, angle from the twig [of a twig's usual length; rad]
#ifdef BAKED
uniform mat4 baked;
#else
uniform vec2 leaf_pixels; // length of a leaf from which on twigs begin to be drawn leaf by leaf, and from which all are [pixels]
#endif

const uvec4 BYTES_AT = uvec4(0u, 8u, 16u, 24u);  // bits before the bytes of a number
const float ASKEW = 0.01;  // keeps two directions from being one
const vec2 FLUTTERS = vec2(0.4, 0.25);  // how far what hangs on a twig is moved out of its face and aside, of how far leaves turn
const vec2 CARD_TONES = vec2(0.9, 0.2);  // the least tone of a card, and how much more it may be
const float NEAREST_TWIG = 0.1;  // how far off a twig counts as at least [m]

// Four numbers from 0 to 1 that a leaf of a twig has.
vec4 random(int twig, int leaf, int number) {
    return vec4(uvec4(hash3(twig, leaf, number)) >> BYTES_AT & uint(BYTE)) / BYTE;
}

// Which picture its card shows: where it stands for several twigs, one with the leaves of as many.
float picture_of(float chance) {
    float more = -log(max(keep, LEAST_KEPT)) / log(TWIGS_EACH);
    return clamp(floor(more + chance), 0.0, float(PICTURES) - 1.0);
}

// How large a twig is drawn that shows such a picture, as much of them all: 0 where it is left out.
float size_of(float rank, int picture) {
    float shown = min(keep * (1.0 - gone), 1.0) * foliage;
    float dwindles = clamp((shown - rank) * RANKS + 0.5, 0.0, 1.0) * min(foliage * RANKS, 1.0);  // without leaves, none is left
    return dwindles * inversesqrt(max(keep, LEAST_KEPT) * hides[picture]);
}

// Which way a twig's card faces: needles stand all around theirs, so that turns to the eye.
vec3 face_of(Twig twig) {
    if (form != NEEDLES)
        return twig.face;
#ifdef BAKED
    vec3 to = -vec3(baked[0].z, baked[1].z, baked[2].z);
#else
    vec3 to = turned_back(eye - root) - scale * twig.foot;
#endif
    return normalize(to - dot(to, twig.along) * twig.along + ASKEW * twig.face);
}

#ifndef BAKED
// The share of twigs at a place of its model whose leaves are drawn each by itself: where they are large enough.
float leaf_by_leaf(vec3 own) {
    float off = max(distance(eye, root + scale * turned(own)), NEAREST_TWIG);
    float pixels = scale * usual * leaf_shape.x * pixels_a_metre() / off;
    return clamp((pixels - leaf_pixels.x) / (leaf_pixels.y - leaf_pixels.x), 0.0, 1.0);
}

// By how much of an angle its leaves are turned just now [rad].
float flutter(vec4 chance) {
    return LEAF_TURNS * min(length(message), 1.0) * swing(mix(LEAF_HERTZ.x, LEAF_HERTZ.y, chance.x), chance.y + phase);
}

// How far that moves what hangs on a twig at its tip, of its length.
vec3 fluttered(vec3 face, vec3 aside, float turns) {
    return turns * (FLUTTERS.x * face + FLUTTERS.y * aside);
}

// By how much that turns a face that its leaves have.
vec3 turned_by(vec3 along, vec3 aside, float turns) {
    return turns * (aside + 0.5 * along);
}
#endif
