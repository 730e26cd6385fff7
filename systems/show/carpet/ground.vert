// Ground that no carpet lies on.
#define PIXELS_ASK  // pools of light and shadows are smaller than the mesh
#include "lib/light.glsl"
#include "systems/show/carpet/mesh.glsl"
#include "systems/show/carpet/floor.glsl"

uniform float pushed;  // how much farther it is taken to lie, of the depths that there are

out vec3 place;
centroid out vec3 haze;       // radiance of what lies before it
#ifndef EDGED
centroid out vec3 soil_seen;  // its radiance, without haze
centroid out vec3 sunlit;     // that of the sun's light without any grass,
centroid out vec3 skylit;     // and of the sky's
centroid out float soil_way;  // how many leaves the sun's light meets
centroid out float soil_through; // how much of it comes through the grass
centroid out vec3 lush;       // pigment of the understorey, of that of the ground between
#endif

void main() {
    place = on_ground(on_mesh());
    float hidden = haze_at(place);
    haze = haze_light(place) * hidden;
#ifndef EDGED
    Lie lies = lie_at(place.xz);
    ByKind grows = grows_at(place.xz);
    Soil ground = soil_lit(place, lies, grows, 1.0 - hidden);
    soil_seen = ground.seen;
    sunlit = ground.sunlit;
    skylit = ground.skylit;
    soil_way = ground.way;
    soil_through = ground.through;
    lush = understorey_of(lies, grows);
#endif
    gl_Position = clip * vec4(place, 1.0);
    gl_Position.z += farther_by(pushed) * gl_Position.w;
}
