// Trunks, limbs and branches. None is drawn narrower than a pixel: what is thinner covers as much less of that.
#include "systems/trees/tree.glsl"
#include "systems/trees/wood.py"

in vec4 stem;     // of the model: the stem's middle; its radius [m]
in vec3 side;     // which way the vertex lies from that, a unit vector: half of that, from 0.5
in vec4 own;      // around the stem and along it [m]; what sets its limb apart, and the frequency of that
in vec3 pivot;    // foot of its limb
in vec4 shading;  // what light meets on its way

#ifdef BAKED
uniform mat4 baked;
#endif

out vec2 on_skin;
out vec3 facing;
out vec3 seen_at;
out vec3 sunlit;
out vec3 skylit;
out vec3 hazy;
out float thick;  // coverage
out vec4 inside;

void main() {
    vec3 aside = 2.0 * side - 1.0;
    on_skin = own.xy;
    inside = shading;
#ifdef BAKED
    facing = aside;
    seen_at = stem.xyz + stem.w * aside;
    thick = 1.0;
    sunlit = skylit = hazy = vec3(0.0);
    gl_Position = baked * vec4(seen_at, 1.0);
#else
    facing = turned(aside);
    vec3 middle_at = swayed(stem.xyz, pivot, own.z, own.w, message);
    vec4 projected = clip * vec4(middle_at, 1.0);
    float pixel_at = THINNEST * max(projected.w, AWAY) / pixels_a_metre(), half_width = scale * stem.w;
    thick = min(half_width / pixel_at, 1.0);
    thick *= mix(1.0, smoothstep(THINS.x, THINS.y, thick), foliage) * (1.0 - smoothstep(GOES, 1.0, gone));
    seen_at = middle_at + max(half_width, pixel_at) * facing;
    Light light = light_in_crown(seen_at, shading, facing.y);
    sunlit = light.sun;
    skylit = light.sky;
    hazy = light.haze;
    gl_Position = clip * vec4(seen_at, 1.0);
#endif
}
