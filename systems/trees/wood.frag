#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/coverage.glsl"
#include "systems/trees/far.py"
#include "systems/trees/noise.py"

uniform sampler2DArray tree_cards;  // in place of twigs' cards: tileable noise

#define PASSED in
#include "systems/trees/wood.glsl"

#ifdef BAKED
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
out vec4 pixel;
#endif

const vec2 FURROWS = vec2(26.0, 3.0), BANDS = vec2(5.0, 26.0);  // number per metre around and along a stem
const float WINDINGS = 6.0;  // bends of furrows per metre
const vec2 CRACKS = vec2(70.0, 28.0);  // cracks across its ridges, of the same kind
const float DEEP = 0.7;  // share of furrows in the brightness of bark, beside cracks
const float FISSURE = 0.2;  // distance of the noise from its mean, 0.5, up to which bark falls off to the ground of a furrow
const vec2 RIDGES = vec2(0.544, 0.6);  // brightness of a furrow's ground, and what a ridge adds to it: on average, FURROWED_MEAN
const float RELIEF = 0.02;  // height of bark for each 1 of its brightness: its furrows are a centimetre deep, as a pine's [m]
const float LEAST_AREA = 1e-12;  // least area of a pixel on bark, as a divisor [m^2]
const vec2 BAND = vec2(0.58, 0.74);  // noise over which a band fades in
const vec3 BANDED = vec3(0.7, 0.5, 1.7);  // of that noise, the part all over, and the part in spots; spots per metre
const vec2 FOOT = vec2(0.1, 1.2);  // positions along a stem between which its foot ends, which has dark spots [m]
const vec2 SPOTS = vec2(9.0, 5.0);  // spots per metre around and along it
const vec2 SPOT = vec2(0.28, 0.5);  // noise over which a spot fades in
const float BAND_TONE = 0.42;  // brightness of bands and spots, relative to the bark's
const vec2 FINEST_BARK = vec2(1.5, 18.0);  // furrows show where a pixel is under 1/36 m of bark, and vanish over 1/12;
const float BROADER = 4.0;  // bands are larger, and show at pixels as many times as large
const float SHARPER = 1.7;  // contrast gain in pictures of trees, whose texels are interpolated
const float SOFTER = 1.2;  // widening of a band's fade by the size of a pixel [1/m]

const float SHARPER_BY = -1.5, BANDS_SHARPER = -2.5;  // bias of the noise's mip level: furrows and bands are its peaks, which a mean would lose

#ifdef SOFT
// Brightness of the bark, relative to its mean.
float bark_brightness() {
    return soil_tone(grass_height);
}
#else
float noise(vec2 at, float sharper) {
    return texture(tree_cards, vec3(at * (1.0 / NOISE_CELLS), 0.0), sharper).r;
}

float noise(vec2 at) {
    return noise(at, SHARPER_BY);
}

// Brightness of bark with dark bands across its stem, relative to its ground.
float banded_bark(vec2 on, float broad, float pixel) {
    float band = smoothstep(BAND.x - SOFTER * pixel, BAND.y + SOFTER * pixel, noise(on * BANDS, BANDS_SHARPER) * (BANDED.x + BANDED.y * broad));
    float foot = (1.0 - smoothstep(FOOT.x, FOOT.y, on.y)) * smoothstep(SPOT.x, SPOT.y, noise(on * SPOTS));
    return mix(1.0, BAND_TONE, max(band, foot));
}

// Brightness of bark with furrows along its stem, relative to its ground.
float furrowed_bark(vec2 on, float broad) {
    float off = noise(on * FURROWS + vec2(broad, 0.0)) - 0.5, cracks = noise(on * CRACKS);
    float furrows = min(abs(off) * (1.0 / FISSURE), 1.0);
    return mix(1.0, RIDGES.x + RIDGES.y * (DEEP * furrows + (1.0 - DEEP) * cracks), rough);
}

// Brightness of old bark, relative to its ground: furrows along it, or dark bands across it; and the broadest octave of its noise.
vec2 old_bark() {
    float pixel = max(fwidth(bark_at.x), fwidth(bark_at.y)), finest = FINEST_BARK.y / (rough < 0.0 ? BROADER : 1.0);
    float broad = noise(bark_at * (rough < 0.0 ? BANDED.z : WINDINGS));
    float old = rough < 0.0 ? banded_bark(bark_at, broad, pixel) : furrowed_bark(bark_at, broad);
    return vec2(mix(bark_mean(), old, clamp(FINEST_BARK.x - finest * pixel, 0.0, 1.0)), broad);
}

// Brightness of the bark, relative to its ground.
float bark_brightness() {
    vec2 old = old_bark();
    return soil_tone(grass_height + old.y - 0.5) * mix(1.0, old.x, age);
}
#endif

#if !defined(SOFT) && !defined(BAKED)
// Normal of bark at its furrows, for the relief `high` of its surface [m] (Mikkelsen, Bump mapping unparametrized surfaces on the
// GPU, 2010): the gradient of the relief along the surface tilts it.
vec3 furrowed_normal(vec3 smooth_normal, float high) {
    vec3 right = dFdx(seen_at), up = dFdy(seen_at), across = cross(up, smooth_normal), along = cross(smooth_normal, right);
    float area = dot(right, across);
    return smooth_normal - (dFdx(high) * across + dFdy(high) * along) / (sign(area) * max(abs(area), LEAST_AREA) + LEAST_AREA);
}
#endif

// Coverage of a stem with soft edges. The part of `facing` across the ray is the distance from its middle.
float edge_cover(vec3 ray) {
    float across = edge.y * length(facing - dot(facing, ray) * ray);
    return mix(1.0, clamp((1.0 - across) / max(fwidth(across), LEAST_WIDTH), 0.0, 1.0), edge.x);
}

void main() {
#ifdef BAKED
    float worn = mix(1.0, old_bark().x / bark_mean(), bark_age(age * THICKEST));
    pixel = vec4(0.5 + 0.5 * SHARPER * (worn - 1.0), 1.0, age, 1.0);
    second = packed_shading(inside);
#else
    float worn = bark_brightness();
    vec3 ray = normalize(seen_at - eye), out_to = facing - ray * (ribbon * sqrt(max(1.0 - dot(facing, facing), 0.0)));
#ifndef SOFT
    out_to = furrowed_normal(normalize(out_to), RELIEF * age * step(0.0, rough) * worn);
#endif
    float cover = stem_cover * edge_cover(ray);
    discard_uncovered(cover);
    float lit = max(dot(out_to, sun), 0.0) * inversesqrt(dot(out_to, out_to));
    vec2 seen = transmittance(vec2(grass_here.y, OPEN_SKY) * leaf_area_above(grass_height, vec2(0.0, grass_here.x)));
    pixel = output_colour(worn * worn * (sun_radiance * (lit * seen.x) + sky_radiance * seen.y) + haze_colour, cover);
#endif
}
