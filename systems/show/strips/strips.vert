// One instance is one polygon strip between two vertical edges, as many quads high as its ring asks for, at most SECTIONS.
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "lib/received.glsl"
#include "lib/stack.glsl"

uniform usampler2D strips;  // by place in the queue: the polygon strip that is drawn
uniform sampler2D stood;    // by patch: STOOD
uniform int first;
uniform int most;           // numbers of polygon strips that are set aside for a patch

uniform vec4 tall;          // by kind: height of the strips [m]
uniform vec4 margin;        // by kind: how far strips reach beyond their patch [m]
uniform vec2 picture_to[RINGS * KINDS];  // how far each picture reaches across its layer of the texture, and up
uniform int first_layer[RINGS * KINDS];
uniform ivec4 stacks[RINGS];             // by ring: columns of a strip, sections of a column, strips of a kind on a patch

out vec2 at;
out float h;
flat out float lifted;
flat out vec3 foot_color;
flat out vec3 rise_color;
flat out vec3 grain_u;
flat out vec3 grain_v;
flat out float sheet;
flat out float hidden;
flat out float shown;
flat out float boost;
#ifdef THIN
out float grows;
flat out float below;
#endif

void main() {
    int queued = first + gl_InstanceID;
    int number = int(texelFetch(strips, ivec2(queued % STRIPS_ROW, queued / STRIPS_ROW), 0).r);
    int patch_number = number / most, own_number = number % most;
    ivec2 at_patch = ivec2(patch_number % STOOD_ROW * 2, patch_number / STOOD_ROW);
    vec4 where = texelFetch(stood, at_patch, 0), how = texelFetch(stood, at_patch + ivec2(1, 0), 0);
    int stand = int(where.w), turn = stand % 4, along = stand / 4 % 2, ring = stand / 16, own = (along + turn) % 2;
    ivec4 fine = stacks[ring];
    int column = own_number % fine.x, walked = own_number / fine.x / GROWING, count = fine.z;
    int stack = stand / 8 % 2 == 1 ? count - 1 - walked : walked;
    // Strips of several kinds share a plane: each kind comes to lie in front as often as behind.
    int k = (own_number / fine.x + stack) % GROWING, plane = stacked(stack, count, own, along, turn);
    int receiver = int(how.w) + (k * count + stack) * (fine.x + 1) + column;
    vec4 told_a = received_by(receiver), told_b = received_by(receiver + 1);
    vec2 foot_a = edge_foot(where.xy, turn, own, plane, count, column, fine.x, margin[k]);
    vec2 foot_b = edge_foot(where.xy, turn, own, plane, count, column + 1, fine.x, margin[k]);
    vec3 a = vec3(foot_a.x, told_a.z, foot_a.y), b = vec3(foot_b.x, told_b.z, foot_b.y);

    float t = float(min(gl_VertexID / 2, fine.y)) / float(fine.y);
    bool right = (gl_VertexID & 1) == 1;
    vec3 foot = right ? b : a;
    vec4 told = right ? told_b : told_a;
    vec3 spine = posture(float(k) * field.w, told.xy, t).place * tall[k];
    gl_Position = clip * vec4(foot + spine * how.y, 1.0);
    int picture = ring * KINDS + k;
    at = vec2(float(column + (right ? 1 : 0)) / float(fine.x), t) * picture_to[picture];
    sheet = float(first_layer[picture] + (int(where.z) * 2 + own) * count + plane);
    h = spine.y / (root[k].w * lodged(told.xy));
    vec3 middle = 0.5 * (a + b);
    lifted = lift(0.5 * (told_a.xy + told_b.xy), middle);
    vec3 here = place_tone(middle.xz);
    hidden = haze_at(middle);
    foot_color = root[k].rgb * here;
    rise_color = (tip[k].rgb - root[k].rgb) * here;
    float c = turn == 0 ? 1.0 : turn == 2 ? -1.0 : 0.0;
    float s = turn == 1 ? 1.0 : turn == 3 ? -1.0 : 0.0;
    grain_u = c * grain_x[k].rgb + s * grain_z[k].rgb;
    grain_v = c * grain_z[k].rgb - s * grain_x[k].rgb;
    shown = how.x;
    boost = boosted(normalize(b.xz - a.xz), middle);
#ifdef THIN
    grows = told.w;
    below = how.z;
#endif
}
