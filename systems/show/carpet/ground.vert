// Ground that no carpet lies on.
#define PIXELS_ASK  // pools of light and shadows are smaller than the mesh
#include "lib/light.glsl"
#include "systems/show/carpet/mesh.glsl"
#include "systems/show/carpet/floor.glsl"

uniform float pushed;  // added depth, in the usual clip range of -1 to 1

out vec3 place;
centroid out vec3 haze;  // radiance of the haze before it
#ifndef EDGED
centroid out vec3 soil_seen;         // radiance of the soil, without haze
centroid out vec3 sunlit;            // its radiance without any grass: from the sun
centroid out vec3 skylit;            // and from the sky
centroid out float soil_extinction;  // of sunlight: optical depth for each 1 of leaf area seen from the side
centroid out float soil_through;     // transmittance of the grass for sunlight
centroid out vec3 lush;              // pigment of the understorey, relative to that of the ground between
#ifdef TREES
out vec3 sunward;                    // from trees_sunward
#endif
#endif

void main() {
    place = on_ground(on_mesh());
    float hidden = haze_opacity(place);
    haze = haze_radiance(place) * hidden;
#ifndef EDGED
    Lie lies = lie_at(place.xz);
    ByKind densities = density_at(place.xz);
    Soil ground = soil_lit(place, lies, densities, 1.0 - hidden);
    soil_seen = ground.seen;
    sunlit = ground.sunlit;
    skylit = ground.skylit;
    soil_extinction = ground.extinction;
    soil_through = ground.through;
    lush = understorey_pigment(lies, densities);
#ifdef TREES
    sunward = trees_sunward(place);
#endif
#endif
    vec3 lower = place;
    if (pushed > 0.0)  // under a carpet, whose outlines fade above this hard one
        lower.y -= 0.5 * pixel_height(place);
    gl_Position = clip * vec4(lower, 1.0);
    gl_Position.z += depth_offset(pushed) * gl_Position.w;
}
