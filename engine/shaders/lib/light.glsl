// The one light function: blades, strips, carpet and ground all take their colours from here. Light is linear radiance;
// pigments are square roots of albedos, so that what lies between two pigments looks as if it did.
#include "lib/frame.glsl"

uniform sampler2D lie;      // over the terrain, side by side: its normal (x, z) and two slow noises; how high what stands before the sun
uniform sampler2DArray density;  // over the terrain, four kinds in each layer: how densely each grows
uniform sampler2D repeating;// squares that repeat: how dense clouds are; root of how bright the ground is, and where low leaves cover it

const float PENUMBRA = 0.02;    // half the width of a shadow's edge, of the distance from what casts it; the sun's alone is 0.005
const int SHADES = 8;           // bodies that cast shadows
const float CLOUDS_AT = 450.0;  // height of the clouds [m]
const float CLOUDS_SIDE = 900.0;// side of the square that repeats [m]
const float CLOUD_TAKES = 0.75; // what a dense cloud takes of the sun's light
const float OPEN_SKY = 1.6;     // leaves that the sky's light meets, of those seen from the side
const float LITTER_SIDE = 1.8; // side of the square of ground that repeats [m]
const float LITTER_ONE = 255.0 / 128.0;  // what stands for ground as bright as its mean
const float COARSEST = 16.0;   // level at which a texture is its mean, or its last
const float AGAIN = 0.7;        // what leaves send to one another of the sun's light, of one with this albedo
const float FALLEN_TIPPED = 0.3;// how much of the colour of tips what has fallen has, of a kind that shows it as grass does
const float LITTER = 0.75;      // how much of the ground under dense grass is covered by what has fallen

// Light that a leaf of a kind gets at a place, as radiance towards the eye of a white one, and what is mirrored.
struct Lit {
    vec3 sun;     // in full sun
    vec3 sky;     // under the whole sky
    float gloss;  // mirrored of the sun, where it is seen
    vec2 way;     // how many leaves the sun's and the sky's light meet, of those that stand above, seen from the side
    vec2 leaves;  // that stand above the kind's top, and between that and the ground, of the ground's area
};

// What lies over the terrain at a place, as `lie` has it; beyond the edge that goes on as in a mirror.
vec2 on_map(vec2 place) {
    return 1.0 - abs(1.0 - mod((place - terrain.xy) / field.xy, 2.0));
}

// Where the left half of `lie` has a place.
vec2 on_left(vec2 place) {
    vec2 at = on_map(place), half_texel = 0.5 / vec2(textureSize(lie, 0));
    return vec2(clamp(0.5 * at.x, half_texel.x, 0.5 - half_texel.x), at.y);
}

// Sine of the sun's elevation over the slope; how much of its disc is seen past the terrain; two slow noises.
vec4 lie_at(vec2 place) {
    vec2 at = on_left(place);
    vec4 still = textureLod(lie, at, 0.0);
    float before = textureLod(lie, vec2(at.x + 0.5, at.y), 0.0).r;
    float high = dot(sun.xz, still.xy) + sun.y * sqrt(max(1.0 - dot(still.xy, still.xy), 0.0));
    float rise = max(sun.y, 0.01) / max(length(sun.xz), 1e-4), past = clamp(0.5 + 0.5 * (rise - before) / PENUMBRA, 0.0, 1.0);
    return vec4(max(high, 0.0), past * past * (3.0 - 2.0 * past), still.zw);
}

// How the ground rises along x and z.
vec2 rise_at(vec2 place) {
    vec2 still = textureLod(lie, on_left(place), 0.0).xy;
    return -still * inversesqrt(max(1.0 - dot(still, still), 0.01));
}

// How steep a line of sight is to the ground: the sine of the angle between them.
float steep_at(vec3 place) {
    vec2 still = textureLod(lie, on_left(place.xz), 0.0).xy;
    return dot(normalize(eye.xyz - place), vec3(still, sqrt(max(1.0 - dot(still, still), 0.0))).xzy);
}

// How densely each kind grows at a place.
ByKind grows_at(vec2 place) {
    vec2 at = on_map(place);
    ByKind grows;
    for (int group = 0; group < GROUPS; group++)
        grows[group] = textureLod(density, vec3(at, float(group)), 0.0);
    return grows;
}

