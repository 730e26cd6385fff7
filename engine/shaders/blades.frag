in vec3 color;
flat in float shown;
#ifdef SOFT
uniform vec2 between;  // coverages that are drawn
noperspective in float aside;
noperspective in float half_width;
#endif

out vec4 pixel;

void main() {
#ifdef SOFT
    float covered = shown * clamp(half_width + 0.5 - abs(aside), 0.0, min(1.0, 2.0 * half_width));
    if (covered < between.x || covered >= between.y)
        discard;
    pixel = vec4(color * covered, covered);
#else
    pixel = vec4(color * shown, shown);
#endif
}
