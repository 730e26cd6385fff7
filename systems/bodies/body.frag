#include "lib/light.glsl"
#include "systems/bodies/saucer.py"

const float TURN = 6.2831853;  // radians
const float LAMPS = 12.0, LAMPS_AT = 1.22, LAMP = 0.055;  // number of lamps; their distance from the middle, their radius [m]
const vec3 AHEAD = vec3(1.0, 0.42, 0.16), AROUND = vec3(0.80, 1.0, 0.86), BREATH = vec3(0.74, 0.95, 1.0);  // pigments of lamps and of the jet
const vec3 BULB = vec3(1.6, 0.6, 0.15);  // radiance of a lamp; part of white in its middle; radiance of its glow
const vec2 RIM = vec2(1.5, 0.55);  // radius of a lamp's rim, relative to the lamp's; darkness of the rim
const float GLOW = 6.0;  // squared width of the glow, relative to a lamp's radius
const float FIRST = 1.6;  // relative size of the lamp ahead

const vec2 PLATES = vec2(0.64, 1.40);  // distances from the middle between which plates have seams [m]
const float GIRTH = 1.02;  // distance of the seam that goes around [m]
const vec2 SEAM = vec2(0.006, 0.008);  // half the width of seams, and of the outermost [m]
const float SEAMS = 0.38;  // darkness of seams

const vec2 LAWN = vec2(0.6, 0.8);  // reflectance of grass seen from above, for sunlight and skylight
const float LOW_SUN = 0.2;  // smallest sine of the sun's elevation for it
const vec2 BLADES_SEEN = vec2(0.45, 0.7);  // height along blades of the pigment in a mirror, and in light from grass
const float FROM_LAWN = 0.8;  // factor on light from grass
const vec2 HORIZON = vec2(-0.12, 0.06);  // sines of elevation between which a mirror blends from grass to sky
const vec4 SUN_GLOSS = vec4(0.12, 8.0, 4.0, 400.0);  // the sun's glow in the mirrored sky, and its disc: brightness and narrowness of each
const float FULL_SUN = 1.25;  // radiance of a white face square to the sun, relative to a white leaf in full sun
const vec2 GLASS_MIRRORS = vec2(0.30, 0.65), FIN_MIRRORS = vec2(0.05, 0.40), HULL_MIRRORS = vec2(0.24, 0.50);  // mirroring from straight ahead, and its increase towards grazing angles
const vec2 JET_FADES = vec2(0.34, 0.25);  // radius [m] and amount of the jet's fade

uniform vec3 metal;  // albedos
uniform vec3 glass;
uniform vec3 paint;

in vec3 local;
in vec3 world_place;
in vec3 world_normal;
flat in float material;
in float cover;

out vec4 pixel;

// Radiance of grass seen from above, with the pigment at a height along its blades.
vec3 grass_radiance(float at) {
    vec3 pigment = pigment_at(0, at);
    return pigment * pigment * (LAWN.x * sunlight * max(sun.y, LOW_SUN) + LAWN.y * skylight);
}

// Radiance of the surroundings in a direction: sky, and grass below the horizon.
vec3 surroundings(vec3 toward) {
    float low = 1.0 - max(toward.y, 0.0);
    vec3 sky = mix(zenith, haze_radiance(eye + toward), low * low * low);
    float near_sun = max(dot(toward, sun), 0.0);
    sky += sunlight * (SUN_GLOSS.x * pow(near_sun, SUN_GLOSS.y) + SUN_GLOSS.z * pow(near_sun, SUN_GLOSS.w));
    return mix(grass_radiance(BLADES_SEEN.x), sky, smoothstep(HORIZON.x, HORIZON.y, toward.y));
}

// Distances of a fragment from features of the hull, and their changes across a pixel [m].
struct Marks {
    bool is_first;  // nearest to the lamp ahead
    float lamp;     // from the middle of the nearest lamp
    float middle;   // from the body's middle
    float ray;      // from the seam between two plates
    vec3 pixel;     // change of the three distances across a pixel
};

