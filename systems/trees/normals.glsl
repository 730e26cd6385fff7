// Mean look of leaves with many normals.
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/normals.py"
#include "systems/trees/pigment.glsl"

uniform vec4 leaf_normals[NORMALS];  // as in normals.py

// What is seen of such leaves.
struct Seen {
    vec3 sends;     // mean radiance under the sun
    float up;       // mean of the normals' y, towards the eye
    float darker;   // mean of the displayed colours, of that of the mean radiance: a dark and a bright leaf together look darker
    float turns;    // relative gain in brightness of leaves that face the sun, by how much they do
    vec3 faces;     // mean normal in its picture
};

// Return that of a card or a tree with the axes `own`, under light from above and below.
Seen seen_of(mat3 own, vec3 ray, Light above, vec3 below) {
    vec3 to_sun = sun * own, to_eye = -ray * own, strewn = strewn_send(ray), pigment = pigment_of(0.5, 0.0, 0.0), albedo = pigment * pigment;
    float side = to_eye.z < 0.0 ? -1.0 : 1.0, shown = LEAST_PART, pictured = LEAST_PART, root_of = 0.0;
    Seen seen = Seen(vec3(0.0), 0.0, 0.0, 0.0, vec3(0.0));
    vec2 mean = vec2(0.0), spread = vec2(0.0);
    for (int each = 0; each < NORMALS; each++) {
        vec3 normal = leaf_normals[each].xyz;
        float to = dot(normal, to_eye), lit = dot(normal, to_sun), shows = leaf_normals[each].w * abs(to), part = leaf_normals[each].w * normal.z;
        vec3 sends = leaf_sends(lit * sign(to), strewn);
        float up = (own * normal).y * sign(to);
        float bright = sqrt(brightness(albedo * (above.sun * sends + mix(below, above.sky, 0.5 + 0.5 * up)) + above.haze));
        shown += shows;
        seen.sends += shows * sends;
        seen.up += shows * up;
        root_of += shows * bright;
        pictured += part;
        seen.faces += part * normal;
        mean += part * vec2(side * lit, bright);
        spread += part * side * lit * vec2(side * lit, bright);
    }
    seen.sends /= shown;
    seen.up /= shown;
    seen.faces /= pictured;
    mean /= pictured;
    spread = spread / pictured - mean.x * mean;
    seen.turns = spread.y / (max(spread.x, LEAST_PART) * max(mean.y, LEAST_PART));
    vec3 all = albedo * (above.sun * seen.sends + mix(below, above.sky, 0.5 + 0.5 * seen.up)) + above.haze;
    seen.darker = root_of / (shown * sqrt(max(brightness(all), DARKEST)));
    return seen;
}
