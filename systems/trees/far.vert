// A tree far off: a square that faces the eye, and shows it as its model is seen from there. With CAST it faces the sun, for the
// map of what trees leave of its light.
#include "systems/trees/tree.glsl"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/far.py"
#include "systems/trees/outline.py"
#include "systems/trees/shade.py"

in float columns;   // of a forest far off, how many trees stand side by side in its place
in float shows;     // how much of it is shown

uniform float column; // of its model: from one of those to the next [m]
uniform vec2 ball;  // of its model: how high its middle is, and half the side of its pictures [m]
#ifdef CAST
uniform vec4 tile;  // of the map: middle (across, up) [m], half the side [m], which one it is
uniform vec3 lawn_shade; // of its model: how far it shades grass [m]; leaves that light meets, times area [m²]; at its foot

flat out vec3 shades;  // how far it shades the grass, of the half side; leaves met in the middle; 1 in the map from above
flat out vec2 foot;    // how far its foot does; leaves met there
#else
uniform vec2 corners[OUTLINE];  // of what its pictures show, left and right in turn: across from -1 to 1, and up from 0 to 1
#endif

out vec2 on;
out vec3 seen_at;
flat out vec4 rows_of;     // columns and rows of the pictures that are mixed, first and second
flat out vec2 mixed;       // how much of the second
flat out vec4 sun_own;     // where the sun is in its own axes; how many of its leaves it has
flat out vec4 sunlit;      // what its leaves send of the sun's light; how many of them are still to be seen
flat out vec3 sunlit_wood; // what its wood sends of that
flat out vec3 skylit;
flat out vec3 hazy;
flat out vec3 below;
flat out float lit_by;
flat out vec2 sways;
flat out vec3 bends; // how far its top is bent aside, of its picture; where its foot is, and one over its height [m]
flat out vec4 row_told; // how many side by side; from one to the next, of a picture; level of its picture; what tells it from others

const vec2 MIXES = vec2(0.3, 0.7);  // between which parts of the way from one picture to the next they are mixed
const float ASKEW_ROWS = 2.0;  // by how much of an angle rows of trees are turned from one another: else all would be parallel [rad]
const float OVERHEAD = 0.999;  // sine of the elevation from which on a tree counts as seen from straight above

const float UPRIGHT_SENDS = 0.25;  // what an upright stem sends of level light from behind the eye, of what faces it, over half a turn [1/rad]

#ifdef CAST
// How large a pixel is there [m].
float pixel_at(vec3 place) {
    return 2.0 * tile.z / SHADE_SIDE;
}

vec2 corner_here(float texels) {
    return vec2(gl_VertexID % 2 == 1 ? 1.0 : -1.0, gl_VertexID % 4 > 1 ? 1.0 : -1.0);
}
#else
float pixel_at(vec3 place) {
    return (clip * vec4(place, 1.0)).w / pixels_a_metre();
}

// A corner of its outline, where a pixel is so many texels: as far out as what is there may spread. Rows of trees have none.
vec2 corner_here(float texels) {
    vec2 to = vec2(gl_VertexID % 2 == 1 ? 1.0 : -1.0, gl_VertexID < 2 ? -1.0 : gl_VertexID < OUTLINE - 2 ? 0.0 : 1.0);
    if (columns > 1.0)
        return vec2(to.x, gl_VertexID < 2 ? -1.0 : 1.0);
    vec2 corner = corners[gl_VertexID];
    return vec2(corner.x, 2.0 * corner.y - 1.0) + to * (2.0 * texels / float(SIDE));
}

// What white wood sends to the eye of the sun's light: the mean over the side of an upright stem that is seen.
float wood_sends(vec3 ray) {
    float level = length(sun.xz), apart = acos(clamp(-dot(ray.xz, sun.xz) / max(length(ray.xz) * level, LEAST_PART), -1.0, 1.0));
    return SENDS * level * UPRIGHT_SENDS * (sin(apart) + (0.5 * AROUND - apart) * cos(apart));
}
#endif

// Which pictures show it from a direction of its own axes.
void choose(vec3 from) {
    float column = atan(from.x, from.z) / AROUND * float(COLUMNS);
    column = column < 0.0 ? column + float(COLUMNS) : column;
    float up = asin(clamp(from.y, -1.0, 1.0)), row = clamp((up - FIRST_ROW) / EACH_ROW, 0.0, float(ROWS) - 1.0 - LEAST_PART);
    vec2 first = floor(vec2(column, row)), part = vec2(column, row) - first;
    rows_of = vec4(mod(first.x, float(COLUMNS)), first.y, mod(first.x + 1.0, float(COLUMNS)), first.y + 1.0);
    mixed = smoothstep(MIXES.x, MIXES.y, part);
}

