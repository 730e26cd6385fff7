// Covers the rows of the receivers that are asked: a triangle over all of the viewport.
void main() {
    gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);
}
