// A tree far off: the picture of its model from the eye's direction. With CAST it is seen from the sun, for the shade maps.
#include "systems/trees/tree.glsl"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/behind.glsl"
#include "systems/trees/far.py"
#include "systems/trees/packed.glsl"
#include "systems/trees/outline.py"
#include "systems/trees/shade.py"
#ifndef CAST
#define OF_TREE
#include "systems/trees/normals.glsl"
#endif

#if defined(IN_ROWS) || defined(CAST)
in float columns; // number of trees in the row that it stands for
#else
const float columns = 1.0;  // no tree stands for more, or IN_ROWS would be defined
#endif
in float opacity; // by its ring

uniform float lines; // height of its model's pictures [texels]
#ifdef CAST
uniform vec4 tile;        // of the map: middle (across, up) [m], half the side [m], index
uniform vec3 grass_shade; // of its model: radius of its shade on grass [m]; optical depth times squared radius [m²]; depth at its foot
#else
uniform vec4 high;                        // heights of its outline's corners, -1 to 1, from foot to top
uniform vec4 reaches[2 * COLUMNS * ROWS]; // by picture: distances of the corners left and right, of half their height
#endif
#define PASSED out
#include "systems/trees/far.glsl"

const vec2 MIXES = vec2(0.3, 0.7);  // parts of the angle from one picture to the next between which they are mixed
const float ASKEW_ROWS = 2.0;  // range of the yaws of rows of trees: else all would be parallel [rad]
const float OVERHEAD = 0.999;  // sine of the elevation from which on a tree counts as seen from straight above

const vec2 SHIMMER_HERTZ = vec2(1.7, 1.3);  // frequencies of limbs along and across a picture [Hz]
const float CLUMP_CHANGE = 0.25;  // part of the angle from one picture to the next over which a clump of leaves gives way
const float CHANGE_PER_LEVEL = 2.0;      // growth of that part with each mip level, until a pixel is many clumps
const float PLAINER = 2.0;     // loss of bark's detail with each coarser level, which is read sharper than pixels are,
const float PLAIN_FROM = 0.5;  // from this level on: there, pictures have 180 texels up
const float SHIMMER = 0.12;  // apparent amplitude of limbs, relative to their own, on a picture
const float UPRIGHT_RADIANCE = 0.25;  // radiance of an upright stem under level light from behind the eye, per half turn of its side [1/rad]

#ifdef CAST
// Size of a pixel there [m].
float pixel_size(vec3 place) {
    return 2.0 * tile.z / SHADE_SIDE;
}

vec2 corner_offset(ivec4 pictures, float texels) {
    return vec2(gl_VertexID % 2 == 1 ? 1.0 : -1.0, gl_VertexID % 4 > 1 ? 1.0 : -1.0);
}
#else
float pixel_size(vec3 place) {
    return (clip * vec4(place, 1.0)).w / pixels_per_metre();
}

// Distance of a corner that encloses all these pictures.
float reach_of(ivec4 pictures, int side, int corner) {
    vec4 lower = max(reaches[2 * pictures.x + side], reaches[2 * pictures.y + side]);
    return max(lower, max(reaches[2 * pictures.z + side], reaches[2 * pictures.w + side]))[corner];
}

const float SPREADS = 2.0;  // spread of a coarser picture [texels], and in pixels
const float LEANS_OFF = 0.2;  // greatest distance of a bent trunk from a line to its top, relative to the top's displacement: at 0.42 of its height

// A corner of its outline, where a pixel is so many texels, widened by mip levels and the wind. Rows of trees have none.
vec2 corner_offset(ivec4 pictures, float texels) {
    int side = gl_VertexID % 2, corner = gl_VertexID / 2;
    vec2 to = vec2(side == 1 ? 1.0 : -1.0, corner == 0 ? -1.0 : corner < OUTLINE / 2 - 1 ? 0.0 : 1.0);
    if (columns > 1.0)
        return vec2(to.x, corner == 0 ? -1.0 : 1.0);
    float moved = motion.y + LEANS_OFF * abs(motion.z);
    return vec2(to.x * (reach_of(pictures, side, corner) + 2.0 * moved), high[corner]) + to * (SPREADS * 2.0 * texels / lines);
}

