#include "lib/light.glsl"
#include "systems/bodies/saucer.py"

const float TURN = 6.2831853;  // radians
const float LAMPS = 12.0, LAMPS_AT = 1.22, LAMP = 0.055;  // how many, how far from the middle, how large [m]
const vec3 AHEAD = vec3(1.0, 0.42, 0.16), AROUND = vec3(0.80, 1.0, 0.86), BREATH = vec3(0.74, 0.95, 1.0);  // their pigments, the jet's
const vec3 BULB = vec3(1.6, 0.6, 0.15);  // radiance of a lamp; how white its middle is; radiance of its glow
const vec2 RIM = vec2(1.5, 0.55);  // how far a lamp's rim reaches, of its size, and how dark it is
const float GLOW = 6.0;  // how far the glow reaches, squared, of a lamp's size
const float FIRST = 1.6;  // how much larger the lamp ahead is

const vec2 PLATES = vec2(0.64, 1.40);  // between which distances from the middle seams part plates [m]
const float GIRTH = 1.02;  // where one goes around between [m]
const vec2 SEAM = vec2(0.006, 0.008);  // half the breadth of seams, and of the outermost [m]
const float SEAMS = 0.38;  // how dark they are

const vec2 LAWN = vec2(0.6, 0.8);  // what grass seen from above sends of the sun's light, and the sky's
const float LOW_SUN = 0.2;  // sine of the sun's elevation that counts at least for it
const vec2 BLADES_SEEN = vec2(0.45, 0.7);  // the part of blades whose pigment it has in a mirror, and on what it lights
const float FROM_LAWN = 0.8;  // of that light
const vec2 HORIZON = vec2(-0.12, 0.06);  // elevations between which a mirror goes over from grass to sky, as sines
const vec4 SUN_GLOSS = vec4(0.12, 8.0, 4.0, 400.0);  // the sun's glow in the mirrored sky: how bright, how narrow; its disc
const float FULL_SUN = 1.25;  // what a white face sends of the sun's light from straight ahead, of what a white leaf does
const vec2 GLASS_MIRRORS = vec2(0.30, 0.65), FIN_MIRRORS = vec2(0.05, 0.40), HULL_MIRRORS = vec2(0.24, 0.50);  // ahead; and more aside
const vec2 JET_FADES = vec2(0.34, 0.25);  // over how far from the middle [m], and by how much

uniform vec3 metal;  // albedos
uniform vec3 glass;
uniform vec3 paint;

in vec3 own;
in vec3 seen_at;
in vec3 facing;
flat in float made_of;
in float cover;

out vec4 pixel;

// Radiance of grass in this light, seen from above: the pigment at this part of its blades.
vec3 meadow(float at) {
    vec3 pigment = pigment_at(0, at);
    return pigment * pigment * (LAWN.x * sunlight * max(sun.y, LOW_SUN) + LAWN.y * skylight);
}

// What a mirror shows that looks this way: the sky, and below the horizon the grass.
vec3 around(vec3 toward) {
    float low = 1.0 - max(toward.y, 0.0);
    vec3 sky = mix(zenith, haze_radiance(eye + toward), low * low * low);
    float near_sun = max(dot(toward, sun), 0.0);
    sky += sunlight * (SUN_GLOSS.x * pow(near_sun, SUN_GLOSS.y) + SUN_GLOSS.z * pow(near_sun, SUN_GLOSS.w));
    return mix(meadow(BLADES_SEEN.x), sky, smoothstep(HORIZON.x, HORIZON.y, toward.y));
}

// Where a fragment of the hull is, as distances from what is on it, and how much of each a pixel takes in [m].
struct Marks {
    bool is_first;  // nearest to the lamp ahead
    float lamp;     // from the middle of the nearest lamp
    float middle;   // from the body's middle
    float ray;      // from the seam between two plates
    vec3 pixel;     // how much a pixel takes in of the three
};

