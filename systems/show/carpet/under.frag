// The opaque layer under the carpet. With EDGED, it ends where grass ends, and is as high as cut grass.
#include "lib/tone.glsl"
#ifdef EDGED
#include "systems/show/carpet/edged.glsl"

in vec3 mesh_place;
centroid in float mesh_height;
centroid in float mesh_lift;
centroid in float slope;
centroid in float curvature;
#endif
centroid in vec3 color;

out vec4 pixel;

void main() {
#ifdef EDGED
    bool aside;
    float way = entry_distance(way_from(mesh_place, mesh_height, mesh_lift, slope, curvature), aside);
    if (way < 0.0)
        discard;
    gl_FragDepth = gl_FragCoord.z + depth_beyond(moved_along(mesh_place, way), mesh_place);
#endif
    pixel = vec4(tone_mapped(color), 1.0);
}
