// Where a point of a strip's texture is while the strip moves: the same triangles as strips.vert draws. It is where a
// painted blade is, the target of a blade on its way (paper, section 4.2).
#include "lib/light.glsl"
#include "lib/posture.glsl"

uniform sampler2D edges;    // two texels for each vertical edge: foot, height; message, columns, sections
uniform sampler2D targets;  // (u, v) of POINTS points for each blade

struct Edge {
    vec3 foot;
    float height;
    vec2 message;
    vec2 fineness;  // columns, sections
};

struct Painted {
    vec3 place;
    vec3 tangent;
    float h;       // height in the canopy, as if the strip had grown up
    vec3 run;      // from the column's first edge to its second, along the ground
    vec3 middle;   // between their feet
    vec2 message;  // mean of the two
};

Edge edge_at(int number) {
    ivec2 first = ivec2(number % PER_ROW * 2, number / PER_ROW);
    vec4 one = texelFetch(edges, first, 0), two = texelFetch(edges, first + ivec2(1, 0), 0);
    return Edge(one.xyz, one.w, two.xy, two.zw);
}

// The point at `part` of an edge's length, and its height in the canopy.
vec4 on_edge(Edge edge, int kind, float part, float tall) {
    vec3 spine = posture(float(kind) * field.w, edge.message, part).place;
    return vec4(edge.foot + spine * edge.height, spine.y * tall / (root[kind].w * lodged(edge.message)));
}

vec2 target_at(int number, int point) {
    return texelFetch(targets, ivec2(number % PER_ROW * POINTS + point, number / PER_ROW), 0).rg;
}

Painted painted_at(int strip, int blade, float t, int kind, float tall) {
    float along = t * float(POINTS - 1);
    int knot = min(int(along), POINTS - 2);
    vec2 before = target_at(blade, knot), after = target_at(blade, knot + 1);
    vec2 uv = mix(before, after, along - float(knot)), way = after - before;

    vec2 fineness = edge_at(strip).fineness;
    uv.x *= fineness.x;
    uv.y *= fineness.y;
    way *= fineness;
    ivec2 quad = clamp(ivec2(uv), ivec2(0), ivec2(fineness) - 1);
    vec2 part = uv - vec2(quad);
    Edge a = edge_at(strip + quad.x), b = edge_at(strip + quad.x + 1);
    float low = float(quad.y) / fineness.y, high = float(quad.y + 1) / fineness.y;
    vec4 near = on_edge(b, kind, low, tall), far = on_edge(a, kind, high, tall);
    // A quad is two triangles, parted from the second edge's foot to the first edge's head.
    bool lower = part.x + part.y <= 1.0;
    vec4 corner = lower ? on_edge(a, kind, low, tall) : on_edge(b, kind, high, tall);
    vec4 across = lower ? near - corner : corner - far, up = lower ? far - corner : corner - near;
    vec2 from = lower ? part : part - 1.0;
    vec4 at = corner + across * from.x + up * from.y;
    vec3 run = vec3(b.foot.x - a.foot.x, 0.0, b.foot.z - a.foot.z);
    return Painted(at.xyz, across.xyz * way.x + up.xyz * way.y, at.w, run, 0.5 * (a.foot + b.foot),
                   0.5 * (a.message + b.message));
}
