// All of the viewport, as far away as can be.

out vec2 at;  // from 0 to 1 across and up

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    at = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 1.0, 1.0);
}
