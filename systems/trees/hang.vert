// A twig on its card, or with LEAVES leaf by leaf: its position in the wind, and its light.
#include "systems/trees/twig.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/pigment.glsl"

out vec4 hung_at;        // its foot [m]; its length, 0 where it is left out [m]
flat out uvec4 hung_axes;
flat out uvec4 hung_light;
#ifdef LEAVES
flat out uvec2 hung_haze;
#endif

uniform bool whole;  // whether all its twigs are drawn: they are sorted from near to far then, so that they hide one another

// Index of the twig in its order, or by distance.
int next_twig() {
    if (!whole)
        return gl_VertexID;
    vec3 to = turned_back(eye - root);
    bool along_x = abs(to.x) > abs(to.z);
    int place = (along_x ? to.x : to.z) > 0.0 ? twigs - 1 - gl_VertexID : gl_VertexID;
    int both = int(twig_of(place).orders);
    return along_x ? both % ORDERS : both / ORDERS;
}

#ifdef LEAVES
in float first;  // index of the twig, or of the first of them
const bool LEAF_BY_LEAF = true;

void tell_leaves(int number, vec3 along, vec3 aside, float turns, Light above, vec3 below) {
    pack(HungLeaves(along, aside, above.sun, above.sky, below, above.haze, turns, number), hung_axes, hung_light, hung_haze);
}
#else
#include "systems/trees/normals.glsl"

const bool LEAF_BY_LEAF = false;

vec3 shows(float tone, Light light) {
    return tone_mapped(shade(Surface(pigment_of(tone, 0.0, 0.0), 1.0, LEAF_SCATTERING), light));
}

void tell_card(vec3 along, vec3 aside, vec3 facing, vec4 chance, float picture, Light light, vec3 below) {
    mat3 own = mat3(aside, along, facing);
    vec3 ray = normalize(hung_at.xyz + 0.5 * hung_at.w * along - eye);
    Seen seen = seen_of(own, ray, light, below);
    light.sun *= seen.sends;
    light.sky = mix(below, light.sky, 0.5 + 0.5 * seen.up);
    vec3 towards = sun * own * (dot(facing, ray) > 0.0 ? -seen.turns : seen.turns);
    vec4 relief = seen.darker * vec4(towards, 1.0 - dot(towards, seen.faces));
    pack(HungCard(along, aside, relief, shows(0.0, light), shows(CARD_TONES.x + CARD_TONES.y * chance.z, light), picture), hung_axes, hung_light);
}
#endif

void main() {
#ifdef LEAVES
    int number = int(first + 0.5) + gl_VertexID;
#else
    int number = next_twig();
#endif
    Twig one = twig_of(number);
    vec4 chance = random(number, 0, 3);
    float picture = LEAF_BY_LEAF ? 0.0 : picture_of(chance.y), size = size_of((float(number) + 0.5) / float(twigs), int(picture));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    hung_at = vec4(root, 0.0);
    hung_axes = hung_light = uvec4(0u);
#ifdef LEAVES
    hung_haze = uvec2(0u);
#endif
    if (size <= 0.0 || (chance.w < leaf_by_leaf(one.foot)) != LEAF_BY_LEAF)
        return;
    if (!LEAF_BY_LEAF)
        one.face = face_of(one);
    vec3 aside = cross(one.along, one.face);
    float turns = flutter(chance), length_of = size * one.span;
    one.foot -= 0.5 * max(length_of - one.span, 0.0) * one.along;  // it grows about its middle: a crown stays as wide
    hung_at = vec4(swayed(one.foot, one.pivot, one.limb, one.hertz, message), scale * length_of);
    vec3 facing = normalize(turned(one.face + turned_by(one.along, aside, turns)));
    vec3 along = turned(LEAF_BY_LEAF ? one.along : one.along + fluttered(one.face, aside, turns));
    Light above = light_in_crown(hung_at.xyz + 0.5 * hung_at.w * along, one.shading, 1.0);
    vec3 below = sky_on(vec3(0.0), lawn_sends, sky_through(one.shading, foliage), -1.0) * tint * (1.0 - misty.a);
#ifdef LEAVES
    tell_leaves(number, along, turned(aside), turns, above, below);
#else
    tell_card(along, turned(aside), facing, chance, picture, above, below);
#endif
}