// How densely one does.
float grows_at(vec2 place, int kind) {
    return textureLod(density, vec3(on_map(place), float(GROUP(kind))), 0.0)[IN_GROUP(kind)];
}

// The leaf area of each kind, of the ground's.
ByKind areas(ByKind grows) {
    for (int group = 0; group < GROUPS; group++)
        grows[group] *= leaf[group];
    return grows;
}

#ifdef MOWN
uniform sampler2D mown;  // over the terrain: up to which height grass is left to stand [m]

// Beyond the terrain nobody mows.
bool can_be_mown(vec2 place) {
    vec2 beside = abs(place - terrain.xy - 0.5 * field.xy) - 0.5 * field.xy;
    return max(beside.x, beside.y) < 0.0;
}

float left_at(vec2 place) {
    return can_be_mown(place) ? textureLod(mown, (place - terrain.xy) / field.xy, 0.0).r : zenith.w;
}

// The mean over squares of `side` [m].
float left_about(vec2 place, float side) {
    float cell = field.x / float(textureSize(mown, 0).x), level = log2(max(side / cell, 1.0));
    return can_be_mown(place) ? textureLod(mown, (place - terrain.xy) / field.xy, level).r : zenith.w;
}

// Whether that is lower than the canopy of the tallest kind.
bool is_mown(float left) {
    float tallest = 0.0;
    for (int group = 0; group < GROUPS; group++)
        tallest = max(tallest, max(max(crown[group].x, crown[group].y), max(crown[group].z, crown[group].w)));
    return left < tallest;
}

// How much of each kind's leaf area is left below a height [m].
ByKind leaves_left(float top) {
    ByKind left;
    for (int group = 0; group < GROUPS; group++) {
        vec4 gone = max(1.0 - top / max(crown[group], 0.01), 0.0);
        left[group] = 1.0 - gone * gone;
    }
    return left;
}
#endif

// Drier and fresher stretches, as a factor of the pigment.
vec3 stretch(vec4 here) {
    return 1.0 + 0.16 * here.z + 0.14 * here.w * vec3(1.0, 0.1, -0.9);
}

// Mean cosine of twice the azimuth from the eye of blades that face all ways, as they are seen: a third by their breadth
// alone, and more, as broad ones hide narrow ones. Measured on slopes and level ground, with and without wind.
const float FACING = 0.43;

// Mean cosine and sine of twice the azimuth that blades face of those that a line of sight meets, where they lean along
// `lean` and face all ways. Of upright blades those are seen most that face the eye; of blades that lean aside, as much
// others as they are seen from above.
vec2 faces_seen(int kind, vec3 lean, vec3 ray) {
    vec2 across = cross(lean, ray).xz;
    float lies = OF(lying, kind) * lean.y * ray.y, all = dot(across, across);
    return FACING / max(all + lies * lies, 1e-9) * vec2(across.y * across.y - across.x * across.x, -2.0 * across.x * across.y);
}

// How much of the sun is seen past the clouds, from a place.
float past_clouds(vec3 place) {
    vec2 at = place.xz + sun.xz * (CLOUDS_AT / max(sun.y, 0.1));
    float dense = textureLod(repeating, at / CLOUDS_SIDE - drift.xy, 0.0).r;
    return 1.0 - CLOUD_TAKES * smoothstep(1.0 - sunlight.w, 1.25 - sunlight.w, dense);
}

// How the sun's ray past a place comes by a body: from its middle, in radii, and how soft the shadow's edge is; far off where
// the body stands behind. A body is a ball that is stretched or pressed flat along an axis: it is drawn out until it is one,
// and the ray with it.
vec4 ray_by(int body, vec3 place) {
    vec3 apart = shades[body].xyz - place, axis = shaped[body].xyz;
    float pressed = shaped[body].w, radius = shades[body].w;
    vec3 way = apart + axis * (pressed * dot(axis, apart)), ray = sun.xyz + axis * (pressed * dot(axis, sun.xyz));
    float before = dot(way, ray) / dot(ray, ray), along = dot(apart, sun.xyz);
    vec3 by = (way - ray * before) / radius;
    // The farther a shadow falls, the softer is its edge.
    float soft = 0.12 + 0.01 * abs(along) * max(length(by), 1e-3) / max(length(apart - sun.xyz * along), 1e-3 * radius);
    return vec4(before > 0.0 ? by : vec3(1e3), soft);
}