// Radiance of white wood under the sun: the mean over the visible side of an upright stem.
float wood_radiance(vec3 ray) {
    float level = length(sun.xz), apart = acos(clamp(-dot(ray.xz, sun.xz) / max(length(ray.xz) * level, LEAST_PART), -1.0, 1.0));
    return FACE_GAIN * level * UPRIGHT_RADIANCE * (sin(apart) + (0.5 * AROUND - apart) * cos(apart));
}
#endif

// Choose the pictures that show it from a direction in its own axes; return those mixed, perhaps one of them several times.
ivec4 choose_pictures(vec3 from) {
    float column = atan(from.x, from.z) / AROUND * float(COLUMNS);
    column = column < 0.0 ? column + float(COLUMNS) : column;
    float up = asin(clamp(from.y, -1.0, 1.0)), row = clamp((up - FIRST_ROW) / EACH_ROW, 0.0, float(ROWS) - 1.0 - LEAST_PART);
    vec2 first = floor(vec2(column, row)), part = vec2(column, row) - first;
    first.x = mod(first.x, float(COLUMNS));
    vec2 second = vec2(mod(first.x + 1.0, float(COLUMNS)), first.y + 1.0);
    tile_corners = vec4(first, second) / vec2(COLUMNS, ROWS).xyxy;
    mix_shares = smoothstep(MIXES.x, MIXES.y, part);
    ivec2 end = ivec2(mix(first, second, greaterThan(mix_shares, vec2(0.0))));
    ivec2 begin = ivec2(mix(first, second, greaterThanEqual(mix_shares, vec2(1.0))));
    return ivec4(begin.x, end.x, begin.x, end.x) + COLUMNS * ivec4(begin.y, begin.y, end.y, end.y);
}

#ifndef CAST
// Clip position of a corner that lies `under` the ground. The crown is nearer to the eye than the picture's square, whose lower part
// the ground would hide from above: so the corner's depth is as far as that of a place over the ground, or the crown's front. Seen
// flatter, it is less: seen level, the lowest part is the trunk's foot, which grass in front hides.
vec4 over_ground(vec3 seen_at, float under, float front) {
    vec4 at = clip * vec4(seen_at, 1.0);
    vec3 ray = normalize(eye - seen_at);
    float steep = max(ray.y, LEAST_PART);
    vec4 nearer = clip * vec4(seen_at + ray * clamp(under / steep, 0.0, front * steep), 1.0);
    return vec4(at.xy, nearer.z / nearer.w * at.w, at.w);
}

// Write what is constant over its pixels.
void write_flat() {
    float way = CLUMP_CHANGE + CLUMP_CHANGE * CHANGE_PER_LEVEL * motion.w;
    clump_progress = vec3((1.0 + way) * mix_shares, 1.0) / way;
    limb_phases = AROUND * (SHIMMER_HERTZ * moment + motion.x) + vec2(0.0, 1.0);
    finer_texel = 1.0 / (texel_side * lines);
    rugged = 1.0 / (1.0 + PLAINER * max(motion.w - PLAIN_FROM, 0.0));
    picture_texels = lines * vec2(1.0 / aspect, 1.0);
    old_pigment = old_bark_mean();
    grass_scale = tall * scale / grass_about.x;
    on.xy = 0.5 + 0.5 * vec2(columns > 1.0 ? 1.0 : aspect, 1.0) * on.xy;
}

