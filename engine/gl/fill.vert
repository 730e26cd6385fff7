// All of the viewport, as far away as can be.

uniform float far_end;  // of clip space

out vec2 at;  // from 0 to 1 across and up

const float OVER = 4.0;  // sides of a triangle that a viewport of 2 by 2 lies in

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * OVER - 1.0;
    at = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, far_end, 1.0);
}
