// One instance is one polygon strip between two vertical edges, as many quads high as its ring asks for, at most SECTIONS.
#include "lib/light.glsl"
#include "lib/posture.glsl"

uniform sampler2D strips;   // four texels for each polygon strip
uniform sampler2D extents;  // by column and layer: where paint begins and ends across the column, and up to where
uniform int first;

uniform vec4 tall;  // by kind: height of the strips [m]
uniform vec2 picture_to[RINGS * KINDS];  // how far each picture reaches across its layer of the texture, and up
uniform ivec2 fineness[RINGS];           // by ring: columns of a strip, sections of a column

out vec2 at;
out float h;
flat out float lifted;
flat out vec3 foot_color;
flat out vec3 rise_color;
flat out vec3 grain;  // change of colour with the normal across the strip
flat out float sheet;
flat out vec3 veil;
flat out float shown;
flat out float boost;
#ifdef THIN
out float grows;
flat out vec2 stays;
flat out float sharp;

// How much of a texel stays where its kind grows thinly, and where only blades of some ranks show: the others go, over a
// span of ranks that is narrow where a texel is one blade, and wide where a pixel is the mean of many.
void thin(float dense, float below, float texels) {
    float soft = clamp(0.35 * log2(max(texels, 1.0)), 0.06, 1.0);
    sharp = 1.0 / soft;
    grows = (dense > 0.995 ? 1.0 : dense - 0.5 * soft) * sharp + 1.0;
    // The span must reach from below all ranks to above them, softness included.
    float edge = mix(-0.5 * soft, 1.0 + 0.5 * soft, abs(below));
    stays = vec2(-sharp, edge * sharp + 0.5);
    if (below < 0.0)
        stays = vec2(0.0, 1.0) - stays;
}
#endif

// Pixels that a metre is long on the screen, across the line of sight.
float pixels_at(vec3 place) {
    vec4 up = vec4(clip[0][1], clip[1][1], clip[2][1], 0.0);
    return screen.y * length(up) / max(dot(vec4(clip[0][3], clip[1][3], clip[2][3], clip[3][3]), vec4(place, 1.0)), 0.1);
}

// Where a point of an edge is, `t` of the way up its section's quads, and its height in the canopy.
vec4 on_edge(vec3 foot, vec2 message, float t, int k, float sections, float growth) {
    float low = min(floor(t * sections), sections - 1.0), variant = float(k) * field.w;
    vec3 from = posture(variant, message, low / sections).place, to = posture(variant, message, (low + 1.0) / sections).place;
    vec3 spine = mix(from, to, t * sections - low) * tall[k];
    return vec4(foot + spine * growth, spine.y / (root[k].w * lodged(message)));
}

void main() {
    int number = first + gl_InstanceID;
    ivec2 at_record = ivec2(number % PER_ROW * 4, number / PER_ROW);
    vec4 part0 = texelFetch(strips, at_record, 0), part1 = texelFetch(strips, at_record + ivec2(1, 0), 0);
    vec4 part2 = texelFetch(strips, at_record + ivec2(2, 0), 0), part3 = texelFetch(strips, at_record + ivec2(3, 0), 0);
    vec3 a = part0.xyz, b = vec3(part0.w, part1.xy);
    vec4 wind = vec4(part1.zw, part2.xy);
    int picture = int(part2.w), stand = int(part3.x), turn = stand % 4, k = picture % KINDS;
    ivec2 fine = fineness[picture / KINDS];
    float growth = part3.z;
    sheet = part2.z;
    vec3 middle = 0.5 * (a + b);
    // Nothing is drawn where nothing is painted: a strip ends a pixel beyond its paint.
    vec4 extent = texelFetch(extents, ivec2(stand / 4, int(sheet)), 0);
    float pixels = pixels_at(middle), beside = 1.0 / (pixels * distance(a.xz, b.xz));
    float across = (gl_VertexID & 1) == 1 ? min(extent.y + beside, 1.0) : max(extent.x - beside, 0.0);
    float t = min(float(gl_VertexID / 2) / float(fine.y), min(extent.z + 1.0 / (pixels * tall[k]), 1.0));
    vec4 point = mix(on_edge(a, wind.xy, t, k, float(fine.y), growth), on_edge(b, wind.zw, t, k, float(fine.y), growth), across);
    gl_Position = clip * vec4(point.xyz, 1.0);
    h = point.w;
    at = vec2((float(stand / 4) + across) / float(fine.x), t) * picture_to[picture];
    lifted = lift(0.5 * (wind.xy + wind.zw), middle);
    vec3 here = place_tone(middle.xz);
    float hidden = haze_at(middle);
    veil = haze.rgb * hidden;
    here *= 1.0 - hidden;
    foot_color = root[k].rgb * here;
    rise_color = (tip[k].rgb - root[k].rgb) * here;
    grain = abs(b.x - a.x) > abs(b.z - a.z) ? (turn < 2 ? 1.0 : -1.0) * grain_z[k].rgb
                                            : (turn % 3 == 0 ? 1.0 : -1.0) * grain_x[k].rgb;
    shown = part3.y;
    vec2 run = normalize(b.xz - a.xz), sight = normalize(middle.xz - eye.xz);
    boost = boosted(run, middle);
#ifdef THIN
    float texels = picture_to[picture].y * ATLAS / tall[k] / pixels;
    thin(textureLod(density, on_map(mix(a.xz, b.xz, across)), 0.0)[k], part3.w, texels / abs(run.x * sight.y - run.y * sight.x));
#endif
}
