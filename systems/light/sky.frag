#include "lib/light.glsl"

in vec3 ray;
in vec3 light;
out vec4 pixel;

const float LIMB = 0.00483;  // sine of the outer edge of the sun's disc, which is 0.53 degrees wide half-way up its limb
const float DISC = 12.0;     // radiance of the disc, of a white leaf's in full sun: far above white
const float WIDE = 900.0;    // how narrow the aureole is about it

#ifdef CLOUDS
// Clouds as they are seen from below: they take from the sky, and are bright about the sun.
vec3 clouded(vec3 light, vec3 toward) {
    vec2 at = eye.xz + toward.xz * (CLOUDS_AT / max(toward.y, 0.02));
    vec2 square = at / CLOUDS_SIDE - clouds_drift;
    // Far off the square repeats often and finely: its mean stands for it, and then haze.
    float level = max(log2(0.35 / max(toward.y, 0.02)), 0.0), finer = floor(level);
    float dense = mix(textureLod(repeating, square, finer).r, textureLod(repeating, square, finer + 1.0).r, level - finer);
    dense = smoothstep(1.0 - cloud_cover, 1.5 - cloud_cover, dense) * smoothstep(0.02, 0.3, toward.y);
    float ahead = 0.5 + 0.5 * dot(toward, sun);
    vec3 lit = skylight * 0.9 + sunlight * (0.75 - 0.4 * dense + 0.5 * ahead * ahead * ahead * (1.0 - dense));
    return mix(light, lit, 0.9 * dense);
}
#endif

void main() {
    vec3 seen = light, off = cross(ray, sun);
    float aside = dot(ray, sun) > 0.0 ? dot(off, off) / dot(ray, ray) : 1.0;  // squared sine of the angle to the sun
#ifdef CLOUDS
    seen = clouded(seen, normalize(ray));
#endif
    float aureole = 1.0 / (1.0 + WIDE * aside), disc = smoothstep(LIMB * LIMB, (LIMB - 0.0004) * (LIMB - 0.0004), aside);
    if (ray.y > 0.0)
        seen += sunlight * (DISC * disc + 0.35 * aureole * aureole);
    vec3 shown = shown_of(seen);
    float grit = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    pixel = vec4(shown + (writes_raw > 0.5 ? 0.0 : grit / 255.0), 1.0);
}
