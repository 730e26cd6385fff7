#include "lib/light.glsl"
#include "lib/random.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"

in vec2 on_skin;
in vec3 facing;
in vec3 seen_at;
in vec3 sunlit;
in vec3 skylit;
in vec3 hazy;
in float thick;
in vec4 inside;

#ifdef BAKED
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
out vec4 pixel;
#endif

const vec2 SHADING = vec2(3.0, 6.0);  // as of twigs
const float BARK_SENDS = 1.25;  // what a white face sends of the sun's light from straight ahead, of what a leaf does
const vec2 FURROWS = vec2(26.0, 4.0), BANDS = vec2(5.0, 26.0);  // how many there are on a metre around and along a stem

float noise(vec2 at) {
    vec2 low = floor(at), part = at - low;
    part *= part * (3.0 - 2.0 * part);
    ivec2 cell = ivec2(low);
    float a = unit(hash3(7, cell.x, cell.y)), b = unit(hash3(7, cell.x + 1, cell.y));
    float c = unit(hash3(7, cell.x, cell.y + 1)), d = unit(hash3(7, cell.x + 1, cell.y + 1));
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}

// The bark's pigment there, of its own: furrows along the stem, or dark bands across it.
float bark_at(vec2 on, float fades) {
    if (rough < 0.0) {
        float band = smoothstep(0.62, 0.8, noise(on * BANDS) * (0.7 + 0.5 * noise(on * 1.7)));
        float foot = (1.0 - smoothstep(0.1, 1.2, on.y)) * smoothstep(0.3, 0.65, noise(on * vec2(9.0, 5.0)));
        return mix(1.0, 0.42, fades * max(band, foot));
    }
    float deep = noise(on * FURROWS + 2.0 * noise(on * 6.0)), fine = noise(on * FURROWS * 3.1);
    return mix(1.0, 0.55 + 0.75 * (0.7 * deep + 0.3 * fine), fades * rough);
}

void main() {
#ifdef BAKED
    pixel = vec4(0.5, 1.0, 0.0, 1.0);
    second = clamp(vec4(0.5 + 0.5 * inside.xyz / SHADING.x, inside.w / SHADING.y), 0.0, 1.0);
#else
    float fades = clamp(1.5 - 18.0 * max(fwidth(on_skin.x), fwidth(on_skin.y)), 0.0, 1.0);
    must_cover(thick);
    vec3 normal = normalize(facing), ray = normalize(seen_at - eye);
    Light light = Light(sunlit * (BARK_SENDS * max(dot(normal, sun), 0.0)), skylit, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(bark * bark_at(on_skin, fades), 1.0, 0.0), light), thick);
#endif
}
