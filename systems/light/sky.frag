#include "lib/light.glsl"

in vec3 ray;
in vec3 light;
out vec4 pixel;

const vec2 LIMB = vec2(0.00443, 0.00483);  // sines between which the sun's disc ends, which is 0.53 degrees wide half-way
const float DISC = 12.0;     // radiance of the disc, of a white leaf's in full sun: far above white
const vec2 AUREOLE = vec2(0.35, 900.0);  // radiance of the aureole about it, of the same, and how narrow it is
const float GREYS = 255.0;  // steps that a picture has from black to white
const vec3 GRIT = vec3(0.06711056, 0.00583715, 52.9829189);  // interleaved gradient noise (Jimenez, Next Generation Post Processing, 2014)

#ifdef CLOUDS
const float CLOUDS_END = 0.02, CLOUDS_WHOLE = 0.3;  // sines of elevations at which clouds end in haze, and where they are whole
const float DENSER = 0.5;  // how much denser than its edge a cloud is that hides all
const float FINEST = 0.35;  // sine of the elevation below which the square of clouds is read more coarsely
const vec4 CLOUD = vec4(0.9, 0.75, -0.4, 0.5);  // what it sends of the sky's light; of the sun's; less of that where dense; more ahead of the sun
const float CLOUD_HIDES = 0.9;  // of the sky behind

// Clouds as they are seen from below: they take from the sky, and are bright about the sun.
vec3 clouded(vec3 light, vec3 toward) {
    float high = max(toward.y, CLOUDS_END);
    vec2 square = (eye.xz + toward.xz * (CLOUDS_AT / high)) / CLOUDS_SIDE - clouds_drift;
    // Far off the square repeats often and finely: its mean stands for it, and then haze.
    float level = max(log2(FINEST / high), 0.0), finer = floor(level);
    float dense = mix(textureLod(repeating, square, finer).r, textureLod(repeating, square, finer + 1.0).r, level - finer);
    dense = smoothstep(1.0 - cloud_cover, 1.0 + DENSER - cloud_cover, dense) * smoothstep(CLOUDS_END, CLOUDS_WHOLE, toward.y);
    float ahead = 0.5 + 0.5 * dot(toward, sun);
    vec3 lit = skylight * CLOUD.x + sunlight * (CLOUD.y + CLOUD.z * dense + CLOUD.w * ahead * ahead * ahead * (1.0 - dense));
    return mix(light, lit, CLOUD_HIDES * dense);
}
#endif

void main() {
    vec3 seen = light, off = cross(ray, sun);
    float aside = dot(ray, sun) > 0.0 ? dot(off, off) / dot(ray, ray) : 1.0;  // squared sine of the angle to the sun
#ifdef CLOUDS
    seen = clouded(seen, normalize(ray));
#endif
    float aureole = 1.0 / (1.0 + AUREOLE.y * aside), disc = 1.0 - smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside);
    if (ray.y > 0.0)
        seen += sunlight * (DISC * disc + AUREOLE.x * aureole * aureole);
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(shown_of(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
