// What is seen of clouds: how much they hide, and so much of what they send of the sun's light, and of light in full shade; and how
// much they hide of the sun, which no air before them makes up for.
#include "systems/light/clouding.glsl"
#include "systems/light/cloudscape.py"

in vec3 ray;
flat in vec4 sun_over;
flat in vec4 sun_into;
out vec4 pixel;

const float FORWARDS = 12.0;  // the power that tells how much edges of clouds are brighter ahead of the sun

// Where a line of sight enters a cloud: it steps on as far as it cannot miss one by what it lacks. Through the brim of a base it goes on,
// to what is behind.
Place entered(Way way) {
    Place place = place_on(way, 0.0);
    float lacks = CLOUD_BRIM - place.deep;
    for (int turn = 0; turn < CLOUD_TURNS && lacks > 0.0 && place.along < 1.0; turn++) {
        place = place_on(way, place.along + clamp(CLOUD_SAFE * lacks, CLOUD_STEPS.x, CLOUD_STEPS.y));
        lacks = -place.deep;
    }
    return place;
}

// How much thicker a cloud gets soon behind a place at which it is entered: its map and its billows are taken to bend down evenly.
float behind(Way way, Place place) {
    vec3 through = BLOCK * vec3(way.each.x, CLOUD_RISE / CLOUDS_SIDE, way.each.y);
    float rises = HEAPS_STEEPEST * dot(2.0 * place.map.yz - 1.0, way.each) - 2.0 * CLOUD_ROUND * place.along;
    float bow = CLOUD_ROUND + CLOUD_BOW * dot(way.each, way.each), most = clamp(0.5 * rises / bow, 0.0, CLOUD_BEHIND);
    float all = max(rises + CLOUD_BILLOWED * BILLOWS_STEEPEST * place.side * dot(2.0 * place.billow.yzw - 1.0, through), 0.0);
    return max(most * (rises - bow * most), CLOUD_SOLID.x + all * all / CLOUD_SOLID.y);
}

// How much of the sun's light comes to a place where a cloud is entered, of which it is so much deeper at its base than at its edge.
float sunny_at(Place place, float under) {
    float shades = under + CLOUD_UNDER * (1.0 - place.side) + dot(vec4(place.map.yz, place.along, 1.0), sun_over);
    shades += place.side * dot(vec4(place.billow.yzw, 1.0), sun_into) - CLOUD_OPEN * place.heap;
    return CLOUD_WITHIN + (1.0 - CLOUD_WITHIN) / (1.0 + exp(CLOUD_DEEPER * shades));
}

void main() {
    vec3 toward = normalize(ray);
    pixel = vec4(0.0);
    if (toward.y < CLOUDS_FADE.x)
        return;
    Way way = way_toward(toward);
    Place place = entered(way);
    if (place.deep <= 0.0)
        return;
    float thick = place.deep + behind(way, place);
    vec2 past = comes_through(vec2(CLOUD_COLUMN, CLOUD_COLUMN * CLOUD_STRAYS) * thick);
    float under = max(place.map.x - cloud_edge - CLOUD_ROUND * place.along * place.along, 0.0);
    float silver = CLOUD_SILVER * pow(max(0.5 + 0.5 * dot(toward, sun), 0.0), FORWARDS) * past.y;
    float lit = CLOUD_SUNLIT * sunny_at(place, under) + silver;
    float shaded = CLOUD_PALE + CLOUD_HIGHER * place.along - CLOUD_DARK * under + CLOUD_HEAPED * place.heap;
    float sides = clamp(1.0 + cloud_edge / CLOUD_OVERCAST, 0.0, 1.0);  // an overcast has none
    float hides = (1.0 - past.x) * smoothstep(CLOUDS_FADE.x, CLOUDS_FADE.y, toward.y), before_air = hides * (1.0 - CLOUD_AIR * sides);
    pixel = vec4(before_air * vec3(1.0, lit, shaded), hides);
}
