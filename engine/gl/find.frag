// What passes the test of depth is counted, and nothing is written.

out vec4 pixel;

void main() {
    pixel = vec4(0.0);  // it is not written
}
