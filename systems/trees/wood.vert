// Trunks, limbs and branches. None is drawn narrower than a pixel: what is thinner covers as much less of that. Others are drawn a
// pixel broader than they are, over which their edges fade.
#include "systems/trees/tree.glsl"
#include "systems/trees/bark.py"
#include "systems/trees/behind.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/pigment.glsl"
#include "systems/trees/wood.py"

in uvec4 stem;    // of the model: the stem's middle; its radius; 0 to STEM_SCALE within their ranges
in vec4 side;     // which way the vertex lies from that, a unit vector, and how much farther out the corners of what has flat sides
                  // are than what it stands for; or which way a ribbon goes, and -1 or 1 on its edge
in vec4 own;      // around the stem and along it [m]; what sets its limb apart, and the frequency of that
in vec3 pivot;    // foot of its limb
in vec4 shading;  // what light meets on its way, by direction about 0.5 and in all, of the most

uniform vec4 stem_least;    // ranges, as bark.py has them
uniform vec4 stem_range;
uniform vec2 most_shading;
uniform float usual;     // as twig.glsl has them
uniform vec3 leaf_shape;

#ifdef BAKED
uniform mat4 baked;
#endif

out vec2 on_skin;
out vec3 facing;
out vec3 seen_at;
#ifdef BAKED
out vec4 inside;
#else
out vec3 from_sun;  // of the sun's light, what bark in the mean sends that faces it, and of the sky's; above the grass
out vec3 from_sky;
flat out vec3 hazy;
#endif
out float thick;  // coverage
flat out float rounds; // how much it is a ribbon, which looks as if it were round
out vec2 fading;  // how much its edges fade; how far out they are, of where they would end
out float aged;   // how old its bark is, 0 to 1; or how thick the stem is, of THICKEST
out float stands; // how high over the ground, of the grass there
flat out vec2 among_grass;  // that grass's leaf area; how many of its leaves the sun's light meets, of those that stand above

const float ON_EDGE = 0.5;  // beyond it, a vertex is on a ribbon's edge: bytes have no 0

// Which way a vertex lies from its stem's middle, which is there.
vec3 aside_of(vec3 middle_at) {
    vec4 told = 2.0 * side - 1.0;
    vec3 way = turned(told.xyz);
    rounds = step(ON_EDGE, abs(told.w));
    return rounds > 0.0 ? sign(told.w) * normalize(cross(way, eye - middle_at)) : way;
}

void main() {
    on_skin = own.xy;
    vec4 stem_at = stem_least + stem_range * (vec4(stem) / STEM_SCALE), meets = vec4(2.0 * shading.xyz - 1.0, shading.w) * most_shading.xxxy;
#ifdef BAKED
    inside = meets;
    facing = 2.0 * side.xyz - 1.0;
    rounds = 0.0;
    seen_at = stem_at.xyz + stem_at.w * facing;
    thick = stands = 1.0;
    aged = stem_at.w / THICKEST;
    fading = vec2(0.0, 1.0);
    among_grass = vec2(0.0);
    gl_Position = baked * vec4(seen_at, 1.0);
#else
    vec3 middle_at = swayed(stem_at.xyz, pivot, own.z, own.w, message);
    facing = aside_of(middle_at);
    vec4 projected = clip * vec4(middle_at, 1.0);
    float pixel_at = THINNEST * max(projected.w, AWAY) / pixels_a_metre(), half_width = scale * stem_at.w;
    thick = min(half_width / pixel_at, 1.0);
    aged = aged_at(half_width);
    thick *= mix(1.0, smoothstep(THINS.x, THINS.y, thick), foliage) * (1.0 - smoothstep(0.0, 1.0, gone));
    fading.x = smoothstep(FADES.x * pixel_at, FADES.y * pixel_at, half_width);
    float ends = max(half_width, pixel_at) + fading.x * pixel_at, corners = 1.0 + (1.0 - rounds) * fading.x * (2.0 * side.w - 1.0);
    fading.y = corners;
    seen_at = middle_at + ends * corners * facing;
    stands = (seen_at.y - root.y) / stands_in.x;
    among_grass = stands_in.yz;
    Light light = light_in_crown(seen_at, meets, facing.y);
    vec3 pigment = mix(young_bark, bark, aged);
#ifdef SOFT
    pigment *= mix(1.0, bark_mean(), aged);  // what is drawn in part are thin stems, and edges a pixel wide
#endif
    from_sun = SENDS * pigment * pigment * light.sun;
    from_sky = pigment * pigment * light.sky;
    hazy = light.haze;
    float leaf = scale * usual * leaf_shape.x * THINNEST / pixel_at;
    gl_Position = just_behind(stood_among_leaves(seen_at, foliage * (1.0 - aged), leaf, seen_at.y - root.y));
#endif
}
