// A mark of the overlay: corners of triangles; with LINE, an instance is a line of a width in pixels; with PAPER, four
// corners are an image.
#include "lib/least.glsl"

uniform mat4 onto;    // from the marks' space to clip space
uniform vec2 screen;  // half the picture's size [pixels]
uniform float scale;  // pixels per pixel of a picture 540 high

#ifdef PAPER
in vec2 corner;       // 0 to 1, from the lower left
uniform vec4 box;     // left, bottom, width, height [pixels]

out vec2 at;

void main() {
    at = vec2(corner.x, 1.0 - corner.y);
    gl_Position = vec4((box.xy + corner * box.zw) / screen - 1.0, 0.0, 1.0);
}
#else
in vec4 color;

out vec4 shade;

#ifdef LINE
in vec2 corner;       // along the line 0 or 1, across it -1 or 1
in vec3 a;
in vec3 b;
in float width;

noperspective out float across;
flat out float half_width;

const float NEAR = 0.05;  // distance from the eye at which lines are clipped [m]

void main() {
    vec4 from = onto * vec4(a, 1.0), to = onto * vec4(b, 1.0);
    shade = color;
    half_width = 0.5 * width * scale;
    across = corner.y * (half_width + 1.0);
    if (max(from.w, to.w) < NEAR) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    vec4 whole = to - from;
    if (from.w < NEAR)
        from += whole * ((NEAR - from.w) / whole.w);
    else if (to.w < NEAR)
        to -= whole * ((to.w - NEAR) / whole.w);
    vec2 run = (to.xy / to.w - from.xy / from.w) * screen;
    float far = length(run);
    vec2 ahead = far > LEAST_WIDTH ? run / far : vec2(1.0, 0.0);
    vec2 aside = vec2(-ahead.y, ahead.x) * across + ahead * (2.0 * corner.x - 1.0) * 0.5 * half_width;
    vec4 end = mix(from, to, corner.x);
    gl_Position = end + vec4(aside / screen * end.w, 0.0, 0.0);
}
#else
in vec3 place;

void main() {
    shade = color;
    gl_Position = onto * vec4(place, 1.0);
}
#endif
#endif
