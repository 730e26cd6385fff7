// The corners of a panel's triangles, in pixels from the upper left.
uniform vec2 screen;
in vec2 place;
in vec2 at;
in vec4 color;
out vec2 image_at;
out vec4 tint;

void main() {
    image_at = at;
    tint = color;
    gl_Position = vec4(2.0 * place.x / screen.x - 1.0, 1.0 - 2.0 * place.y / screen.y, 0.0, 1.0);
}
