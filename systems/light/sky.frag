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
#include "lib/clouds.glsl"

in vec3 clouding;

const float LOWEST_SEEN = 0.02;  // sine of the elevation below which no cloud comes out of the haze
const float SUNWARD = 70.0, BLUR = 3.0;  // how far toward the sun shade is looked for [m]; levels coarser
const float STEEPEST = 0.35;  // sine of the sun's elevation that counts at least for that
const vec3 SLICE = vec3(0.0, 1.0, 2.0);

// Clouds before the sky's light, and how much of the sun is seen past them: low down, that in the mean.
vec3 clouded(vec3 light, vec3 toward, out float past) {
    float level = clouding.z;
    vec2 along = toward.xz * (1.0 / (max(toward.y, LOWEST_SEEN) * CLOUDS_SIDE));
    vec2 at = eye.xz / CLOUDS_SIDE - clouds_drift + along * CLOUDS_AT, rise = along * CLOUD_RISE;
    vec2 sunward = at + sun.xz * (SUNWARD / (CLOUDS_SIDE * max(sun.y, STEEPEST)));
    vec3 dense = vec3(textureLod(repeating, at, level).r, textureLod(repeating, at + rise, level).r,
        textureLod(repeating, at + 2.0 * rise, level).r);
    vec3 edge = cloud_edge + CLOUD_STEP * SLICE, thin = clamp(1.0 + (edge - dense) / CLOUD_HIDES, 0.0, 1.0);
    vec3 sunny = clamp(1.0 + (edge - textureLod(repeating, sunward, level + BLUR).r) / CLOUD_SHADES, 0.0, 1.0);
    vec3 through = thin * thin, shows;
    sunny *= sunny;
    through *= through;
    float lower = through.x * through.y, left = lower * through.z;
    shows = vec3(1.0, through.x, lower) * (1.0 - through);
    vec3 lit = CLOUD_SUNLIT * sunny * sunny * (0.5 + 0.5 * thin) + CLOUD_SILVER * clouding.x * through;
    vec3 clouds = sunlight * dot(shows, lit) + cloudlight * dot(shows, 1.0 + CLOUD_HIGHER * SLICE);
    past = mix(clamp(cloud_edge, 0.0, 1.0), left, clouding.y);
    return light * mix(1.0, left, clouding.y) + clouds * clouding.y;
}
#endif

void main() {
    float past = 1.0;
    vec3 seen = light, off = cross(ray, sun);
    float aside = dot(ray, sun) > 0.0 ? dot(off, off) / dot(ray, ray) : 1.0;  // squared sine of the angle to the sun
#ifdef CLOUDS
    seen = clouded(seen, normalize(ray), past);
#endif
    float aureole = 1.0 / (1.0 + AUREOLE.y * aside), disc = 1.0 - smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside);
    if (ray.y > 0.0)
        seen += past * sunlight * (DISC * disc + AUREOLE.x * aureole * aureole);
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(shown_of(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
