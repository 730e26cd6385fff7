// One surface and one light for all that is drawn: blades, strips, carpet, ground, bodies, in the frame and the reference.
//
// Light comes in two steps, as most of it is the same all along a blade, a strip's column or a square of ground.
// 1. Once a vertex, receiver or column: what light reaches the place, past all but the canopy. Say how the surface sends light
//    to the eye, as a `Sender`, and give it to `light_at`, the one list of all lights; `light_on` does both for leaves. Lights
//    may be summed over kinds with `plus`. Last, `veiled` puts the haze before it.
//    `bundled` and `unbundled` bring a light through stages, as a mat4 with three numbers of one's own beside it.
//    Where it is asked for coarsely, a shader that defines PIXELS_ASK leaves lamps and shadow maps to whoever asks more finely.
// 2. Once a fragment: fill a `Surface` and ask `shade`, which gives radiance; `shown_of` of lib/tone.glsl is the last step.
// A new light is an `add_light` in `lamps_at`, a new shadow one of `sun_seen` (lib/shadows.glsl), what lies on surfaces (snow, water)
// a change of the `Surface` at the head of `shade`: all representations get it.
#include "lib/canopy.glsl"
#include "lib/haze.glsl"
#include "lib/lamps.glsl"
#include "lib/mown.glsl"
#include "lib/pigment.glsl"
#include "lib/shadows.glsl"

// The light that reaches a surface through the canopy, as radiance towards the eye of a white one.
struct Light {
    vec3 sun;     // in full sun; that of lamps counts with it
    vec3 sky;     // under the whole sky
    vec3 haze;    // what is seen before it, as it is
    float gloss;  // mirrored of the sun, where it is seen
    float way;    // how many leaves the sun's light meets, of those that stand above, seen from the side; the mean with lamps'
    vec2 leaves;  // that stand above the kind's top, and between that and the ground, of the ground's area
};

const int FACE = -1;  // in place of a kind

// A kind that a table may be asked for, also where it is FACE: some compilers refuse an index below 0, even where nothing goes.
int listed_kind(int kind) {
    return max(kind, 0);
}

// What sends light to the eye: leaves of a kind that the wind bends so, or a FACE.
struct Sender {
    int kind;
    vec2 bend;
    vec3 normal;  // the ground's, or the face's
    float sends;  // what a face sends of light from straight above, of what a white leaf that faces all ways does
};

// How much it does, of what a white leaf that faces all ways does.
struct Response {
    vec3 sun;
    vec3 sky;
    float gloss;  // mirrored of the sun
};

// What a fragment is to light.
struct Surface {
    vec3 pigment;  // root of the albedo
    float height;  // in its kind's canopy: 1 at the top, 0 on the ground
    float among;   // what surfaces like it send to one another of the sun's light, of one with albedo 1
};

const float AMONG_LEAVES = 0.7;

// A leaf of a kind, at a height of its canopy.
Surface leaf_at(vec3 pigment, float height) {
    return Surface(pigment, height, AMONG_LEAVES);
}

const float SIDELONG = 0.75;  // what leaves send of sunlight that grazes the slope, of what they send of it from straight above
const float LIES_OPEN = 0.22;  // how much more light grass sends that lies, which shows its faces to the sky
const float LEANS_AWAY = 0.18;  // and how much more to an eye that it leans away from
const vec2 SPINE = vec2(1.3, 0.7);  // a spine's mean slope leans by so much, and rises by so much less, of the posture index

// How leaves of a kind at a place send light to the eye that the wind bends by `bend`; it comes from a direction whose elevation
// has the sine `high`.
Response leaf_response(int kind, vec2 bend, vec3 place, vec3 from, float high) {
    vec3 ray = normalize(place - eye);
    float facing = clamp(dot(ray, from), -1.0, 1.0);  // rounding goes beyond it, and roots are taken
    // Leaves that face all ways send back what the eye sees lit, and let through what it sees against the light.
    float back = 0.5 - 0.5 * facing, against = 1.0 - back;
    vec3 phase = back * sqrt(back) + against * sqrt(against) * kinds[kind].through;
    float lies = min(dot(bend, bend), 1.0), face = 1.0 + LIES_OPEN * lies + LEANS_AWAY * dot(bend, normalize(ray.xz + LEAST_LENGTH));
    // A blade mirrors light along itself like a thread (Kajiya and Kay, Rendering Fur, 1989).
    vec3 spine = normalize(vec3(SPINE.x * bend, 1.0 - SPINE.y * length(bend)).xzy), half_way = from - ray;
    float along = dot(spine, half_way), thread = 1.0 - along * along / max(dot(half_way, half_way), LEAST_SQUARE);
    thread *= thread;
    thread *= thread;
    return Response(phase * (face * mix(SIDELONG, 1.0, high)), vec3(face), kinds[kind].gloss * thread * thread);
}

Response response_of(Sender sender, vec3 place, vec3 from, float high) {
    if (sender.kind == FACE)
        return Response(vec3(sender.sends * high), vec3(1.0), 0.0);
    return leaf_response(listed_kind(sender.kind), sender.bend, place, from, high);
}

const float LIT_AT = 0.7;  // where leaves are that send most of a lamp's light to the eye, of the canopy's height

// A light with that of lamps, of lamps_at.
Light with_lamps(Light light, vec4 sent) {
    float own = brightness(light.sun), more = brightness(sent.rgb);
    light.way = (own * light.way + more * sent.w) / max(own + more, DARKEST);
    light.sun += sent.rgb;
    return light;
}

