// Fills the viewport at the far plane with one triangle.

uniform float far_end;  // depth of the far plane in clip space

out vec2 at;  // position in the viewport, 0 to 1 across and up

const float OVER = 4.0;  // legs of the triangle that covers the clip space's square of 2 by 2

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * OVER - 1.0;
    at = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, far_end, 1.0);
}
