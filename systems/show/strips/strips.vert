// One instance is one polygon strip between two vertical edges, as many quads high as its ring asks for.
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "lib/received.glsl"
#include "lib/stack.glsl"
#include "systems/show/strips/sublevel.py"

uniform usampler2D strips;  // by place in the queue: the polygon strip that is drawn
uniform sampler2D stood;    // by patch: STOOD
uniform sampler2D extents;  // by column and layer: where paint begins and ends across the column, and up to where
uniform int first;
uniform int most;           // numbers of polygon strips that are set aside for a patch

uniform ByKind tall;        // by kind: height of the strips [m]
uniform ByKind margin;      // by kind: how far strips reach beyond their patch [m]
uniform vec3 pictures[RINGS * KINDS];    // how far each reaches across its layer of the texture, and up; the first layer
uniform ivec4 stacks[RINGS];             // by ring: columns of a strip, sections of a column, strips of a kind on a patch

out vec2 at;
flat out vec3 foot_color;  // pigment
flat out vec3 rise_color;
flat out vec3 mean_face;   // its pigment, of that where it faces all ways alike
flat out vec3 grain_cos;   // change of pigment with the cosine of twice the normal's azimuth
flat out vec3 grain_sin;
out float h;            // height in the canopy
flat out mat4 lit;     // light on it, bundled; layer of the texture, level of its mip-maps, factor on coverage
flat out float shown;
flat out vec4 shadow; // of a body: the square of how near the sun's ray comes to it, by powers of `on_column`; how soft its edge is
out float on_column;  // from an edge of the column to the other
#ifdef MOWN
out vec3 roots;        // place on the ground (x, z), and how high over it in calm air [m]
#if KINDS > 4
ByKind leaf_area;      // pixels find out themselves
#else
flat out ByKind leaf_area;// by kind, of the ground's
#endif
flat out int stood_of; // kind
flat out float fine_at;// pixels that a metre is long
flat out int is_cut;   // whether anything is, about its column
flat out float rows_at;// height of grass below which strips would show as rows [m]
#endif
#ifdef THIN
out float grows;
flat out vec2 stays;
flat out float sharp;

const float UNHURRIED = 0.15;  // part of all ranks that change their sub-level at a time: one by one, blades would flicker

// How much of a texel stays where its kind grows thinly, and where only blades of some ranks show: the others go, over a
// span of ranks that is narrow where a texel is one blade, and wide where a pixel is the mean of many.
void thin(float dense, float below, float texels) {
    float soft = clamp(0.35 * log2(max(texels, 1.0)), 0.06, 1.0);
    sharp = 1.0 / soft;
    grows = (dense > 0.995 ? 1.0 : dense - 0.5 * soft) * sharp + 1.0;
    // The span must reach from below all ranks to above them, softness included.
    float span = max(soft, UNHURRIED), edge = mix(-0.5 * span, 1.0 + 0.5 * span, abs(below));
    stays = vec2(-1.0, edge) / span + vec2(0.0, 0.5);
    if (below < 0.0)
        stays = vec2(0.0, 1.0) - stays;
}
#endif

const float SHARPER = 0.15;  // how much finer texels are than pixels, in levels: blades would be washed out
const float NARROWEST = 0.25;  // blades count as no closer together than this part of how far apart they are painted

// From the side, blades that lie show the middles of their arches on top, where strips show their tips: how much less of their
// tips that is where all lie, on strips of one section. Those of more sections are bent to arches themselves. The steeper the
// line of sight, the less of it is seen.
const float ARCHED = 0.42;

// Pixels that a metre is long on the screen, across the line of sight.
float pixels_at(vec3 place) {
    vec4 up = vec4(clip[0][1], clip[1][1], clip[2][1], 0.0);
    return screen.y * length(up) / max(dot(vec4(clip[0][3], clip[1][3], clip[2][3], clip[3][3]), vec4(place, 1.0)), 0.1);
}

