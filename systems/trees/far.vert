// A tree far off: a square that faces the eye, and shows it as its model is seen from there. With CAST it faces the sun, for the
// map of what trees leave of its light.
#include "systems/trees/tree.glsl"
#include "systems/trees/far.py"

uniform vec2 ball;  // of its model: how high its middle is, and half the side of its pictures [m]
#ifdef CAST
uniform vec4 tile;  // of the map: middle (across, up) [m], half the side [m], which one it is
#endif

out vec2 on;
out vec3 seen_at;
flat out vec4 rows_of;     // columns and rows of the pictures that are mixed, first and second
flat out vec2 mixed;       // how much of the second
flat out vec4 sun_own;     // where the sun is in its own axes; how many of its leaves it has
flat out vec4 sunlit;      // and how many of its leaves are still to be seen
flat out vec3 skylit;
flat out vec3 hazy;
flat out vec3 below;
flat out float lit_by;
flat out vec2 sways;

const vec2 MIXES = vec2(0.3, 0.7);  // between which parts of the way from one picture to the next they are mixed
const float OVERHEAD = 0.999;  // sine of the elevation from which on a tree counts as seen from straight above

vec2 corner_here() {
    return vec2(gl_VertexID % 2 == 1 ? 1.0 : -1.0, gl_VertexID % 4 > 1 ? 1.0 : -1.0);
}

// Which pictures show it from a direction of its own axes.
void choose(vec3 from) {
    float column = atan(from.x, from.z) / AROUND * float(COLUMNS);
    column = column < 0.0 ? column + float(COLUMNS) : column;
    float up = asin(clamp(from.y, -1.0, 1.0)), row = clamp((up - FIRST_ROW) / EACH_ROW, 0.0, float(ROWS) - 1.0 - LEAST_PART);
    vec2 first = floor(vec2(column, row)), part = vec2(column, row) - first;
    rows_of = vec4(mod(first.x, float(COLUMNS)), first.y, mod(first.x + 1.0, float(COLUMNS)), first.y + 1.0);
    mixed = smoothstep(MIXES.x, MIXES.y, part);
}

void main() {
    vec3 middle_of = root + vec3(0.0, scale * ball.x, 0.0), to = eye - middle_of;
#ifdef CAST
    bool from_above = tile.w > 1.0;
    to = from_above ? vec3(0.0, 1.0, 0.0) : sun;
#endif
    to = normalize(to);
    choose(turned_back(to));
    vec3 across = normalize(abs(to.y) > OVERHEAD ? vec3(turn.x, 0.0, turn.y) : vec3(to.z, 0.0, -to.x)), up = cross(to, across);
    on = corner_here();
    float half_side = scale * ball.y;
    seen_at = middle_of + half_side * (on.x * across + on.y * up);
    sun_own = vec4(turned_back(sun), foliage);
    lit_by = phase;
#ifdef CAST
    sunlit = vec4(0.0);
    skylit = hazy = below = vec3(0.0);
    sways = vec2(0.0);
    vec3 right = from_above ? vec3(1.0, 0.0, 0.0) : trees_across, over = from_above ? vec3(0.0, 0.0, 1.0) : trees_up;
    vec2 at = (vec2(dot(seen_at, right), dot(seen_at, over)) - tile.xy) / tile.z;
    seen_at = middle_of;
    gl_Position = vec4(at, 0.0, 1.0);
#else
    if (gone <= 0.0) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    seen_at.xz += trunk_bends((seen_at.y - root.y) / (tall * scale), tall * scale, message);
    sways = vec2(dot(message, across.xz), length(message)) * LIMB_SWINGS;
    // The crown is asked for its light in the middle of its sunny side.
    Light light = light_in_crown(middle_of, vec4(0.0), 1.0);
    sunlit = vec4(light.sun, gone);
    skylit = light.sky;
    hazy = light.haze;
    below = from_below() * (1.0 - haze_at(middle_of));
    gl_Position = clip * vec4(seen_at, 1.0);
#endif
}
