// What is seen of clouds: how much they hide, and so much of what they send of the sun's light, and of light in full shade; and how
// much they hide of the sun, which no air before them makes up for.
#include "systems/light/clouding.glsl"

in vec3 ray;
flat in vec4 sun_over;
flat in vec4 sun_into;
out vec4 pixel;

const float FORWARDS = 12.0;  // the power that tells how much edges of clouds are brighter ahead of the sun

// What a line of sight meets of clouds: what comes through them; and of droplets that stop it, how much the sun lights them, and how
// bright they are in full shade.
struct Met {
    float through;
    float lit;
    float shaded;
};

// How much of the sun's light comes to a place in a cloud, which is so much denser at its base than at its edge.
float sunny_at(Place place, float under) {
    float shades = under + CLOUD_UNDER * (1.0 - place.side) + dot(vec4(place.map.yz, place.along, 1.0), sun_over);
    shades += place.side * dot(vec4(place.billow.yzw, 1.0), sun_into) - CLOUD_OPEN * place.heap;
    return CLOUD_WITHIN + (1.0 - CLOUD_WITHIN) / (1.0 + exp(CLOUD_DEEPER * shades));
}

// Go on to a place: on the way so long, straight up or as long, clouds get evenly denser or thinner than they were before.
void go_on(Place place, float before, float way, inout Met met) {
    float sum = max(before, 0.0) + max(place.deep, 0.0);
    if (sum <= 0.0)
        return;
    float mean = 0.5 * sum * sum / (abs(before) + abs(place.deep));  // of what is within: less than half the sum where an edge is crossed
    float under = max(place.map.x - cloud_edge - CLOUD_ROUND * place.along * place.along, 0.0);
    float through = met.through * transmittance(CLOUD_THICK * way * mean), stopped = met.through - through;
    met.lit += stopped * sunny_at(place, under);
    met.shaded += stopped * (CLOUD_PALE + CLOUD_HIGHER * place.along - CLOUD_DARK * under + CLOUD_HEAPED * place.heap);
    met.through = through;
}

// How far a line of sight steps on: outside of clouds as far as it cannot miss one by what it lacks.
float step_from(float deep) {
    return CLOUD_STEPS.x + (deep > 0.0 ? min(CLOUD_INTO * deep, CLOUD_STEPS.z) : min(-CLOUD_SAFE * deep, CLOUD_STEPS.y));
}

Met met_along(Way way) {
    Met met = Met(1.0, 0.0, 0.0);
    Place place = place_on(way, 0.0);
    for (int turn = 0; turn < CLOUD_TURNS && place.along < 1.0 && met.through > CLOUD_LEAST; turn++) {
        float before = place.deep, step = step_from(before);
        place = place_on(way, place.along + step);
        go_on(place, before, step * way.longer, met);
    }
    return met;
}

void main() {
    vec3 toward = normalize(ray);
    pixel = vec4(0.0);
    if (toward.y < CLOUDS_FADE.x)
        return;
    Met met = met_along(way_toward(toward));
    if (met.through >= 1.0)
        return;
    float through = max(met.through - CLOUD_LEAST, 0.0) / (1.0 - CLOUD_LEAST), hides = 1.0 - through;
    vec3 seen = hides * vec3(1.0, vec2(CLOUD_SUNLIT * met.lit, met.shaded) / (1.0 - met.through));
    seen.y += CLOUD_SILVER * pow(max(0.5 + 0.5 * dot(toward, sun), 0.0), FORWARDS) * pow(through, CLOUD_STRAYS) * hides;
    float sides = clamp(1.0 + cloud_edge / CLOUD_OVERCAST, 0.0, 1.0);  // an overcast has none
    pixel = smoothstep(CLOUDS_FADE.x, CLOUDS_FADE.y, toward.y) * vec4((1.0 - CLOUD_AIR * sides) * seen, hides);
}
