// A tree: its instance, its motion in the wind, and the light in its crown.
#define OF_TREES
#include "lib/light.glsl"
#include "systems/trees/crown.glsl"
#include "systems/trees/motion.py"
#include "systems/trees/parameter.py"

in vec3 root;        // place [m]
in float scale;      // size, relative to its model's
in vec2 turn;        // cosine and sine of its yaw
in float phase;      // random number, 0 to 1
in float tint;       // brightness, relative to its kind's
in float twig_share; // share of its twigs that are drawn, each larger so that together they hide as much
in float far_fade;   // fade from these to its picture far off, 0 to 1
in float foliage;    // share of its leaves
#ifdef STANDS
// Outputs of stand.vert.
in vec4 wind_response;    // message of the wind; displacement of the trunk's top, relative to its height
in vec4 haze_in_front;    // radiance of the haze in front, and its opacity
in vec4 grass_about;      // of the grass about its foot: height [m], leaf area, extinction of sunlight; and part of the sun seen past all but
                          // trees
in vec3 light_from_grass; // light reflected by the grass, as radiance of a white face that looks down
vec2 message = wind_response.xy, trunk_sway = wind_response.zw;
#else
const vec2 message = vec2(0.0);
const vec4 haze_in_front = vec4(0.0);
const vec4 grass_about = vec4(1.0, 0.0, 0.0, 0.0);
const vec2 trunk_sway = vec2(0.0);
const vec3 light_from_grass = vec3(0.0);
#endif

uniform float moment;  // time, within PERIOD [s]

const vec3 LIMB_ASIDE = vec3(LIMB_SIDEWAYS, LIMB_ACROSS, 1.7);  // of a limb across the wind: amplitude and frequency, relative to those along it; factor of its
                                                      // phase
const float OVER_TOP = 1.2;  // height up to which a tree bends, relative to its model's: twigs and pictures go beyond that
const float LOWEST_ARC = 0.5;  // twice the least height, for the drop of what is bent aside [m]

// Swing of a lightly damped stem in gusty air, -1 to 1: a narrow band about its own frequency (Crandall and Mark, Random Vibration in
// Mechanical Systems, 1963), here of two tones that beat. Frequencies are multiples of 1 / PERIOD, so that it repeats.
float swing(float hertz, float random) {
    vec2 tones = floor(hertz * TONES * PERIOD + 0.5) / PERIOD;
    vec2 waves = sin(AROUND * (fract(tones * moment) + random * TONES_APART));
    return 0.5 * (waves.x + waves.y);
}

vec3 to_world(vec3 place) {
    return vec3(turn.x * place.x - turn.y * place.z, place.y, turn.y * place.x + turn.x * place.z);
}

vec3 to_model(vec3 world) {
    return vec3(turn.x * world.x + turn.y * world.z, world.y, turn.x * world.z - turn.y * world.x);
}

// Displacement of a trunk of a length [m] at a part of it [m].
vec2 trunk_offset(float part, float length_of) {
    return trunk_sway * (length_of * cantilever(clamp(part, 0.0, OVER_TOP)));
}

// Position of a point of its model, with the trunk bent, and its limb swung about its foot.
vec3 swayed(vec3 place, vec3 pivot, float limb, float hertz, vec2 message) {
    vec3 at = to_world(place);
    vec2 bent = trunk_offset(place.y / tall, tall);
    float out_by = distance(place, pivot), loose = out_by * out_by / (out_by + LIMB_STIFF);
    vec3 to = vec3(message, 0.0).xzy;
    float first = swing(hertz, limb + phase), second = swing(hertz * LIMB_ASIDE.y, limb * LIMB_ASIDE.z + phase);
    vec3 limb_sways = to * (LIMB_LEANS + LIMB_SWINGS * first) + vec3(-to.z, 0.0, to.x) * (LIMB_ASIDE.x * LIMB_SWINGS * second);
    limb_sways.y += LIMB_SWINGS * length(message) * second;
    at += limb_sways * loose;
    at.xz += bent;
    at.y -= dot(bent, bent) / max(2.0 * place.y, LOWEST_ARC);
    return root + scale * at;
}

const float FAINTEST_SUN = 0.02;  // least visible part of the sun's light, below which the shade of others is not read

// Light at a place in its crown, for faces of any normal: of sun and lamps, of sky and grass, and haze.
Light light_in_crown(vec3 place, vec4 shading, float up) {
#ifdef BAKED
    return Light(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec2(0.0));
#else
    float seen = grass_about.w * sun_transmittance(shading, to_model(sun), foliage);
    if (seen > FAINTEST_SUN)
        seen *= trees_visibility_beyond(place, OWN_CROWN * tall * scale);
    Light light = light_at(place, Reflector(FACE, vec2(0.0), vec3(0.0, 1.0, 0.0), 1.0), 1.0, seen);
    light.sky = hemisphere_light(light.sky, light_from_grass, sky_transmittance(shading, foliage), up);
    light.sun *= tint * (1.0 - haze_in_front.a);
    light.sky *= tint * (1.0 - haze_in_front.a);
    light.haze = haze_in_front.rgb * haze_in_front.a;
    return light;
#endif
}
