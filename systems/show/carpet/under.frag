// An opaque layer beneath the carpet. With EDGED, there is none where no grass stands, and it is as high as that.
#include "lib/tone.glsl"
#ifdef EDGED
#include "systems/show/carpet/edged.glsl"

in vec3 over;
centroid in float lies_over;
centroid in float raises;
centroid in float slope;
centroid in float curvature;
#endif
centroid in vec3 color;

out vec4 pixel;

void main() {
#ifdef EDGED
    bool aside;
    float way = enters(way_from(over, lies_over, raises, slope, curvature), aside);
    if (way < 0.0)
        discard;
    gl_FragDepth = gl_FragCoord.z + deeper(farther(over, way), over);
#endif
    pixel = vec4(shown_of(color), 1.0);
}
