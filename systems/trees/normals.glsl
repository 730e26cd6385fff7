// Mean look of leaves with many normals.
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/normals.py"
#include "systems/trees/pigment.glsl"

#ifdef OF_TREE
const int LIES = TREE_NORMALS;
uniform vec4 leaf_depths[LIES];   // optical depths of the leaves of each, as in normals.py
#else
const int LIES = NORMALS;
#endif
uniform vec4 leaf_normals[LIES];  // as in normals.py
uniform vec4 pictured_normal;        // their mean in a picture, and their area there

// What is seen of such leaves.
struct LeafMean {
    vec3 radiance;    // mean radiance under the sun
    float up;         // mean of the normals' y, towards the eye
    float darkening;  // mean of the displayed colours, relative to that of the mean radiance: a dark and a bright leaf together look darker
    float sun_gain;   // relative gain in brightness of leaves that face the sun, by how much they do
};

// Shares of leaves that lie so that are seen from a direction, and of these in the sun, both in the tree's own axes.
vec2 leaf_shares(int lie, vec3 to_eye, vec3 to_sun) {
#ifdef OF_TREE
    return vec2(sun_transmittance(leaf_depths[lie], to_eye, foliage), sun_transmittance(leaf_depths[lie], to_sun, foliage));
#else
    return vec2(1.0);
#endif
}

// Return that of a card or a tree with the axes `own`, under light from above and below. Brightness is linear in light, so it is summed
// up for each normal from that of a leaf under each light alone: the sun on either side, and the sky below and above.
LeafMean leaf_mean(mat3 own, vec3 ray, Light above, vec3 below) {
    vec3 to_sun = sun * own, to_eye = -ray * own, to_zenith = vec3(own[0].y, own[1].y, own[2].y), random_leaves = random_leaf_radiance(ray);
    vec3 pigment = pigment_of(0.5, 0.0, 0.0), albedo = pigment * pigment, in_sun = albedo * above.sun;
    float reflected = FACED * brightness(in_sun), transmitted = FACED * brightness(in_sun * TRANSMITTED), lit_area = 0.0;
    float from_below = 0.5 * brightness(albedo * below), from_above = 0.5 * brightness(albedo * above.sky), gain = from_above - from_below;
    float always = RANDOM_SHARE * brightness(in_sun * random_leaves) + brightness(above.haze) + from_below + from_above;
    float side = to_eye.z < 0.0 ? -1.0 : 1.0, visible = LEAST_PART, brightness_sum = 0.0;
    float sunny_area = 0.0, lit_more = 0.0;
    vec3 turned_area = vec3(0.0), brighter_side = 0.5 * (reflected - transmitted) * to_sun + gain * to_zenith;
    LeafMean leaves = LeafMean(vec3(0.0), 0.0, 0.0, 0.0);
    vec2 mean = vec2(side * dot(pictured_normal.xyz, to_sun), 0.0), spread = vec2(0.0);
    for (int each = 0; each < LIES; each++) {
        vec3 normal = leaf_normals[each].xyz;
        vec2 shares = leaf_shares(each, to_eye, to_sun);
        float to = dot(normal, to_eye), lit = dot(normal, to_sun), area = leaf_normals[each].w, part = area * normal.z;
        float facing = shares.x * area * to, sunny = shares.y * facing, differs = dot(normal, brighter_side);  // half by which one side is brighter than the other
        float bright = sqrt(0.5 * (reflected + transmitted) * abs(lit) + (to < 0.0 ? -differs : differs) + always);
        visible += abs(facing);
        turned_area += facing * normal;  // of the side that is seen
        sunny_area += abs(sunny);
        lit_area += abs(sunny * lit);
        lit_more += sunny * lit;  // area that is seen from the lit side, beyond that from the other one
        brightness_sum += abs(facing) * bright;
        mean.y += part * bright;
        spread += part * lit * vec2(lit, bright);
    }
    leaves.radiance = FACED * 0.5 / max(sunny_area, LEAST_PART) * (lit_area + lit_more + (lit_area - lit_more) * TRANSMITTED) + RANDOM_SHARE * random_leaves;
    leaves.up = dot(turned_area, to_zenith) / visible;
    mean.y /= pictured_normal.w;
    spread = spread * vec2(1.0, side) / pictured_normal.w - mean.x * mean;
    leaves.sun_gain = spread.y / (max(spread.x, LEAST_PART) * max(mean.y, LEAST_PART));
    vec3 all = albedo * (above.sun * leaves.radiance + mix(below, above.sky, 0.5 + 0.5 * leaves.up)) + above.haze;
    leaves.darkening = brightness_sum / (visible * sqrt(max(brightness(all), DARKEST)));
    return leaves;
}
