// Painted blades in 3D: where a point of a strip's texture is on the moving strip, by the same triangles as strips.vert draws. It is
// the target of a blade that morphs (paper, section 4.2).
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "lib/received.glsl"
#include "lib/stack.glsl"
#include "systems/show/blades/store.py"

uniform sampler2D targets;    // (u, v) of POINTS points for each blade
uniform ivec4 stacks[RINGS];  // by ring: columns of a strip, sections of a column, strips of a kind on a patch
uniform vec2 sizes[FORMS];    // by form: width of strips beyond their patch, and their height [m]

struct Edge {
    vec3 foot;
    vec2 bend;
    vec3 top;      // of its posture, from the foot
    vec2 back;     // offset of its top, as laid_back returns it
};

struct Painted {
    vec3 place;
    vec3 tangent;
    float h;       // height in the canopy, as if the strip had grown up
    vec3 run;      // from the column's first edge to its second, along the ground
    vec3 middle;   // between their feet
    vec2 bend;     // mean of the two edges
    vec3 top;      // mean of the tops of their postures, from their feet
    vec2 back;     // mean of the offsets of their tops
};

Edge strip_edge(vec4 base, int receiver, int edge, int kind, int form, int count, float height) {
    vec4 texel = received_by(receiver + edge);
    vec2 at = base.xy + base.zw * float(edge), bend = bending(kind, texel.xy);
    vec3 foot = pulled_nearer(vec3(at.x, texel.z, at.y), base.zw, count), top = posture(float(form) * posture_variants, bend, 1.0).place * height;
    return Edge(foot, bend, top, laid_back(base.zw, foot, top, height, count));
}

// The point at `part` of an edge's length on a strip of a height [m], and its height in the canopy.
vec4 point_on_edge(Edge edge, int kind, int form, float part, float height) {
    vec3 spine = posture(float(form) * posture_variants, edge.bend, part).place;
    vec3 back = vec3(edge.back.x, 0.0, edge.back.y) * part;
    return vec4(edge.foot + spine * height + back, spine.y * sizes[form].y / (OF(crown, kind) * lodged(edge.bend)));
}

vec2 target_at(int number, int point) {
    return texelFetch(targets, ivec2(number % TARGETS_ROW * POINTS + point, number / TARGETS_ROW), 0).rg;
}

// Point `t` of a blade painted on a strip of a ring. `base` is the strip's first foot and the offset from edge to edge, `receiver`
// that of its first edge, `blade` its row in the targets.
Painted painted_at(vec4 base, int receiver, int blade, float height, float t, int kind, int form, int ring) {
    float along = t * float(POINTS - 1);
    int knot = min(int(along), POINTS - 2);
    vec2 before = target_at(blade, knot), after = target_at(blade, knot + 1);
    vec2 uv = mix(before, after, along - float(knot)), way = after - before;

    vec2 fineness = vec2(stacks[ring].xy);
    uv *= fineness;
    way *= fineness;
    ivec2 quad = clamp(ivec2(uv), ivec2(0), ivec2(fineness) - 1);
    vec2 part = uv - vec2(quad);
    int count = stacks[ring].z;
    Edge a = strip_edge(base, receiver, quad.x, kind, form, count, height), b = strip_edge(base, receiver, quad.x + 1, kind, form, count, height);
    float low = float(quad.y) / fineness.y, high = float(quad.y + 1) / fineness.y;
    vec4 near = point_on_edge(b, kind, form, low, height), far = point_on_edge(a, kind, form, high, height);
    // A quad is two triangles; its diagonal goes from the second edge's foot to the first edge's top.
    bool lower = part.x + part.y <= 1.0;
    vec4 corner = lower ? point_on_edge(a, kind, form, low, height) : point_on_edge(b, kind, form, high, height);
    vec4 across = lower ? near - corner : corner - far, up = lower ? far - corner : corner - near;
    vec2 from = lower ? part : part - 1.0;
    vec4 at = corner + across * from.x + up * from.y;
    vec3 run = vec3(base.z, 0.0, base.w);
    return Painted(at.xyz, across.xyz * way.x + up.xyz * way.y, at.w, run, 0.5 * (a.foot + b.foot),
                   0.5 * (a.bend + b.bend), 0.5 * (a.top + b.top), 0.5 * (a.back + b.back));
}
