#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/noise.py"

uniform sampler2DArray tree_cards;  // in place of twigs' cards: noise that repeats

in vec2 on_skin;
in vec3 facing;
in vec3 seen_at;
#ifdef BAKED
in vec4 inside;
#else
in vec3 from_sun;
in vec3 from_sky;
flat in vec3 hazy;
#endif
in float thick;
flat in float rounds;
in vec2 fading;
in float aged;
in float stands;
flat in vec2 among_grass;

#ifdef BAKED
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
out vec4 pixel;
#endif

const vec2 FURROWS = vec2(26.0, 4.0), BANDS = vec2(5.0, 26.0);  // how many there are on a metre around and along a stem
const float WINDINGS = 6.0;  // how many bends furrows have on a metre
const float FINER = 3.1;  // how many more cracks than furrows there are
const float DEEP = 0.7;  // part of furrows in how bright bark is, beside cracks
const vec2 RIDGES = vec2(0.55, 0.75);  // how bright the ground of a furrow is, of the bark, and how much brighter a ridge
const vec2 BAND = vec2(0.58, 0.74);  // noise between which a band begins: it is where there is more
const vec3 BANDED = vec3(0.7, 0.5, 1.7);  // of that noise, its part all over, and its part in spots; how many of these on a metre
const vec2 FOOT = vec2(0.1, 1.2);  // between which ways along a stem its foot ends, which is dark in spots [m]
const vec2 SPOTS = vec2(9.0, 5.0);  // how many of these there are on a metre around and along it
const vec2 SPOT = vec2(0.28, 0.5);  // noise between which a spot begins
const float BAND_TONE = 0.42;  // how bright bands and spots are, of the bark
const vec2 SOILED = vec2(0.3, 2.8);  // heights between which soil and moss on bark end, of the grass's, and with noise of it
const float SOIL_TONE = 0.62;  // how bright bark is below them, of what it is
const vec2 FINEST_BARK = vec2(1.5, 18.0);  // all this is seen where a pixel is under 1/36 m of bark, and none of it over 1/12

const float SHARPER_BY = -1.5;  // level of noise: bands and furrows are where it is highest, and a mean would have none

// How much of bark is left of soil and moss where it stands so high.
float soiled_at(float height) {
    return mix(SOIL_TONE, 1.0, smoothstep(SOILED.x, SOILED.y, height));
}

#ifdef SOFT
// How bright the bark is there, of its mean.
float bark_there() {
    return soiled_at(stands);
}
#else
float noise(vec2 at) {
    return texture(tree_cards, vec3(at * (1.0 / NOISE_CELLS), 0.0), SHARPER_BY).r;
}

// How bright bark is with dark bands across its stem, of its ground.
float banded_at(vec2 on, float broad) {
    float band = smoothstep(BAND.x, BAND.y, noise(on * BANDS) * (BANDED.x + BANDED.y * broad));
    float foot = (1.0 - smoothstep(FOOT.x, FOOT.y, on.y)) * smoothstep(SPOT.x, SPOT.y, noise(on * SPOTS));
    return mix(1.0, BAND_TONE, max(band, foot));
}

// And with furrows along it.
float furrowed_at(vec2 on, float broad) {
    float furrows = noise(on * FURROWS + 2.0 * broad), cracks = noise(on * (FURROWS * FINER));
    return mix(1.0, RIDGES.x + RIDGES.y * (DEEP * furrows + (1.0 - DEEP) * cracks), rough);
}

// How bright the bark is there, of its ground: furrows along an old stem, or dark bands across it.
float bark_there() {
    float fades = clamp(FINEST_BARK.x - FINEST_BARK.y * max(fwidth(on_skin.x), fwidth(on_skin.y)), 0.0, 1.0);
    float broad = noise(on_skin * (rough < 0.0 ? BANDED.z : WINDINGS));
    float old = rough < 0.0 ? banded_at(on_skin, broad) : furrowed_at(on_skin, broad);
    return soiled_at(stands + broad - 0.5) * mix(1.0, mix(bark_mean(), old, fades), aged);
}
#endif

// How much of a pixel a stem covers that fades out towards its edges: they are as far aside as it is thick.
float edge_cover(vec3 ray) {
    float across = fading.y * length(facing - dot(facing, ray) * ray);
    return mix(1.0, clamp((1.0 - across) / max(fwidth(across), LEAST_WIDTH), 0.0, 1.0), fading.x);
}

void main() {
#ifdef BAKED
    pixel = vec4(0.5, 1.0, aged, 1.0);
    second = packed_shading(inside);
#else
    float worn = bark_there();
    vec3 ray = normalize(seen_at - eye);
    float cover = thick * edge_cover(ray);
    must_cover(cover);
    vec3 out_to = facing - ray * (rounds * sqrt(max(1.0 - dot(facing, facing), 0.0)));
    float lit = max(dot(out_to, sun), 0.0) * inversesqrt(dot(out_to, out_to));
    vec2 seen = comes_through(vec2(among_grass.y, OPEN_SKY) * leaves_above(stands, vec2(0.0, among_grass.x)));
    pixel = drawn(worn * worn * (from_sun * (lit * seen.x) + from_sky * seen.y) + hazy, cover);
#endif
}
