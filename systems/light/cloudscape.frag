// Clouds in the picture: their opacity; the sunlight of lit sides and the scattered light that they send, times opacity; and their opacity
// before the sun, which the air's veil does not lower.
#include "systems/light/clouding.glsl"

in vec3 ray;
flat in vec4 map_toward_sun;
flat in vec4 billows_toward_sun;
flat in float sun_scattered;
out vec4 pixel;

const float SILVER_POWER = 12.0;  // narrowness of the silver lining around the sun

// What a line of sight has accumulated: transmittance; and from the opaque rest, sunlight of lit sides beyond what is scattered there,
// and scattered light, each relative to a thin cloud's.
struct March {
    float transmitted;
    float sunlit;
    float scattered;
};

// Odds of shade against sunlight at a point in a cloud, by the density towards the sun.
float shade_odds(CloudPoint point) {
    float shading = max(point.dome, 0.0) + CLOUD_BASE_SHADING * (1.0 - point.relief) + dot(vec4(point.map.yz, point.along, 1.0), map_toward_sun);
    shading += point.relief * (dot(vec4(point.billow.yzw, 1.0), billows_toward_sun) - CLOUD_CREASE_SHADING * (point.billow.x - 0.5));
    return exp(CLOUD_SHADING * shading);
}

// Factor by which light is weakened that is scattered to a point through the cloud above, with the billows that hang from its base.
float weakening(CloudPoint point) {
    float column = point.column + CLOUD_BILLOWED * (1.0 - point.relief) * (point.billow.x - 0.5);
    return 1.0 + CLOUD_DIFFUSION * inversesqrt(CLOUD_DOME) * max(sqrt(max(column, 0.0)) - sqrt(tallest_column()) * point.along, 0.0);
}

// Add a step of the march up to a point: `way` is its length relative to the whole way straight up; the excess density changes linearly
// from `before`.
void accumulate(CloudPoint point, float before, float way, inout March march) {
    float sum = max(before, 0.0) + max(point.excess, 0.0);
    if (sum <= 0.0)
        return;
    float mean = 0.5 * sum * sum / (abs(before) + abs(point.excess));  // of the part inside: less than half the sum across an edge
    float transmitted = march.transmitted * transmittance(CLOUD_MARCH_DEPTH * way * mean), stopped = march.transmitted - transmitted;
    float odds = shade_odds(point), weakened = weakening(point), part = stopped / (weakened + weakened * odds);
    march.sunlit += part * (weakened - sun_scattered);
    march.scattered += part + part * odds;
    march.transmitted = transmitted;
}

// Length of the next step, relative to the whole way: outside clouds, short enough not to miss one.
float step_length(float excess) {
    float inside = min(CLOUD_STEP_INSIDE * excess, CLOUD_STEP_LENGTHS.z), outside = min(-CLOUD_STEP_OUTSIDE * excess, CLOUD_STEP_LENGTHS.y);
    return CLOUD_STEP_LENGTHS.x + (excess > 0.0 ? inside : outside);
}

March march_along(Way way) {
    March march = March(1.0, 0.0, 0.0);
    float along = 0.0, excess = cloud_at(way, 0.0).excess, step = step_length(excess);
    bool at_surface = false;
    for (int turn = 0; turn < CLOUD_MOST_STEPS && along < 1.0 && march.transmitted > CLOUD_OPAQUE; turn++) {
        CloudPoint point = cloud_at(way, along + step);
        if (!at_surface && excess < 0.0 && point.excess > 0.0) {  // into a cloud: not as deep at once, by the secant
            step = max(step * excess / (excess - point.excess), CLOUD_STEP_LENGTHS.x);
            at_surface = true;
            continue;
        }
        at_surface = false;
        accumulate(point, excess, step * way.length_ratio, march);
        along = point.along;
        excess = point.excess;
        step = step_length(excess);
    }
    return march;
}

// Part of the light that comes straight on through a cloud or is scattered hardly aside, by its transmittance: 0 where that counts as 0.
float scattered_on(float transmitted) {
    return (pow(max(transmitted, CLOUD_OPAQUE), CLOUD_SILVER_DEPTH) - CLOUD_SILVER_LEAST) / (1.0 - CLOUD_SILVER_LEAST);
}

void main() {
    vec3 toward = normalize(ray);
    pixel = vec4(0.0);
    if (toward.y < CLOUD_FADE.x)
        return;
    March march = march_along(way_toward(toward));
    if (march.transmitted >= 1.0)
        return;
    float transmitted = max(march.transmitted - CLOUD_OPAQUE, 0.0) / (1.0 - CLOUD_OPAQUE), opacity = 1.0 - transmitted;
    vec3 seen = opacity * vec3(1.0, vec2(CLOUD_SUNLIT * march.sunlit, march.scattered) / (1.0 - march.transmitted));
    seen.y += CLOUD_SILVER * pow(max(0.5 + 0.5 * dot(toward, sun), 0.0), SILVER_POWER) * scattered_on(march.transmitted) * opacity;
    float gaps = clamp(1.0 + cloud_edge / CLOUD_OVERCAST, 0.0, 1.0);  // 0 for an overcast, which the air does not veil
    pixel = smoothstep(CLOUD_FADE.x, CLOUD_FADE.y, toward.y) * vec4((1.0 - CLOUD_AIR_VEIL * gaps) * seen, opacity);
}