#ifndef CAST
// Where a corner is in the picture that lies so far under the ground. Its crown is nearer to the eye than the square, whose lower part
// the ground would hide from above: so is the depth of that corner, as far as over the ground, or the crown's front.
vec4 over_ground(float under, float front) {
    vec4 at = clip * vec4(seen_at, 1.0);
    vec3 ray = normalize(eye - seen_at);
    vec4 nearer = clip * vec4(seen_at + ray * clamp(under / max(ray.y, LEAST_PART), 0.0, front), 1.0);
    return vec4(at.xy, nearer.z / nearer.w * at.w, at.w);
}
#endif

void main() {
    vec3 middle_of = root + vec3(0.0, scale * ball.x, 0.0), to = eye - middle_of;
#ifdef CAST
    bool from_above = tile.w > 1.0;
    to = from_above ? vec3(0.0, 1.0, 0.0) : sun;
#endif
    to = normalize(to);
    choose(turned_back(to));
    vec3 across = normalize(abs(to.y) > OVERHEAD ? vec3(turn.x, 0.0, turn.y) : vec3(to.z, 0.0, -to.x)), up = cross(to, across);
    float half_side = scale * ball.y, texels = float(SIDE) * pixel_at(middle_of) / (2.0 * half_side);
    on = corner_here(max(texels, 1.0));
    if (columns > 1.0) {
        float askew = ASKEW_ROWS * (phase - 0.5);
        across = cos(askew) * across + sin(askew) * cross(across, vec3(0.0, 1.0, 0.0));
    }
    float half_wide = columns > 1.0 ? 0.5 * columns * column * scale : half_side;
    seen_at = middle_of + half_wide * on.x * across + half_side * on.y * up;
    row_told = vec4(columns, 0.5 * column / ball.y, max(log2(max(texels, LEAST_PART)) + (columns > 1.0 ? 0.0 : FINER_BY), 0.0), phase);
    sun_own = vec4(turned_back(sun), foliage);
    lit_by = phase;
#ifdef CAST
    sunlit = vec4(0.0);
    skylit = hazy = below = sunlit_wood = vec3(0.0);
    sways = vec2(0.0);
    bends = vec3(0.0);
    float reach = max(scale * lawn_shade.x, LEAST_SHADE);
    shades = vec3(reach / half_side, foliage * lawn_shade.y * scale * scale / (reach * reach), float(from_above));
    foot = vec2(TRUNK_FOOT / half_side, foliage * min(lawn_shade.z * scale, FOOT_MEETS_MOST));
    if (from_above) {  // grass is shaded beyond the picture, too
        on *= max(shades.x, 1.0);
        seen_at = middle_of + half_side * (on.x * across + on.y * up);
    }
    vec3 right = from_above ? vec3(1.0, 0.0, 0.0) : trees_across, over = from_above ? vec3(0.0, 0.0, 1.0) : trees_up;
    vec2 at = (vec2(dot(seen_at, right), dot(seen_at, over)) - tile.xy) / tile.z;
    seen_at = middle_of;
    gl_Position = vec4(at, 0.0, 1.0);
#else
    if (gone * shows <= 0.0) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    float under = root.y - seen_at.y;
    if (columns > 1.0)
        seen_at.y += height_at(seen_at.xz) - root.y;  // a row of trees goes up and down with the ground
    vec2 aside = trunk_sways(message);
    bends = vec3(columns > 1.0 ? 0.0 : 0.5 * dot(aside, across.xz) * tall * scale / half_side, root.y, 1.0 / (tall * scale));
    seen_at.xz += aside * (seen_at.y - root.y);  // its corners go along a line, and pixels from that to the trunk's
    sways = vec2(dot(message, across.xz), length(message)) * LIMB_SWINGS;
    // The crown is asked for its light in the middle of its sunny side.
    Light light = light_in_crown(middle_of, vec4(0.0), 1.0);
    vec3 ray = -to;
    sunlit = vec4(light.sun * strewn_send(ray), gone * shows);
    sunlit_wood = light.sun * wood_sends(ray);
    skylit = light.sky;
    hazy = light.haze;
    below = from_below() * (1.0 - haze_at(middle_of));
    gl_Position = over_ground(under, half_side);
#endif
}
