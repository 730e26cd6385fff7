// Trunks, limbs and branches. A stem thinner than a pixel is drawn as wide as one, with less coverage; wider ones get a soft edge of
// a pixel.
#include "systems/trees/tree.glsl"
#include "systems/trees/bark.py"
#include "systems/trees/behind.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/pigment.glsl"
#include "systems/trees/wood.py"

in uvec4 stem;    // middle of the model's stem; its radius; 0 to STEM_SCALE within their ranges
in vec4 side;     // direction of the vertex from the middle, a unit vector, and outset of a flat-sided tube's corners; or a ribbon's tangent, and
                  // -1 or 1 on its edge
in vec4 own;      // position around the stem and along it [m]; random number and frequency of its limb
in vec3 pivot;    // foot of its limb
in vec4 shading;  // optical depth, linear in direction about 0.5 and in the mean, of the greatest

uniform vec4 stem_least;    // ranges, as in bark.py
uniform vec4 stem_range;
uniform vec2 most_shading;
uniform float usual;     // as in twig.glsl
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
out vec3 from_sun;  // radiance of mean bark that faces the sun, and of the sky's light; above the grass
out vec3 from_sky;
flat out vec3 hazy;
#endif
out float thick;  // coverage
flat out float rounds; // 1 on a ribbon, which is shaded as if round
out vec2 fading;  // softness of its edges; position of the vertex, of the stem's edge
out float aged;   // age of its bark, 0 to 1; or radius of the stem, of THICKEST
out float stands; // height over the ground, of the grass's
flat out vec2 among_grass;  // leaf area of that grass; optical depth of sunlight in it, of that straight down

const float ON_EDGE = 0.5;  // beyond it, a vertex is on a ribbon's edge: bytes have no 0

// Direction of a vertex from its stem's middle.
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
    float pixel_at = THINNEST * max(projected.w, AWAY) / pixels_per_metre(), half_width = scale * stem_at.w;
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
    pigment *= mix(1.0, bark_mean(), aged);  // the soft pass draws thin stems, and edges a pixel wide
#endif
    from_sun = SENDS * pigment * pigment * light.sun;
    from_sky = pigment * pigment * light.sky;
    hazy = light.haze;
    float leaf = scale * usual * leaf_shape.x * THINNEST / pixel_at;
    gl_Position = just_behind(stood_among_leaves(seen_at, foliage * (1.0 - aged), leaf, seen_at.y - root.y));
#endif
}