// Write the light on it past other trees: more at the top of its crown.
void write_light(vec3 place, vec3 ray) {
    Light light = light_in_crown(vec3(place.x, max(place.y, root.y), place.z), vec4(0.0), 1.0);
    sun_weights = depth_weights(to_model(sun), foliage);
    ray_weights = depth_weights(to_model(ray), 1.0);
    below = light_from_grass * (1.0 - haze_opacity(place));
    LeafMean leaves = leaf_mean(mat3(to_world(vec3(1.0, 0.0, 0.0)), vec3(0.0, 1.0, 0.0), to_world(vec3(0.0, 0.0, 1.0))), ray, light, below);
    sun_radiance = vec4(light.sun * leaves.radiance, far_fade * opacity);
    wood_gain = vec4(light.sun * wood_radiance(ray) - sun_radiance.rgb, THICKEST * scale);
    sky_radiance = vec4(light.sky, leaves.up);
    haze_colour = light.haze;
}
#else
// Write its place in the map.
void write_cast(vec3 middle_of, vec3 across, vec3 up, float half_tall) {
    bool from_above = tile.w > 1.0;
    float reach = max(scale * grass_shade.x, LEAST_SHADE);
    cast_shade = vec4(reach / half_tall, foliage * grass_shade.y * scale * scale / (reach * reach), float(from_above), dot(middle_of, sun));
    foot_shade = vec3(TRUNK_FOOT / half_tall, foliage * min(grass_shade.z * scale, FOOT_MEETS_MOST), foliage);
    on *= from_above ? max(cast_shade.x, 1.0) : 1.0;  // grass is shaded beyond the picture, too
    vec3 seen_at = middle_of + half_tall * (on.x * across + on.y * up);
    vec3 right = from_above ? vec3(1.0, 0.0, 0.0) : trees_across, over = from_above ? vec3(0.0, 0.0, 1.0) : trees_up;
    gl_Position = vec4((vec2(dot(seen_at, right), dot(seen_at, over)) - tile.xy) / tile.z, 0.0, 1.0);
}
#endif

void main() {
    vec3 middle_of = root + vec3(0.0, scale * picture_span.x, 0.0), to = eye - middle_of;
#ifdef CAST
    to = tile.w > 1.0 ? vec3(0.0, 1.0, 0.0) : sun;
#endif
    to = normalize(to);
    ivec4 pictures = choose_pictures(to_model(to));
    vec3 across = normalize(abs(to.y) > OVERHEAD ? vec3(turn.x, 0.0, turn.y) : vec3(to.z, 0.0, -to.x)), up = cross(to, across);
    float half_tall = scale * picture_span.y, texels = lines * pixel_size(middle_of) / (2.0 * half_tall);
    motion = vec4(phase, 0.0, 0.0, max(log2(max(texels, LEAST_PART)) + (columns > 1.0 ? 0.0 : LEVEL_BIAS), 0.0));
#ifdef CAST
    motion.w += CAST_LEVEL_BIAS;
#else
    motion.y = SHIMMER * LIMB_SWINGS * length(message);
    motion.z = columns > 1.0 ? 0.0 : 0.5 * dot(trunk_sway, across.xz) * tall * scale / half_tall;
#endif
    on = vec3(corner_offset(pictures, max(texels, 1.0)), 0.0);
    if (columns > 1.0) {
        float askew = ASKEW_ROWS * (phase - 0.5);
        across = cos(askew) * across + sin(askew) * cross(across, vec3(0.0, 1.0, 0.0));
    }
    float half_wide = columns > 1.0 ? 0.5 * columns * column * scale : half_tall;
    vec3 seen_at = middle_of + half_wide * on.x * across + half_tall * on.y * up;
    row_of_trees = vec2(columns, 0.5 * aspect * column / picture_span.y);
    texel_side = exp2(min(ceil(motion.w), float(LEVELS) - 1.0)) / lines;
#ifdef CAST
    write_cast(middle_of, across, up, half_tall);
#else
    if (far_fade * opacity <= 0.0) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    float under = root.y - seen_at.y;
    vec3 lit_at = mix(middle_of + half_tall * on.y * up, seen_at, 0.5);
    if (columns > 1.0)
        seen_at.y += height_at(seen_at.xz) - root.y;  // a row of trees follows the ground
    on.z = (seen_at.y - root.y) / (tall * scale);
    seen_at.xz += trunk_sway * (seen_at.y - root.y);  // corners are displaced linearly, and pixels from there to the trunk's curve
    write_light(lit_at, -to);
    write_flat();
    gl_Position = just_behind(over_ground(seen_at, under, half_tall));
#endif
}