// How much of the sun is seen past a body, where its ray comes so near to the middle, in radii.
float past_body(float near, float soft) {
    return 1.0 - (1.0 - smoothstep(1.0 - soft, 1.0 + soft, near)) / max(soft * soft, 1.0);
}

// How much of it is seen from a place past all bodies but one.
float past_bodies(vec3 place, int but) {
    float seen = 1.0;
    for (int body = 0; body < SHADES && shades[body].w > 0.0; body++) {
        vec4 by = ray_by(body, place);
        seen *= body == but ? 1.0 : past_body(length(by.xyz), by.w);
    }
    return seen;
}

// How much of the sun is seen from a place past all but bodies, `past` of it past the terrain.
float sun_past(vec3 place, float past) {
    return sunlight.w > 0.0 ? past * past_clouds(place) : past;
}

// How much of it is seen past these too.
float sun_seen(vec3 place, float past) {
    return sun_past(place, past) * (shades[0].w > 0.0 ? past_bodies(place, -1) : 1.0);
}

const float LODGED = 0.55;  // how much lower the canopy is where all grass lies

// How high the canopy stands where `bend` bends it, of its height at rest: where all grass lies, its tips are the top.
float lodged(vec2 bend) {
    return 1.0 - LODGED * min(dot(bend, bend), 1.0);
}

// Leaf area above a height [m], where each kind has so much. It thins out towards the top of each.
float leaves_above(float height, ByKind area) {
    float over = 0.0;
    for (int group = 0; group < GROUPS; group++) {
        vec4 above = max(1.0 - height / max(crown[group], 0.01), 0.0);
        over += dot(area[group], above * above);
    }
    return over;
}

// Leaf area above a kind's top and between that and the ground.
vec2 leaves_over(ByKind grows, int k) {
    ByKind area = areas(grows);
    float over = leaves_above(OF(crown, k), area);
    return vec2(over, total(area) - over);
}

// How many leaves the sun's and the sky's light meets on its way, where the sun's elevation over the slope has this sine.
vec2 ways(int k, float high) {
    high = max(high, 0.08);
    return vec2(sqrt(1.0 - min(high * high, 1.0)) / high + OF(lying, k), OPEN_SKY);
}

// The light on leaves of kind `k` at a place: `here` of lie_at, `grows` of density, the wind bending them by `bend`, and how
// much of the sun is `seen` there.
Lit lit_at(int k, vec2 bend, vec3 place, vec4 here, ByKind grows, float seen) {
    vec3 ray = normalize(place - eye.xyz);
    float facing = dot(ray, sun.xyz);
    // Leaves that face all ways send back what the eye sees lit, and let through what it sees against the light.
    float back = 0.5 - 0.5 * facing, against = 1.0 - back;
    vec3 phase = back * sqrt(back) + against * sqrt(against) * through[k].rgb;
    vec3 direct = sunlight.rgb * seen;
    // Bent grass shows its faces to the sky, and more so to an eye that it leans away from.
    float lies = min(dot(bend, bend), 1.0), face = 1.0 + 0.22 * lies + 0.18 * dot(bend, normalize(ray.xz + 1e-6));
    // A blade mirrors the sun along itself like a thread (Kajiya and Kay, Rendering Fur, 1989).
    vec3 spine = normalize(vec3(1.3 * bend.x, 1.0 - 0.7 * length(bend), 1.3 * bend.y)), half_way = normalize(sun.xyz - ray);
    float along = dot(spine, half_way), thread = 1.0 - along * along;
    thread *= thread;
    thread *= thread;
    return Lit(direct * phase * face * mix(0.75, 1.0, here.x), skylight.rgb * face, seen * root[k].w * thread * thread,
               ways(k, here.x), leaves_over(grows, k));
}

Lit lit_at(int k, vec2 bend, vec3 place, vec4 here, ByKind grows) {
    return lit_at(k, bend, place, here, grows, sun_seen(place, here.y));
}

// What reaches leaves at some height, and is sent from there to the eye: of a white leaf; what leaves send to one another,
// of one of albedo 1; what is mirrored.
struct Reached {
    vec3 light;
    vec3 again;
    vec3 gloss;
};

#ifdef MOWN
// The light on kind `k` where nothing stands above `top` [m]: leaves over that shade nothing. `area` is that of leaves,
// by kind.
Lit mown_to(float top, Lit lit, int k, ByKind area) {
    float deep = clamp(1.0 - top / max(OF(crown, k), 0.01), 0.0, 1.0);
    lit.leaves.x -= leaves_above(max(top, OF(crown, k)), area) + lit.leaves.y * deep * deep * (0.75 + 0.25 * deep);
    return lit;
}
#endif

