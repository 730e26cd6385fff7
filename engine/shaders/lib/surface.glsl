// One surface and one light for all that is drawn: blades, strips, carpet, ground, bodies, in the frame and the reference.
//
// Light comes in two steps, as most of it is the same all along a blade, a strip's column or a square of ground.
// 1. Per vertex, receiver or column: the light that reaches the place, before the canopy's own shade. Describe how the surface
//    reflects as a `Reflector` and call `light_at`, the one list of all lights; `leaf_light` does both for leaves. `light_sum` adds
//    lights of several kinds. Last, `hazed` adds the haze. `pack_light` and `unpack_light` carry a light between stages, as a mat4
//    with room for three more numbers. With PIXELS_ASK, lamps and shadow maps are left to the fragment shader.
// 2. Per fragment: fill a `Surface` and call `shade`, which returns radiance; `tone_mapped` of lib/tone.glsl is the last step.
// To add a light, write an `add_light` in `lamps_at`; to add a shadow, a factor in `sun_visibility` of lib/shadows.glsl; for what lies
// on surfaces (snow, water), change the `Surface` at the head of `shade`. All representations get it.
#include "lib/canopy.glsl"
#include "lib/haze.glsl"
#include "lib/lamps.glsl"
#include "lib/mown.glsl"
#include "lib/pigment.glsl"
#include "lib/shadows.glsl"

// The light on a surface, as the radiance that a white one would send to the eye, and the canopy that it passes.
struct Light {
    vec3 sun;          // from sun and lamps, above the canopy
    vec3 sky;          // from the whole sky, above the canopy
    vec3 haze;         // radiance of the haze before it
    float gloss;       // part of the sunlight that it mirrors
    float extinction;  // of light from sun and lamps: optical depth for each 1 of leaf area seen from the side
    vec2 leaves;       // leaf area index above the kind's top, and below it
};

const int FACE = -1;  // in place of a kind

// An index for tables of kinds, also for FACE: some compilers refuse a constant index below 0, even in code that is never reached.
int kind_index(int kind) {
    return max(kind, 0);
}

// What reflects light to the eye: bent leaves of a kind, or a FACE.
struct Reflector {
    int kind;
    vec2 bend;
    vec3 normal;  // the ground's, or the face's
    float gain;   // of a face: reflected light from straight above, relative to a white leaf that faces all ways
};

// How much it reflects, relative to a white leaf that faces all ways.
struct Reflectance {
    vec3 sun;
    vec3 sky;
    float gloss;  // part of the sunlight that it mirrors
};

// The material of a fragment, and its place in the canopy.
struct Surface {
    vec3 pigment;      // root of the albedo
    float height;      // in its kind's canopy: 1 at the top, 0 on the ground
    float scattering;  // sunlight that surfaces like it scatter to one another, for an albedo of 1
};

const float LEAF_SCATTERING = 0.7;

// A leaf at a height of its canopy.
Surface leaf_surface(vec3 pigment, float height) {
    return Surface(pigment, height, LEAF_SCATTERING);
}

const float SIDELONG = 0.75;  // reflection of sunlight that grazes the slope, relative to that from straight above
const float LIES_OPEN = 0.22;  // extra reflection of flat grass, which shows its faces to the sky
const float LEANS_AWAY = 0.18;  // and towards an eye that it leans away from
const vec2 SPINE = vec2(1.3, 0.7);  // mean direction of a spine: its lean, and its loss of height, for a posture index of 1

// Reflectance of leaves of a kind that are bent by `bend`, for light from a direction; `high` is the sine of its elevation over the
// slope.
Reflectance leaf_reflectance(int kind, vec2 bend, vec3 place, vec3 from, float high) {
    vec3 ray = normalize(place - eye);
    float facing = clamp(dot(ray, from), -1.0, 1.0);  // rounding goes beyond it, and roots are taken
    // Leaves that face all ways reflect where the eye sees them lit, and transmit where it sees them against the light.
    float lit = 0.5 - 0.5 * facing, against = 1.0 - lit;
    vec3 phase = lit * sqrt(lit) + against * sqrt(against) * kinds[kind].through;
    float flatness = min(dot(bend, bend), 1.0), face = 1.0 + LIES_OPEN * flatness + LEANS_AWAY * dot(bend, normalize(ray.xz + LEAST_LENGTH));
    // A blade mirrors light along itself like a thread (Kajiya and Kay, Rendering Fur, 1989).
    vec3 spine = normalize(vec3(SPINE.x * bend, 1.0 - SPINE.y * length(bend)).xzy), half_way = from - ray;
    float along = dot(spine, half_way), thread = 1.0 - along * along / max(dot(half_way, half_way), LEAST_SQUARE);
    thread *= thread;
    thread *= thread;
    return Reflectance(phase * (face * mix(SIDELONG, 1.0, high)), vec3(face), kinds[kind].gloss * thread * thread);
}

Reflectance reflectance_of(Reflector reflector, vec3 place, vec3 from, float high) {
    if (reflector.kind == FACE)
        return Reflectance(vec3(reflector.gain * high), vec3(1.0), 0.0);
    return leaf_reflectance(kind_index(reflector.kind), reflector.bend, place, from, high);
}

const float LIT_AT = 0.7;  // height of the leaves that reflect most of a lamp's light, as a part of the canopy's

// A light with the result of lamps_at added.
Light with_lamps(Light light, vec4 lamps) {
    float from_sun = brightness(light.sun), from_lamps = brightness(lamps.rgb);
    light.extinction = (from_sun * light.extinction + from_lamps * lamps.w) / max(from_sun + from_lamps, DARKEST);
    light.sun += lamps.rgb;
    return light;
}

