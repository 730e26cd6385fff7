#include "lib/light.glsl"
#include "systems/bodies/saucer.py"

const float LAMPS = 12.0, LAMPS_AT = 1.22, LAMP = 0.055;  // how many, how far from the middle, how large [m]
const vec3 AHEAD = vec3(1.0, 0.42, 0.16), AROUND = vec3(0.80, 1.0, 0.86), BREATH = vec3(0.74, 0.95, 1.0);

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
    return pigment * pigment * (0.6 * sunlight * max(sun.y, 0.2) + 0.8 * skylight);
}

// What a mirror shows that looks this way: the sky, and below the horizon the grass.
vec3 around(vec3 toward) {
    float low = 1.0 - max(toward.y, 0.0);
    vec3 sky = mix(zenith, haze_light(eye + toward), low * low * low);
    float near_sun = max(dot(toward, sun), 0.0);
    sky += sunlight * (0.12 * pow(near_sun, 8.0) + 4.0 * pow(near_sun, 400.0));
    return mix(meadow(0.45), sky, smoothstep(-0.12, 0.06, toward.y));
}

// How much of a line of this half width [m] at this distance from its middle a pixel sees.
float line(float away, float half_width) {
    float soft = max(fwidth(away), 1e-4);
    return clamp((half_width - abs(away)) / soft + 0.5, 0.0, min(1.0, 2.0 * half_width / soft));
}

// Seams between plates.
float seams(float from, float half_turn) {
    float radial = from < 1.40 && from > 0.64 ? line(from * sin(half_turn), 0.006) : 0.0;
    return max(radial, max(line(from - 1.02, 0.006), line(from - 1.40, 0.008)));
}

// The hull with its ring of lamps, and a red one ahead.
vec3 fitted(vec3 plate) {
    float angle = atan(own.x, -own.z), sector = round(angle / 6.2831853 * LAMPS);
    float turn = sector / LAMPS * 6.2831853;
    vec3 color = plate * (1.0 - 0.38 * seams(length(own.xz), 3.1415927 / LAMPS - abs(angle - turn)));
    bool first = sector == 0.0;
    vec3 lamp = first ? AHEAD : AROUND;
    float size = first ? 1.6 * LAMP : LAMP;
    float off = distance(own.xz, LAMPS_AT * vec2(sin(turn), -cos(turn)));
    float soft = max(fwidth(off), 1e-4), seen = min(1.0, size / soft);
    color *= 1.0 - 0.55 * seen * smoothstep(soft, -soft, off - 1.5 * size);
    color += lamp * lamp * 0.15 * exp(-off * off / (6.0 * size * size));
    vec3 bulb = 1.6 * mix(lamp * lamp, vec3(1.0), 0.6 * smoothstep(size, 0.0, off));
    return mix(color, bulb, seen * smoothstep(soft, -soft, off - size));
}

void main() {
    vec3 normal = normalize(facing), ray = normalize(seen_at - eye);
    float open = 0.5 + 0.5 * normal.y, grazing = 1.0 - max(-dot(ray, normal), 0.0);
    vec3 light = mix(meadow(0.7) * 0.8, skylight, open) + 1.25 * sunlight * max(dot(normal, sun), 0.0);
    vec3 mirrored = around(reflect(ray, normal));
    float sheen = grazing * grazing * grazing;
    vec3 color;
    if (made_of == GLASS)
        color = mix(glass * light, mirrored, 0.30 + 0.65 * sheen);
    else if (made_of == JET)
        color = BREATH * BREATH * mix(1.0, 0.75, smoothstep(0.0, 0.34, length(own.xz)));
    else if (made_of == FIN)
        color = mix(paint * light, mirrored, 0.05 + 0.4 * sheen);
    else
        color = fitted(mix(metal * light, mirrored, 0.24 + 0.5 * sheen));
    pixel = vec4(shown_of(mix(color, haze_light(seen_at), haze_at(seen_at))), 1.0) * cover;
}
