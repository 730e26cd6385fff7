#include "lib/clouds.glsl"
#include "lib/light.glsl"

in vec3 ray;
in vec3 light;
out vec4 pixel;

const vec2 LIMB = vec2(0.00443, 0.00483);  // sines between which the sun's disc ends, which is 0.53 degrees wide half-way
const float DISC = 12.0;     // radiance of the disc, of a white leaf's in full sun: far above white
const vec2 AUREOLE = vec2(0.35, 900.0);  // radiance of the aureole about it, of the same, and how narrow it is
const float GREYS = 255.0;  // steps that a picture has from black to white
const vec3 GRIT = vec3(0.06711056, 0.00583715, 52.9829189);  // interleaved gradient noise (Jimenez, Next Generation Post Processing, 2014)

in vec4 clouding;
flat in vec3 shaded_from;

// How dense the map of clouds is at a place of it.
float dense_at(vec2 at) {
    return textureLod(repeating, at, clouding.z).r;
}

// Clouds in a direction: how much is seen past them, and what they send of the sun's light, and of light in full shade.
vec3 clouds_in(vec3 toward) {
    vec2 along = clouds_toward(toward), at = clouds_over(eye.xz) + along;
    vec2 sides = at + along * (CLOUD_SLICES.y * CLOUD_RISE), tops = at + along * CLOUD_RISE;
    vec3 dense = vec3(dense_at(at), dense_at(sides), dense_at(tops)), deep = dense - cloud_edge - CLOUD_STEP * CLOUD_SLICES;
    vec3 past = vec3(past_slice(deep.xy), past_slice(deep.yz).y), shows = vec3(1.0, past.x, past.x * past.y) * (clouding.y - clouding.y * past);
    float shades = shaded_from.z * (dense_at(sides + shaded_from.xy) - dense.y);
    vec3 sunny = clamp(CLOUD_LIT - CLOUD_DEEPER * deep + CLOUD_SIDES * (dense.y - dense.z - clouding.w) - CLOUD_SHADES * shades, 0.0, 1.0);
    float lit = dot(shows, CLOUD_SUNLIT * sunny * sunny + CLOUD_SILVER * clouding.x * past);
    float shaded = dot(shows, CLOUD_HIGHER) * (CLOUD_PALE - CLOUD_DARK * (dense.x + CLOUD_MOTTLED * shades));
    return vec3(1.0 - shows.x - shows.y - shows.z, lit, shaded);
}

// What the sun itself and the air about it send, of its light, by the cosine of the angle to it.
float glow(float cosine) {
    float aside = cosine > 0.0 ? 1.0 - cosine * cosine : 1.0, aureole = 1.0 / (1.0 + AUREOLE.y * aside);
    return DISC - DISC * smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside) + AUREOLE.x * aureole * aureole;
}

void main() {
    vec3 toward = ray * inversesqrt(dot(ray, ray)), seen = light;
    float sunny = toward.y > 0.0 ? glow(dot(toward, sun)) : 0.0;
    if (cloud_edge <= 1.0) {
        vec3 clouds = clouds_in(toward);
        seen = seen * clouds.x + cloudlight * clouds.z;
        // Low down, the sun is seen past them as in the mean.
        sunny = clouds.y + sunny * (clouds.x - (1.0 - clamp(cloud_edge, 0.0, 1.0)) * (1.0 - clouding.y));
    }
    seen += sunlight * sunny;
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(shown_of(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