// What reaches height `h` in a kind's canopy, of which 1 is the top.
Reached reached(float h, Lit lit) {
    float deep = clamp(1.0 - h, 0.0, 1.0), over = lit.leaves.x + lit.leaves.y * deep * deep * (0.75 + 0.25 * deep);
#ifdef MOWN
    over = max(over, 0.0);  // grass that lies flat stands lower than its cut
#endif
    vec2 seen = exp(-lit.way * over);
    return Reached(lit.sun * seen.x + lit.sky * seen.y, lit.sun * (AGAIN * seen.y), sunlight.rgb * (lit.gloss * seen.x));
}

vec3 radiance(vec3 pigment, Reached light) {
    vec3 albedo = pigment * pigment;
    return albedo * (light.light + albedo * light.again) + light.gloss;
}

// Radiance of a leaf with this pigment at height `h` in its kind's canopy.
vec3 radiance(vec3 pigment, float h, Lit lit) {
    return radiance(pigment, reached(h, lit));
}

// Radiance of the haze that lies before a place.
vec3 haze_light(vec3 place) {
    vec2 ray = place.xz - eye.xz;
    float c = dot(ray, drift.zw) * inversesqrt(dot(ray, ray) + 1e-6);
    return horizon[0].rgb + c * (horizon[1].rgb + c * horizon[2].rgb);
}

float haze_at(vec3 place) {
    return 1.0 - exp(-distance(place, eye.xyz) * skylight.w);
}

// A mean of what kinds look like near the ground, where each has so much of its tip's colour.
vec3 low_pigment(ByKind weights, ByKind tipped) {
    vec3 low = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        low += OF(weights, kind) * mix(root[kind].rgb, tip[kind].rgb, OF(tipped, kind));
    return low / max(total(weights), 1e-3);
}

// What lies on the ground where grass stands, and the ground: `here` of lie_at, `grows` of density.
vec3 soil_pigment(vec4 here, ByKind grows) {
    ByKind tipped;
    for (int kind = 0; kind < KINDS; kind++)
        OF(tipped, kind) = FALLEN_TIPPED * through[kind].w * through[kind].w;
    vec3 fallen = low_pigment(grows, tipped);
    return mix(soil.rgb, mix(soil.rgb, fallen, LITTER), min(total(grows), 1.0)) * stretch(here);
}

// The pigment of the understorey's leaves, of that of the ground between; 1 where there are none.
vec3 understorey_of(vec4 here, ByKind grows) {
    vec3 between = soil_pigment(here, grows);
    ByKind tipped;
    for (int group = 0; group < GROUPS; group++) {
        grows[group] *= understorey[group];
        tipped[group] = undertone[group];
    }
    vec3 leaves = low_pigment(grows, tipped) * stretch(here);
    return mix(vec3(1.0), leaves / max(between, 0.02), min(total(grows), 1.0));
}

// The pigment of what lies there, of that of the ground between low leaves: `lying` from `repeating`.
vec3 lying_pigment(vec2 lying, vec3 lush) {
    return lying.x * LITTER_ONE * mix(vec3(1.0), lush, lying.y);
}

// That in its light, under a leaf area [of the ground's].
vec3 soil_light(vec3 place, vec4 here, ByKind grows, float leaves) {
    vec3 pigment = soil_pigment(here, grows);
    vec2 seen = exp(-ways(0, here.x) * leaves);
    return pigment * pigment * (sunlight.rgb * (1.3 * here.x * seen.x * sun_seen(place, here.y)) + skylight.rgb * seen.y);
}

const vec3 CURVE = vec3(0.78, 0.349, -0.287);  // a toe, middle tones and a shoulder, by powers of the root of radiance
const float WHITE = 1.44;  // root of the radiance that is as white as can be

// What the door shows of radiance, with a toe in the shadows and a shoulder up to white; or the radiance itself.
vec3 shown_of(vec3 light) {
    light = max(light, 0.0);
    if (sun.w > 0.5)
        return light;
    vec3 root_of = min(sqrt(light), WHITE);
    return root_of * (CURVE.x + root_of * (CURVE.y + root_of * CURVE.z));
}