// Add the reflected light of one lamp to the sum in rgb, and its extinction, weighted by brightness, to that in a.
void add_light(inout vec4 sum, Incoming light, vec3 place, Reflector reflector) {
    float high = max(dot(reflector.normal, light.direction), 0.0);
    vec3 reflected = light.radiance * reflectance_of(reflector, place, light.direction, high).sun;
    sum += vec4(reflected, brightness(reflected) * sun_extinction(kind_index(reflector.kind), high));
}

// Reflected light of all lamps at a place of the ground, and its mean extinction. This is the list of all lights but sun and sky:
// each is an `add_light`, and the block's `beside_sun` is 1 where any shines.
vec4 lamps_at(vec3 place, Reflector reflector) {
    vec4 sum = vec4(0.0);
    if (reflector.kind != FACE)
        place.y += LIT_AT * OF(crown, kind_index(reflector.kind)) * lodged(reflector.bend);
    ivec2 range = listed_range(lamps_grid, 0, place.xz);
    for (int index = range.x; index < range.y; index++)
        add_light(sum, lamp_at(index, place), place, reflector);
    return vec4(sum.rgb, sum.w / max(brightness(sum.rgb), DARKEST));
}

// The light at a place with that of lamps added; `suns` is the sun's part of the sum.
Light add_lamps(Light light, vec3 place, Reflector reflector, out float suns) {
    Light sum = with_lamps(light, lamps_at(place, reflector));
    suns = brightness(light.sun) / max(brightness(sum.sun), DARKEST);
    return sum;
}

// A light in shadow: `seen` is the visibility of the sun, `suns` the sun's part of the light from sun and lamps.
Light shadowed(Light light, float seen, float suns) {
    light.sun *= seen * suns + (1.0 - suns);
    light.gloss *= seen;
    return light;
}

// The light of sun, sky and lamps on a surface; `high` is the sine of the sun's elevation over the slope, `seen` the sun's visibility.
Light light_at(vec3 place, Reflector reflector, float high, float seen) {
    Reflectance response = reflectance_of(reflector, place, sun, high);
    vec3 from_sun = sunlight * response.sun * seen;
    vec3 from_sky = skylight * response.sky;
#if defined(TREES) && !defined(OF_TREES)
    from_sky *= sky_visibility(place);
#endif
    Light light = Light(from_sun, from_sky, vec3(0.0), response.gloss * seen, sun_extinction(kind_index(reflector.kind), high), vec2(0.0));
#ifdef PIXELS_ASK  // lamps on leaves are added by pixels
    if (reflector.kind != FACE)
        return light;
#endif
    if (any_lamps())
        light = with_lamps(light, lamps_at(place, reflector));
    return light;
}

// The light on leaves of a kind that are bent by `bend`; `seen` is the sun's visibility.
Light leaf_light(int kind, vec2 bend, vec3 place, Lie lies, ByKind densities, float seen) {
    Light light = light_at(place, Reflector(kind, bend, lies.normal, 1.0), lies.sun_sine, seen);
    light.leaves = leaf_area_split(densities, kind);
    return light;
}

Light leaf_light(int kind, vec2 bend, vec3 place, Lie lies, ByKind densities) {
    return leaf_light(kind, bend, place, lies, densities, sun_visibility(place, lies.visibility));
}

// The light on a kind where all is cut at `top` [m], so that leaves above shade nothing. `area` is each kind's leaf area.
Light light_when_cut(float top, Light light, int kind, ByKind area) {
    float high = top / max(OF(crown, kind), LOWEST_CROWN);
    light.leaves.x -= leaf_area_above(max(top, OF(crown, kind)), area) + leaf_area_above(high, vec2(0.0, light.leaves.y));
    return light;
}

// A light dimmed by the haze before a place, with the haze's own radiance.
Light hazed(Light light, vec3 place) {
    float hidden = haze_opacity(place), clear = 1.0 - hidden;
    light.sun *= clear;
    light.sky *= clear;
    light.gloss *= clear;
    light.haze = haze_radiance(place) * hidden;
    return light;
}

// A light plus `part` of another one.
Light light_sum(Light light, Light other, float part) {
    return Light(light.sun + part * other.sun, light.sky + part * other.sky, light.haze + part * other.haze,
                 light.gloss + part * other.gloss, light.extinction + part * other.extinction, light.leaves + part * other.leaves);
}

// A light packed for a varying, with three more numbers.
mat4 pack_light(Light light, vec3 more) {
    return mat4(vec4(light.sun, light.leaves.x), vec4(light.sky, light.leaves.y), vec4(light.haze, light.gloss), vec4(more, light.extinction));
}

Light unpack_light(mat4 light) {
    return Light(light[0].rgb, light[1].rgb, light[2].rgb, light[2].w, light[3].w, vec2(light[0].w, light[1].w));
}

vec3 packed_extra(mat4 light) {
    return light[3].xyz;
}

// The radiance of a surface in some light; something lets the part `passes` of sun and lamps through to it.
vec3 shade(Surface surface, Light light, float passes) {
    vec3 albedo = surface.pigment * surface.pigment;
    float area_above = max(leaf_area_above(surface.height, light.leaves), 0.0);  // below 0 for flat grass, which is lower than its cut
    vec2 left = transmittance(vec2(light.extinction, OPEN_SKY) * area_above);
    float direct = left.x * passes, scattered = surface.scattering * left.y * passes;
    vec3 received = light.sun * direct + light.sky * left.y + albedo * light.sun * scattered;
    return albedo * received + sunlight * (light.gloss * direct) + light.haze;
}

// The radiance of a surface in some light.
vec3 shade(Surface surface, Light light) {
    return shade(surface, light, 1.0);
}