// Where a way that begins at a point leads on the screen [pixel].
vec2 on_screen(vec4 from, vec3 way) {
    vec4 to = clip * vec4(way, 0.0);
    return (to.xy * from.w - from.xy * to.w) * screen.xy / max(from.w * from.w, 0.01);
}

// Pixels that two blades of a strip are apart on the screen that are painted a metre apart, as the wind has bent them: the
// more they lie, the closer they are.
float apart_at(vec3 middle, vec2 run, vec3 stem) {
    vec4 from = clip * vec4(middle, 1.0);
    vec2 beside = on_screen(from, vec3(run.x, 0.0, run.y)), along = on_screen(from, stem);
    float between = abs(beside.x * along.y - beside.y * along.x) / max(length(along), 1e-6);
    return max(max(between, NARROWEST * length(beside)), 1e-3);
}

// Where a point of an edge is, `t` of the way up its section's quads, and its height in the canopy.
vec4 on_edge(vec3 foot, vec2 bend, vec2 back, float t, int k, float sections, float growth) {
    float low = min(floor(t * sections), sections - 1.0), variant = float(k) * field.w;
    vec3 from = posture(variant, bend, low / sections).place, to = posture(variant, bend, (low + 1.0) / sections).place;
    vec3 spine = mix(from, to, t * sections - low) * OF(tall, k);
    return vec4(foot + spine * growth + t * vec3(back.x, 0.0, back.y), spine.y / (OF(crown, k) * lodged(bend)));
}

// The body whose shadow comes nearest to a column between two places; none is -1. Where it ends, pixels find out.
int shading(vec3 a, vec3 b) {
    int nearest = -1;
    float least = 9.0;  // from three radii on, nothing is shaded
    shadow = vec4(least, 0.0, 0.0, 1.0);
    for (int body = 0; body < SHADES && shades[body].w > 0.0; body++) {
        vec4 from = ray_by(body, a), to = ray_by(body, b);
        vec3 way = to.xyz - from.xyz, near = vec3(dot(from.xyz, from.xyz), 2.0 * dot(from.xyz, way), dot(way, way));
        float at = clamp(-0.5 * near.y / max(near.z, 1e-6), 0.0, 1.0), nearness = near.x + at * (near.y + at * near.z);
        if (nearness < least) {
            least = nearness;
            nearest = body;
            shadow = vec4(near, 0.5 * (from.w + to.w));
        }
    }
    return nearest;
}

