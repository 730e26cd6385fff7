// How leaves that lie in several ways look together.
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/normals.py"
#include "systems/trees/pigment.glsl"

uniform vec4 leaf_normals[NORMALS];  // as normals.py has it

// What is seen of leaves of which each lies another way.
struct Seen {
    vec3 sends;     // of the sun's light, in the mean
    float up;       // how far up they look, in the mean
    float darker;   // the mean of their colours as shown, of that of their mean radiance: a dark and a bright leaf together are darker
    float turns;    // how much brighter those are that turn to the sun as its card does, by how far they do
    vec3 faces;     // which way they lie in its picture, in the mean
};

// Those of what has these axes, a card or a tree, under this light on what looks up and on what looks down.
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
