#include "lib/frame.glsl"

out vec3 ray;

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    vec4 far = unclip * vec4(corner, 1.0, 1.0);
    ray = far.xyz / far.w - eye.xyz;
    gl_Position = vec4(corner, 1.0, 1.0);
}