void main() {
    int queued = first + gl_InstanceID;
    int number = int(texelFetch(strips, ivec2(queued % STRIPS_ROW, queued / STRIPS_ROW), 0).r);
    int patch_number = number / most, own_number = number % most;
    ivec2 at_patch = ivec2(patch_number % STOOD_ROW * 2, patch_number / STOOD_ROW);
    vec4 where = texelFetch(stood, at_patch, 0), how = texelFetch(stood, at_patch + ivec2(1, 0), 0);
    int stand = int(where.w), turn = stand % 4, along = stand / 4 % 2, ring = stand / 16, own = (along + turn) % 2;
    ivec4 fine = stacks[ring];
    int column = own_number % fine.x, walked = own_number / fine.x / KINDS, count = fine.z;
    int stack = stand / 8 % 2 == 1 ? count - 1 - walked : walked;
    // Strips of several kinds share a plane: each kind comes to lie in front as often as behind.
    int k = (own_number / fine.x + stack) % KINDS, plane = stacked(stack, count, own, along, turn);
    int receiver = int(how.w) + (k * count + stack) * (fine.x + 1) + column;
    vec4 told_a = received_by(receiver), told_b = received_by(receiver + 1);
    vec2 foot_a = edge_foot(where.xy, turn, own, plane, count, column, fine.x, OF(margin, k));
    vec2 foot_b = edge_foot(where.xy, turn, own, plane, count, column + 1, fine.x, OF(margin, k));
    vec2 way = foot_b - foot_a, run = normalize(way);
    // Light is asked for where its blades are rooted, in the mean.
    vec3 rooted_a = vec3(foot_a.x, told_a.z, foot_a.y), rooted_b = vec3(foot_b.x, told_b.z, foot_b.y);
    vec3 rooted = 0.5 * (rooted_a + rooted_b), a = put_nearer(rooted_a, run, count), b = put_nearer(rooted_b, run, count);

    vec3 picture = pictures[ring * KINDS + k];
    int layer = int(picture.z) + (int(where.z) * 2 + own) * count + plane;
    vec3 middle = 0.5 * (a + b);
    // Nothing is drawn where nothing is painted: a strip ends a pixel beyond its paint.
    vec4 extent = texelFetch(extents, ivec2(column, layer), 0);
    float pixels = pixels_at(middle), beside = 1.0 / (pixels * distance(a.xz, b.xz));
    float across = (gl_VertexID & 1) == 1 ? min(extent.y + beside, 1.0) : max(extent.x - beside, 0.0);
    float t = min(float(gl_VertexID / 2) / float(fine.y), min(extent.z + 1.0 / (pixels * OF(tall, k)), 1.0));
    vec2 bend_a = bending(k, told_a.xy), bend_b = bending(k, told_b.xy);
    float sections = float(fine.y), variant = float(k) * field.w, height = OF(tall, k) * how.y;
    vec3 top_a = posture(variant, bend_a, 1.0).place * height, top_b = posture(variant, bend_b, 1.0).place * height;
    vec2 back_a = laid_back(way, a, top_a, height, count), back_b = laid_back(way, b, top_b, height, count);
    vec3 top = 0.5 * (top_a + top_b);
    vec4 point = mix(on_edge(a, bend_a, back_a, t, k, sections, how.y), on_edge(b, bend_b, back_b, t, k, sections, how.y), across);
    gl_Position = clip * vec4(point.xyz, 1.0);
    at = vec2((float(column) + across) / float(fine.x), t) * picture.xy;
    Lie lies = lie_at(rooted.xz);
    ByKind grows = grows_at(rooted.xz);
    on_column = across;
    int body = shading(rooted_a, rooted_b);
    float seen = sun_past(rooted, lies.past) * past_bodies(rooted, body);
    Light light = veiled(light_on(k, 0.5 * (bend_a + bend_b), rooted, lies, grows, seen), middle);
#ifdef MOWN
    roots = vec3(mix(rooted_a.xz, rooted_b.xz, across), t * OF(tall, k));
    leaf_area = areas(grows);
    stood_of = k;
    fine_at = pixels;
    rows_at = CROSSED * soil.w / float(count) * abs(eye.y - middle.y) / max(distance(middle.xz, eye.xz), 0.5 * soil.w);
    is_cut = left_about(rooted.xz, 2.0 * distance(a.xz, b.xz)) < 0.999 * zenith.w ? 1 : 0;
#endif
    h = point.w;
    vec3 dry = stretch(lies.slow);
    mean_face = faced(k, run, middle, top);
    foot_color = root[k].rgb * dry;
    float lying = 1.0 - lodged(0.5 * (bend_a + bend_b)), aside = 1.0 - smoothstep(0.0, 1.0, steep_at(middle));
    rise_color = (tip[k].rgb - root[k].rgb) * dry * (1.0 - ARCHED * inversesqrt(sections) * lying * aside);
    float turned = turn % 2 == 0 ? 1.0 : -1.0;
    grain_cos = turned * grain_c[k].rgb;
    grain_sin = turned * grain_s[k].rgb;
    shown = how.x;
    vec2 back = 0.5 * (back_a + back_b);
    float texels = picture.y * ATLAS / (OF(tall, k) * apart_at(middle, run, top + vec3(back.x, 0.0, back.y)));
    lit = bundled(light, vec3(float(layer), log2(texels) - SHARPER, boosted(k, run, middle, top, back)));
#ifdef THIN
    thin(mix(told_a.w, told_b.w, across), how.z, 0.5 * texels);
#endif
}
