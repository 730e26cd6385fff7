// One instance is one blade: a ribbon of SEGMENTS quads, the last a triangle.
#include "lib/light.glsl"
#include "lib/posture.glsl"

in vec3 root_at;
in float height;
in vec2 rest;
in vec2 facing;
in float width;
in float variant;
in float kind;
in vec2 message;
in float fade;

out vec4 color;

void main() {
    float t = float(gl_VertexID / 2) / float(SEGMENTS);
    float side = gl_VertexID == 2 * SEGMENTS ? 0.0 : float(gl_VertexID & 1) * 2.0 - 1.0;
    int k = int(kind);
    vec2 bend = message + rest * (1.0 - min(length(message), 1.0));
    vec3 spine = posture(variant, bend, t) * height;
    vec2 across = vec2(-facing.y, facing.x) * side;
    vec3 place = root_at + spine;
    place.xz += across * (0.5 * width * pow(max(1.0 - t, 0.0), tip[k].w));
    gl_Position = clip * vec4(place, 1.0);

    vec2 normal = facing + ROUND * across;
    vec3 grass = mix(root[k].rgb, tip[k].rgb, t) * (1.0 + grain_x[k].rgb * normal.x + grain_z[k].rgb * normal.y);
    grass *= place_tone(root_at.xz) * canopy(spine.y / root[k].w, lift(message, root_at));
    color = vec4(mix(grass, haze.rgb, haze_at(root_at)), fade);
}
