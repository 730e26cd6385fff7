// What is the same all over a twig, on its card or with LEAVES leaf by leaf: where it hangs in the wind, and what light comes to it.
#include "systems/trees/twig.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/pigment.glsl"

out vec4 hung_at;        // its foot [m]; how long it is, 0 where it is left out [m]
flat out uvec4 hung_axes;
flat out uvec4 hung_light;
flat out uvec2 hung_haze;

uniform bool whole;  // whether all its twigs are drawn: they are told from near to far then, so that they hide one another

// The twig that is the next in its order, or by how far off it is.
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
in float first;  // the twig that is drawn, or the first of those
const bool LEAF_BY_LEAF = true;

void tell_leaves(int number, Twig one, vec3 aside, float turns) {
    vec3 along = turned(one.along);
    Light light = light_in_crown(hung_at.xyz + 0.5 * hung_at.w * along, one.shading, 1.0);
    vec3 below = sky_on(vec3(0.0), from_below(), sky_through(one.shading, foliage), -1.0) * tint * (1.0 - misty.a);
    pack(HungLeaves(along, aside, light.sun, light.sky, below, light.haze, turns, number), hung_axes, hung_light, hung_haze);
}
#else
const bool LEAF_BY_LEAF = false;

uniform sampler2DArray tree_cards;  // as pictured.glsl has it

const int SPOTS = 4;  // of a card across and up, at which is asked how its leaves lie
const float SPOT_LEVEL = 4.0;  // level of its picture there
const float CURVES = 0.5;  // power of radiance by which its colour goes, about

// How a card's leaves lie: what they send to the eye of the sun's light, and which way they face, in the mean.
void lie_on_card(mat3 own, vec3 ray, out vec3 sends, out vec3 faces) {
    float cover = LEAST_PART;
    sends = faces = vec3(0.0);
    for (int spot = 0; spot < SPOTS * SPOTS; spot++) {
        vec2 at = (vec2(spot % SPOTS, spot / SPOTS) + 0.5) / float(SPOTS);
        vec4 lie = textureLod(tree_cards, vec3(at, 1.0), SPOT_LEVEL);
        vec3 normal = 2.0 * lie.rgb - lie.a;
        cover += lie.a;
        faces += normal;
        sends += lie.a * leaf_sends(own * (normal * inversesqrt(max(dot(normal, normal), LEAST_SQUARE))), ray);
    }
    faces /= cover;
    sends /= cover;
}

vec3 shows(float tone, float wood, Light light) {
    return shown_of(shade(Surface(pigment_of(tone, wood), 1.0, AMONG_LEAVES), light));
}

void tell_card(vec3 along, vec3 aside, vec3 facing, float tone, Light light) {
    mat3 own = mat3(aside, along, facing);
    vec3 sends, faces, ray = normalize(hung_at.xyz + 0.5 * hung_at.w * along - eye);
    lie_on_card(own, ray, sends, faces);
    // What a face sends more as it turns to the sun, of all that is sent.
    float lit = dot(own * faces, sun) * -sign(dot(own * faces, ray));
    vec3 turned_to = (lit < 0.0 ? -LEAF_THROUGH : vec3(1.0)) * light.sun * ((1.0 - STREWN) * SENDS);
    light.sun *= sends;
    vec3 pigment = pigment_of(0.5, 0.0), albedo = pigment * pigment;
    float steep = CURVES * brightness(albedo * turned_to) / max(brightness(albedo * (light.sun + light.sky) + light.haze), DARKEST);
    vec3 towards = transpose(own) * sun * (steep * -sign(dot(own * faces, ray)));
    vec4 relief = vec4(towards, 1.0 - dot(towards, faces));
    HungCard told = HungCard(along, aside, relief, shows(0.0, 0.0, light), shows(tone, 0.0, light), shows(0.0, 1.0, light));
    pack(told, hung_axes, hung_light, hung_haze);
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
    float size = size_of((float(number) + 0.5) / float(twigs));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    hung_at = vec4(root, 0.0);
    hung_axes = hung_light = uvec4(0u);
    hung_haze = uvec2(0u);
    if (size <= 0.0 || (chance.w < leaf_by_leaf(one.foot)) != LEAF_BY_LEAF)
        return;
    if (!LEAF_BY_LEAF)
        one.face = face_of(one);
    vec3 aside = cross(one.along, one.face);
    float turns = flutter(chance), length_of = size * one.span;
    one.foot -= 0.5 * max(length_of - one.span, 0.0) * one.along;  // it is larger about its middle: a crown stays as wide
    hung_at = vec4(swayed(one.foot, one.pivot, one.limb, one.hertz, message), scale * length_of);
#ifdef LEAVES
    tell_leaves(number, one, turned(aside), turns);
#else
    vec3 facing = normalize(turned(one.face + turned_by(one.along, aside, turns)));
    vec3 along = turned(one.along + fluttered(one.face, aside, turns));
    vec3 middle = hung_at.xyz + 0.5 * hung_at.w * along;
    Light light = light_in_crown(middle, one.shading, facing.y * sign(dot(facing, eye - middle)));
    tell_card(along, turned(aside), facing, CARD_TONES.x + CARD_TONES.y * chance.z, light);
#endif
}