// All fragments ask, whatever they are made of: their neighbours' differences hold nowhere else.
Marks marks_at(vec2 place) {
    float angle = atan(place.x, -place.y), sector = round(angle / TURN * LAMPS), turn = sector / LAMPS * TURN;
    float middle = length(place), lamp = distance(place, LAMPS_AT * vec2(sin(turn), -cos(turn)));
    float ray = middle * sin(0.5 * TURN / LAMPS - abs(angle - turn));
    return Marks(sector == 0.0, lamp, middle, ray, max(vec3(fwidth(lamp), fwidth(middle), fwidth(ray)), LEAST_WIDTH));
}

// How much of a line of this half width [m] at this distance from its middle a pixel sees.
float line(float away, float half_width, float soft) {
    return clamp((half_width - abs(away)) / soft + 0.5, 0.0, min(1.0, 2.0 * half_width / soft));
}

// Seams between plates.
float seams(Marks marks) {
    bool is_plate = marks.middle < PLATES.y && marks.middle > PLATES.x;
    float radial = is_plate ? line(marks.ray, SEAM.x, marks.pixel.z) : 0.0;
    float girth = line(marks.middle - GIRTH, SEAM.x, marks.pixel.y), outer = line(marks.middle - PLATES.y, SEAM.y, marks.pixel.y);
    return max(radial, max(girth, outer));
}

// The hull with its ring of lamps, and a red one ahead.
vec3 fitted(vec3 plate, Marks marks) {
    vec3 color = plate * (1.0 - SEAMS * seams(marks)), lamp = marks.is_first ? AHEAD : AROUND;
    float size = marks.is_first ? FIRST * LAMP : LAMP, off = marks.lamp, soft = marks.pixel.x, seen = min(1.0, size / soft);
    color *= 1.0 - RIM.y * seen * (1.0 - smoothstep(-soft, soft, off - RIM.x * size));
    color += lamp * lamp * BULB.z * exp(-off * off / (GLOW * size * size));
    vec3 bulb = BULB.x * mix(lamp * lamp, vec3(1.0), BULB.y * (1.0 - smoothstep(0.0, size, off)));
    return mix(color, bulb, seen * (1.0 - smoothstep(-soft, soft, off - size)));
}

// What light reaches a face, but for the haze before it: the sky's from above, and grass's from below.
Light light_on_body(vec3 normal) {
    float open = 0.5 + 0.5 * normal.y;
    Light light = light_at(seen_at, Reflector(FACE, vec2(0.0), normal, FULL_SUN), max(dot(normal, sun), 0.0), has_casters() ? casters_visibility(seen_at) : 1.0);
    light.sky = light.sky * open + meadow(BLADES_SEEN.y) * (FROM_LAWN * (1.0 - open));
    return light;
}

void main() {
    Marks marks = marks_at(own.xz);
    vec3 normal = normalize(facing), ray = normalize(seen_at - eye), mirrored = around(reflect(ray, normal));
    float grazing = 1.0 - max(-dot(ray, normal), 0.0), sheen = grazing * grazing * grazing;
    Light light = light_on_body(normal);
    vec3 color;
    if (made_of == GLASS)
        color = mix(shade(Surface(sqrt(glass), 0.0, 0.0), light), mirrored, GLASS_MIRRORS.x + GLASS_MIRRORS.y * sheen);
    else if (made_of == JET)
        color = BREATH * BREATH * (1.0 - JET_FADES.y * smoothstep(0.0, JET_FADES.x, marks.middle));
    else if (made_of == FIN)
        color = mix(shade(Surface(sqrt(paint), 0.0, 0.0), light), mirrored, FIN_MIRRORS.x + FIN_MIRRORS.y * sheen);
    else
        color = fitted(mix(shade(Surface(sqrt(metal), 0.0, 0.0), light), mirrored, HULL_MIRRORS.x + HULL_MIRRORS.y * sheen), marks);
    pixel = vec4(tone_mapped(mix(color, haze_radiance(seen_at), haze_opacity(seen_at))), 1.0) * cover;
}