// Add what a light sends to the eye by way of a surface, and how many leaves it meets, for as bright as that is.
void add_light(inout vec4 sent, Shine light, vec3 place, Sender sender) {
    float high = max(dot(sender.normal, light.from), 0.0);
    vec3 more = light.light * response_of(sender, place, light.from, high).sun;
    sent += vec4(more, brightness(more) * sun_way(listed_kind(sender.kind), high));
}

// What lamps send of their light at a place of the ground, and how many leaves that meets in the mean. This is the list of all
// lights beside sun and sky: each is an `add_light`, and the block's `beside_sun` is 1 where it shines.
vec4 lamps_at(vec3 place, Sender sender) {
    vec4 sent = vec4(0.0);
    if (sender.kind != FACE)
        place.y += LIT_AT * OF(crown, listed_kind(sender.kind)) * lodged(sender.bend);
    ivec2 listed = lamps_about(place.xz);
    for (int number = listed.x; number < listed.y; number++)
        add_light(sent, lamp_at(number, place), place, sender);
    return vec4(sent.rgb, sent.w / max(brightness(sent.rgb), DARKEST));
}

// The light at a place with that of lamps; `suns` is the sun's part of it.
Light add_lamps(Light light, vec3 place, Sender sender, out float suns) {
    Light sum = with_lamps(light, lamps_at(place, sender));
    suns = brightness(light.sun) / max(brightness(sum.sun), DARKEST);
    return sum;
}

// A light where so much of the sun is seen past what casts shadows; `suns` is the sun's part of it, beside that of lamps.
Light shaded(Light light, float seen, float suns) {
    light.sun *= seen * suns + (1.0 - suns);
    light.gloss *= seen;
    return light;
}

// The light at a place that a surface sends to the eye, where the sun's elevation has the sine `high` and so much of it is
// seen: that of sun and sky, and of what `lamps_at` lists.
Light light_at(vec3 place, Sender sender, float high, float seen) {
    Response response = response_of(sender, place, sun, high);
    vec3 from_sun = sunlight * response.sun * seen;
    vec3 from_sky = skylight * response.sky;
#if defined(TREES) && !defined(OF_TREES)
    from_sky *= sky_past_trees(place);
#endif
    Light light = Light(from_sun, from_sky, vec3(0.0), response.gloss * seen, sun_way(listed_kind(sender.kind), high), vec2(0.0));
#ifdef PIXELS_ASK  // of leaves, whoever asks for light adds them
    if (sender.kind != FACE)
        return light;
#endif
    if (any_lamps())
        light = with_lamps(light, lamps_at(place, sender));
    return light;
}

// The light on leaves of a kind at a place: the wind bends them by `bend`, the terrain lies so, and so much of the sun is seen.
Light light_on(int kind, vec2 bend, vec3 place, Lie lies, ByKind grows, float seen) {
    Light light = light_at(place, Sender(kind, bend, lies.normal, 1.0), lies.high, seen);
    light.leaves = leaves_over(grows, kind);
    return light;
}

Light light_on(int kind, vec2 bend, vec3 place, Lie lies, ByKind grows) {
    return light_on(kind, bend, place, lies, grows, sun_seen(place, lies.past));
}

// The light on a kind where nothing stands above `top` [m]: leaves over that shade nothing. `area` is that of leaves, by kind.
Light mown_to(float top, Light light, int kind, ByKind area) {
    float high = top / max(OF(crown, kind), LOWEST_CROWN);
    light.leaves.x -= leaves_above(max(top, OF(crown, kind)), area) + leaves_above(high, vec2(0.0, light.leaves.y));
    return light;
}

// A light with the haze before a place.
Light veiled(Light light, vec3 place) {
    float hidden = haze_at(place), clear = 1.0 - hidden;
    light.sun *= clear;
    light.sky *= clear;
    light.gloss *= clear;
    light.haze = haze_light(place) * hidden;
    return light;
}

// Of two lights the sum, of the second as much as `part`.
Light plus(Light light, Light other, float part) {
    return Light(light.sun + part * other.sun, light.sky + part * other.sky, light.haze + part * other.haze,
                 light.gloss + part * other.gloss, light.way + part * other.way, light.leaves + part * other.leaves);
}

// A light as it goes from stage to stage, with three numbers beside it.
mat4 bundled(Light light, vec3 more) {
    return mat4(vec4(light.sun, light.leaves.x), vec4(light.sky, light.leaves.y), vec4(light.haze, light.gloss), vec4(more, light.way));
}

Light unbundled(mat4 light) {
    return Light(light[0].rgb, light[1].rgb, light[2].rgb, light[2].w, light[3].w, vec2(light[0].w, light[1].w));
}

vec3 told_beside(mat4 light) {
    return light[3].xyz;
}

// The radiance that a surface sends to the eye in some light.
vec3 shade(Surface surface, Light light) {
    vec3 albedo = surface.pigment * surface.pigment;
    float over = max(leaves_above(surface.height, light.leaves), 0.0);  // grass that lies flat stands lower than its cut
    vec2 seen = comes_through(vec2(light.way, OPEN_SKY) * over);
    vec3 received = light.sun * seen.x + light.sky * seen.y + albedo * light.sun * (surface.among * seen.y);
    return albedo * received + sunlight * (light.gloss * seen.x) + light.haze;
}
