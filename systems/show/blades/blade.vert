// One vertex is one blade: all about it that is the same along its ribbon. With STORED it is looked up by the number of
// its receiver; with MORPH it is on its way between its own place and its painted place on a moving strip (paper, 4.2).
#include "lib/light.glsl"
#include "lib/posture.glsl"

#ifdef STORED
#include "lib/received.glsl"

in uint number;            // of its receiver, among those of blades
uniform int blades_from;   // the first of these receivers among all
uniform sampler2D blades;  // by model, quarter turn and blade: BLADE
uniform sampler2D standing; // by patch: STANDING
uniform float near;        // distance up to which blades hide one another by depth [m]; beyond it order alone says
#ifdef MORPH
uniform sampler2D slices;  // by ring, model, orientation and blade: the strip that it is painted on
uniform ByKind margin;     // by kind: how far strips reach beyond their patch [m]
uniform ByKind tall;       // by kind: height of the strips [m]
uniform ivec4 stacks[RINGS]; // by ring: columns of a strip, sections of a column, strips of a kind on a patch
uniform int models;
#include "lib/stack.glsl"

out vec4 base;             // foot of its strip's first edge (x, z), and the way from edge to edge (x, z) [m]
out vec4 painted;          // receiver of that edge; row of its targets; height of the strip [m]; how far it has moved
#endif
#else
in vec3 root_at;
in float height;
in vec2 rest;
in vec2 facing;
in float width;
in float variant;
in float kind;
#ifdef ORGANS
in float organ;
in float stem;  // length of the one that it stands on [m]
in float part;  // and the place along it
in vec2 sways;  // and its lean
#endif
in vec2 message;
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"
#endif
#ifdef ORGANS
const vec2 tones[ORGANS] = TONES;
const float gives[ORGANS] = GIVES;
#endif

out vec4 foot;   // where its ribbon begins [m]; its length [m]
out vec4 lie_of; // bending vector; half its way across at the root [m]
out vec4 low;    // pigment at the root; row of the posture table
out vec4 high;   // pigment at the tip; taper
out mat4 lit;    // light on it, bundled; relative change of pigment to its sides
out vec4 stands; // where its foot is in the canopy, and how much of it is its length; organ, plus the part that is cut off; cover
out vec4 joints; // sub-level, and slide to those of the next; coverage from which on it hides what is behind; kind; ring of strips, or teeth seen

#ifdef MOWN
// The part of a blade up to where it first stands as high as `top` in calm air, of its length.
float cut_at(float variant, vec2 rest, float top) {
    float before = 0.0;
    for (float link = 1.0; link <= terrain.w; link++) {
        float here = posture(variant, rest, link / terrain.w).place.y;
        if (here > top)
            return max((link - 1.0 + (top - before) / (here - before)) / terrain.w, 0.0);
        before = here;
    }
    return 1.0;
}
#endif