// All fragments call this, whatever their material, because derivatives are undefined in branches.
Marks marks_at(vec2 place) {
    float angle = atan(place.x, -place.y), sector = round(angle / TURN * LAMPS), turn = sector / LAMPS * TURN;
    float middle = length(place), lamp = distance(place, LAMPS_AT * vec2(sin(turn), -cos(turn)));
    float ray = middle * sin(0.5 * TURN / LAMPS - abs(angle - turn));
    return Marks(sector == 0.0, lamp, middle, ray, max(vec3(fwidth(lamp), fwidth(middle), fwidth(ray)), LEAST_WIDTH));
}

// Coverage of a pixel by a line, by the distance from its middle and its half width [m]; `soft` is the pixel's width.
float line_coverage(float away, float half_width, float soft) {
    return clamp((half_width - abs(away)) / soft + 0.5, 0.0, min(1.0, 2.0 * half_width / soft));
}

// Coverage by seams between plates.
float seam_coverage(Marks marks) {
    bool is_plate = marks.middle < PLATES.y && marks.middle > PLATES.x;
    float radial = is_plate ? line_coverage(marks.ray, SEAM.x, marks.pixel.z) : 0.0;
    float girth = line_coverage(marks.middle - GIRTH, SEAM.x, marks.pixel.y), outer = line_coverage(marks.middle - PLATES.y, SEAM.y, marks.pixel.y);
    return max(radial, max(girth, outer));
}

// Colour of the hull with its seams and ring of lamps, the one ahead red.
vec3 hull_colour(vec3 plate, Marks marks) {
    vec3 color = plate * (1.0 - SEAMS * seam_coverage(marks)), lamp = marks.is_first ? AHEAD : AROUND;
    float size = marks.is_first ? FIRST * LAMP : LAMP, off = marks.lamp, soft = marks.pixel.x, seen = min(1.0, size / soft);
    color *= 1.0 - RIM.y * seen * (1.0 - smoothstep(-soft, soft, off - RIM.x * size));
    color += lamp * lamp * BULB.z * exp(-off * off / (GLOW * size * size));
    vec3 bulb = BULB.x * mix(lamp * lamp, vec3(1.0), BULB.y * (1.0 - smoothstep(0.0, size, off)));
    return mix(color, bulb, seen * (1.0 - smoothstep(-soft, soft, off - size)));
}

// Light on a face: the sky's from above, and grass's from below.
Light light_on_body(vec3 normal) {
    float open = 0.5 + 0.5 * normal.y;
    Light light = light_at(world_place, Reflector(FACE, vec2(0.0), normal, FULL_SUN), max(dot(normal, sun), 0.0), has_casters() ? casters_visibility(world_place) : 1.0);
    light.sky = light.sky * open + grass_radiance(BLADES_SEEN.y) * (FROM_LAWN * (1.0 - open));
    return light;
}

void main() {
    Marks marks = marks_at(local.xz);
    vec3 normal = normalize(world_normal), ray = normalize(world_place - eye), mirrored = surroundings(reflect(ray, normal));
    float grazing = 1.0 - max(-dot(ray, normal), 0.0), sheen = grazing * grazing * grazing;
    Light light = light_on_body(normal);
    vec3 color;
    if (material == GLASS)
        color = mix(shade(Surface(sqrt(glass), 0.0, 0.0), light), mirrored, GLASS_MIRRORS.x + GLASS_MIRRORS.y * sheen);
    else if (material == JET)
        color = BREATH * BREATH * (1.0 - JET_FADES.y * smoothstep(0.0, JET_FADES.x, marks.middle));
    else if (material == FIN)
        color = mix(shade(Surface(sqrt(paint), 0.0, 0.0), light), mirrored, FIN_MIRRORS.x + FIN_MIRRORS.y * sheen);
    else
        color = hull_colour(mix(shade(Surface(sqrt(metal), 0.0, 0.0), light), mirrored, HULL_MIRRORS.x + HULL_MIRRORS.y * sheen), marks);
    pixel = vec4(tone_mapped(mix(color, haze_radiance(world_place), haze_opacity(world_place))), 1.0) * cover;
}
