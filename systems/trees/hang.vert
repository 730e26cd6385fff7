// A twig on its card, or with LEAVES leaf by leaf: its position in the wind, and its light.
#include "systems/trees/twig.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/pigment.glsl"

#ifdef LEAVES
out vec4 hung_at;        // its foot [m]; its length, 0 where it is left out [m]
flat out uvec4 hung_axes;
flat out uvec4 hung_light;
flat out uvec2 hung_haze;
#else
flat out uvec4 hung_place;
flat out uvec4 hung_look;
#endif

in float first;  // index of the twig, or of the first of them; of a block of neighbours on cards, -1 less the place of its first twig

// Index of the twig, and of none where there are no more.
int next_twig() {
    int from = int(round(first));
    if (from >= 0)
        return from + gl_VertexID;
    int place = gl_VertexID - 1 - from;
    return place < twigs ? int(twig_of(place).grouped) : twigs;
}

#ifdef LEAVES
const bool LEAF_BY_LEAF = true;

void leave_out() {
    hung_at = vec4(0.0);
    hung_axes = hung_light = uvec4(0u);
    hung_haze = uvec2(0u);
}

void write_leaves(vec4 at, int number, vec3 along, vec3 aside, float rotation, Light above, vec3 below) {
    hung_at = at;
    pack(HungLeaves(along, aside, above.sun, above.sky, below, above.haze, rotation, number), hung_axes, hung_light, hung_haze);
}
#else
#include "systems/trees/normals.glsl"

const bool LEAF_BY_LEAF = false;

uniform vec3 hung_from;  // origin of places [m]

void leave_out() {
    hung_place = hung_look = uvec4(0u);
}

vec3 card_colour(float tone, Light light) {
    return tone_mapped(shade(Surface(pigment_of(tone, 0.0, 0.0), 1.0, LEAF_SCATTERING), light));
}

void write_card(vec4 at, vec3 along, vec3 aside, vec3 facing, vec4 chance, float picture, Light light, vec3 below) {
    mat3 own = mat3(aside, along, facing);
    vec3 ray = normalize(at.xyz + 0.5 * at.w * along - eye);
    LeafMean leaves = leaf_mean(own, ray, light, below);
    light.sun *= leaves.radiance;
    light.sky = mix(below, light.sky, 0.5 + 0.5 * leaves.up);
    vec3 towards = sun * own * (dot(facing, ray) > 0.0 ? -leaves.sun_gain : leaves.sun_gain);
    vec4 relief = leaves.darkening * vec4(towards, 1.0 - dot(towards, pictured_normal.xyz));
    vec3 darkest = card_colour(0.0, light), brightest = card_colour(CARD_TONES.x + CARD_TONES.y * chance.z, light);
    pack(HungCard(at.xyz - hung_from, at.w, along, aside, relief, darkest, brightest, picture), hung_place, hung_look);
}
#endif

void main() {
    int number = next_twig();
    bool missing = number >= twigs;
    number = min(number, twigs - 1);
    Twig twig = twig_of(number);
    vec4 chance = random(number, 0, 3);
    float picture = LEAF_BY_LEAF ? 0.0 : twig_picture(chance.y), size = twig_size((float(number) + 0.5) / float(twigs), int(picture));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    leave_out();
    if (missing || size <= 0.0 || (chance.w < leaf_share(twig.foot)) != LEAF_BY_LEAF)
        return;
    if (!LEAF_BY_LEAF)
        twig.face = card_normal(twig);
    vec3 aside = cross(twig.along, twig.face);
    float rotation = leaf_rotation(chance), length_of = size * twig.span;
    twig.foot -= 0.5 * max(length_of - twig.span, 0.0) * twig.along;  // it grows about its middle: a crown stays as wide
    vec4 at = vec4(swayed(twig.foot, twig.pivot, twig.limb, twig.hertz, message), scale * length_of);
    vec3 facing = normalize(to_world(twig.face + normal_change(twig.along, aside, rotation)));
    vec3 along = to_world(LEAF_BY_LEAF ? twig.along : twig.along + tip_offset(twig.face, aside, rotation));
    Light above = light_in_crown(at.xyz + 0.5 * at.w * along, twig.shading, 1.0);
    vec3 below = hemisphere_light(vec3(0.0), light_from_grass, sky_transmittance(twig.shading, foliage), -1.0) * tint * (1.0 - haze_in_front.a);
#ifdef LEAVES
    write_leaves(at, number, along, to_world(aside), rotation, above, below);
#else
    write_card(at, along, to_world(aside), facing, chance, picture, above, below);
#endif
}