void main() {
#ifdef STORED
    int patch_number = int(number) / EACH, blade = int(number) % EACH;
    ivec2 at = ivec2(patch_number % STANDING_ROW * 3, patch_number / STANDING_ROW);
    vec4 where = texelFetch(standing, at, 0), how = texelFetch(standing, at + ivec2(1, 0), 0);
#ifdef MORPH
    vec4 strips = texelFetch(standing, at + ivec2(2, 0), 0);
#endif
    int record = int(where.z) * EACH + blade;
    at = ivec2(record % BLADES_ROW * TEXELS, record / BLADES_ROW);
    vec4 part0 = texelFetch(blades, at, 0), part1 = texelFetch(blades, at + ivec2(1, 0), 0);
    vec4 part2 = texelFetch(blades, at + ivec2(2, 0), 0);
    vec4 told = received_by(blades_from + int(number));
    vec3 root_at = vec3(part0.x + where.x * soil.w, told.z, part0.z + where.y * soil.w);
    float height = part0.w, width = part2.x, variant = part2.y;
#ifdef ORGANS
    vec4 part3 = texelFetch(blades, at + ivec2(3, 0), 0);
    float organ = part2.w, stem = part3.x, part = part3.y;
    vec2 sways = part3.zw;
#endif
    vec2 rest = part1.xy, facing = part1.zw, message = told.xy;
    int k = int(part2.z);
    joints = vec4(how.x, mix(0.5, 2.0, smoothstep(0.8 * near, near, distance(root_at.xz, eye.xz))), float(k), 0.0);
    stands.w = where.w;
#else
    int k = int(kind);
    joints = vec4(0.0, 2.0, kind, 0.0);
    stands.w = 1.0;
#endif
    vec2 blown = bending(k, message), across = vec2(-facing.y, facing.x);
#ifdef ORGANS
    vec2 moved = blown * gives[int(organ)], bend = moved + rest * (1.0 - min(length(moved), 1.0));
    vec2 swayed = blown + sways * (1.0 - min(length(blown), 1.0)), grade = tones[int(organ)];
    vec3 up = stem > 0.0 ? posture(float(k) * field.w, swayed, part).place * stem : vec3(0.0);
    foot = vec4(root_at + up, height);
#else
    vec2 bend = blown + rest * (1.0 - min(length(blown), 1.0));
    foot = vec4(root_at, height);
#endif
    bool has_section = grain_c[k].w > 0.0, is_round = grain_s[k].w < 0.0;
#ifdef ORGANS
    has_section = has_section && int(organ) == BLADE_ITSELF;
    is_round = is_round && int(organ) == BLADE_ITSELF;
#endif
    if (is_round) {
        vec2 toward = normalize(root_at.xz - eye.xz + 1e-6);
        across = vec2(-toward.y, toward.x);
    }
    lie_of = vec4(bend, 0.5 * width * across);
    vec2 twice = doubled(facing);
    Lie lies = lie_at(root_at.xz);
    vec3 grain = grain_at(k, twice), dry = stretch(lies.slow) * grain;
#ifdef ORGANS
    low = vec4(pigment_at(k, grade.x) * dry, variant);
    high = vec4(pigment_at(k, grade.y) * dry, tip[k].w);
#else
    low = vec4(root[k].rgb * dry, variant);
    high = vec4(tip[k].rgb * dry, tip[k].w);
#endif
    ByKind grows = grows_at(root_at.xz);
    Light light = veiled(light_on(k, blown, root_at, lies, grows), root_at);
#ifdef MOWN
    float top = left_at(root_at.xz);
    light = mown_to(top, light, k, areas(grows));
#endif
    vec3 tilt = 2.0 * ROUND * (grain_s[k].rgb * twice.x - grain_c[k].rgb * twice.y) / grain;
    if (has_section) {
        vec2 toward = drift.zw, round_to = doubled(toward);
        tilt = vec3(grain_c[k].w * (is_round ? dot(across, toward) : twice.x * round_to.y - twice.y * round_to.x));
    }
    lit = bundled(light, tilt);
    float canopy_height = OF(crown, k) * lodged(blown);
#ifdef ORGANS
    stands.xyz = vec3(up.y / canopy_height, height / canopy_height, organ);
#ifdef TOOTHED
    joints.w = teeth_seen(height, TEETH_OF[int(organ)], foot.xyz);
#endif
#else
    stands.xyz = vec3(0.0, height / canopy_height, 0.0);
#endif
#ifdef MOWN
#ifdef ORGANS
    top -= stem > 0.0 ? posture(float(k) * field.w, sways, part).place.y * stem : 0.0;
#endif
    stands.z += min(1.0 - cut_at(variant, rest, top / height), 0.999);
#endif
#ifdef MORPH
    int ring = int(strips.x), model = int(where.z) / 4, turn = int(where.z) % 4, along = int(how.w);
    int own = (along + turn) % 2, count = stacks[ring].z, columns = stacks[ring].x;
    int row = (model * 2 + own) * EACH + blade, slice = ring * models * 2 * EACH + row;
    int plane = int(texelFetch(slices, ivec2(slice % SLICES_ROW, slice / SLICES_ROW), 0).r);
    int strip = k * count + stacked(plane, count, own, along, turn);
    vec2 first = edge_foot(where.xy, turn, own, plane, count, 0, columns, OF(margin, k));
    vec2 second = edge_foot(where.xy, turn, own, plane, count, 1, columns, OF(margin, k));
    base = vec4(first, second - first);
    painted = vec4(strips.y + float(strip * (columns + 1)), float(row), OF(tall, k) * how.z, how.y);
    joints.yw = vec2(2.0, strips.x);
#endif
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
