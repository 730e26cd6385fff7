// Drawn for a query whether any pixel passes the depth test; nothing is written.

out vec4 pixel;

void main() {
    pixel = vec4(0.0);  // masked off
}
