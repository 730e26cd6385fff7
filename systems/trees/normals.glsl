// Mean look of leaves with many normals.
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/normals.py"
#include "systems/trees/pigment.glsl"

uniform vec4 leaf_normals[NORMALS];  // as in normals.py

// What is seen of such leaves.
struct LeafMean {
    vec3 radiance;    // mean radiance under the sun
    float up;         // mean of the normals' y, towards the eye
    float darkening;  // mean of the displayed colours, relative to that of the mean radiance: a dark and a bright leaf together look darker
    float sun_gain;   // relative gain in brightness of leaves that face the sun, by how much they do
    vec3 normal_mean; // mean normal in its picture
};

// Return that of a card or a tree with the axes `own`, under light from above and below.
LeafMean leaf_mean(mat3 own, vec3 ray, Light above, vec3 below) {
    vec3 to_sun = sun * own, to_eye = -ray * own, random_leaves = random_leaf_radiance(ray);
    vec3 pigment = pigment_of(0.5, 0.0, 0.0), albedo = pigment * pigment;
    float side = to_eye.z < 0.0 ? -1.0 : 1.0, visible = LEAST_PART, picture_area = LEAST_PART, brightness_sum = 0.0;
    LeafMean leaves = LeafMean(vec3(0.0), 0.0, 0.0, 0.0, vec3(0.0));
    vec2 mean = vec2(0.0), spread = vec2(0.0);
    for (int each = 0; each < NORMALS; each++) {
        vec3 normal = leaf_normals[each].xyz;
        float to = dot(normal, to_eye), lit = dot(normal, to_sun), area = leaf_normals[each].w, facing = area * abs(to), part = area * normal.z;
        vec3 radiance = leaf_radiance(lit * sign(to), random_leaves);
        float up = (own * normal).y * sign(to);
        float bright = sqrt(brightness(albedo * (above.sun * radiance + mix(below, above.sky, 0.5 + 0.5 * up)) + above.haze));
        visible += facing;
        leaves.radiance += facing * radiance;
        leaves.up += facing * up;
        brightness_sum += facing * bright;
        picture_area += part;
        leaves.normal_mean += part * normal;
        mean += part * vec2(side * lit, bright);
        spread += part * side * lit * vec2(side * lit, bright);
    }
    leaves.radiance /= visible;
    leaves.up /= visible;
    leaves.normal_mean /= picture_area;
    mean /= picture_area;
    spread = spread / picture_area - mean.x * mean;
    leaves.sun_gain = spread.y / (max(spread.x, LEAST_PART) * max(mean.y, LEAST_PART));
    vec3 all = albedo * (above.sun * leaves.radiance + mix(below, above.sky, 0.5 + 0.5 * leaves.up)) + above.haze;
    leaves.darkening = brightness_sum / (visible * sqrt(max(brightness(all), DARKEST)));
    return leaves;
}
