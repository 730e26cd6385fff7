// Trunks, limbs and branches. None is drawn narrower than a pixel: what is thinner covers as much less of that.
#include "systems/trees/tree.glsl"
#include "systems/trees/wood.py"

in vec4 stem;     // of the model: the stem's middle; its radius [m]
in vec4 side;     // which way the vertex lies from that, a unit vector; or which way a ribbon goes, and -1 or 1 on its edge
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
out float rounds; // how much it is a ribbon, which looks as if it were round

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
    inside = shading;
#ifdef BAKED
    facing = 2.0 * side.xyz - 1.0;
    rounds = 0.0;
    seen_at = stem.xyz + stem.w * facing;
    thick = 1.0;
    sunlit = skylit = hazy = vec3(0.0);
    gl_Position = baked * vec4(seen_at, 1.0);
#else
    vec3 middle_at = swayed(stem.xyz, pivot, own.z, own.w, message);
    facing = aside_of(middle_at);
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
