// Trunks, limbs and branches. A stem thinner than a pixel is drawn as wide as one, with less coverage; wider ones get a soft edge of
// a pixel.
#include "systems/trees/tree.glsl"
#include "systems/trees/bark.py"
#include "systems/trees/behind.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/pigment.glsl"
#include "systems/trees/twig.py"
#include "systems/trees/wood.py"

in uvec4 stem;   // middle of the model's stem; its radius; 0 to STEM_SCALE within their ranges
in vec4 side;    // direction of the vertex from the middle, a unit vector, and outset of a flat-sided tube's corners; or a ribbon's tangent, and
                 // -1 or 1 on its edge
in vec4 shading; // optical depth, linear in direction about 0.5 and in the mean, relative to the greatest
in vec2 surface; // position around the stem and along it [m]
in uvec2 on_limb; // row of its limb, among the twigs, 0 on the trunk; random number of that, 0 to STEM_SCALE: it lies in another texel

#ifdef BAKED
uniform mat4 baked;
#endif

#define PASSED out
#include "systems/trees/wood.glsl"

const float ON_EDGE = 0.5;  // beyond it, a vertex is on a ribbon's edge: bytes have no 0

// Direction of a vertex from its stem's middle.
vec3 outward(vec3 middle_at) {
    vec4 direction = 2.0 * side - 1.0;
    vec3 way = to_world(direction.xyz);
    ribbon = step(ON_EDGE, abs(direction.w));
    return ribbon > 0.0 ? sign(direction.w) * normalize(cross(way, eye - middle_at)) : way;
}

void main() {
    bark_at = surface;
    vec4 stem_at = stem_least + stem_range * (vec4(stem) / STEM_SCALE), depths = vec4(2.0 * shading.xyz - 1.0, shading.w) * most_shading.xxxy;
#ifdef BAKED
    inside = depths;
    facing = 2.0 * side.xyz - 1.0;
    ribbon = 0.0;
    seen_at = stem_at.xyz + stem_at.w * facing;
    stem_cover = grass_height = 1.0;
    age = stem_at.w / THICKEST;
    edge = vec2(0.0, 1.0);
    grass_here = vec2(0.0);
    gl_Position = baked * vec4(seen_at, 1.0);
#else
    Twig limb = twig_of(int(on_limb.x));
    vec3 middle_at = swayed(stem_at.xyz, on_limb.x > 0u ? limb.pivot : stem_at.xyz, float(on_limb.y) / STEM_SCALE, limb.hertz, message);
    facing = outward(middle_at);
    vec4 projected = clip * vec4(middle_at, 1.0);
    float pixel_width = THINNEST * max(projected.w, AWAY) / pixels_per_metre(), half_width = scale * stem_at.w;
    stem_cover = min(half_width / pixel_width, 1.0);
    age = bark_age(half_width);
    stem_cover *= mix(1.0, smoothstep(THINS.x, THINS.y, stem_cover), foliage) * (1.0 - smoothstep(0.0, 1.0, far_fade));
    edge.x = smoothstep(FADES.x * pixel_width, FADES.y * pixel_width, half_width);
    float ends = max(half_width, pixel_width) + edge.x * pixel_width, corners = 1.0 + (1.0 - ribbon) * edge.x * (2.0 * side.w - 1.0);
    edge.y = corners;
    seen_at = middle_at + ends * corners * facing;
    grass_height = (seen_at.y - root.y) / grass_about.x;
    grass_here = grass_about.yz;
    Light light = light_in_crown(seen_at, depths, facing.y);
    vec3 pigment = mix(young_bark, bark, age);
#ifdef SOFT
    pigment *= mix(1.0, bark_mean(), age);  // the soft pass draws thin stems, and edges a pixel wide
#endif
    sun_radiance = FACE_GAIN * pigment * pigment * light.sun;
    sky_radiance = pigment * pigment * light.sky;
    haze_colour = light.haze;
    float leaf = scale * leaf_length * THINNEST / pixel_width;
    gl_Position = just_behind(clip_position_among_leaves(seen_at, foliage * (1.0 - age), leaf, seen_at.y - root.y));
#endif
}
