// Ground that no carpet lies on.
#include "lib/light.glsl"
#include "systems/show/carpet/litter.glsl"
#include "systems/show/carpet/stubble.glsl"

in vec3 place;
in vec3 soil_seen;
in vec3 sunlit;
in vec3 skylit;
in float soil_way;
in vec3 haze;
in vec3 lush;

out vec4 pixel;

void main() {
    vec3 pigment = lying_pigment(lying_seen(place.xz, 1.0), lush);
    float left = left_seen(place.xz);
    vec3 ground = soil_between(Soil(soil_seen, sunlit, skylit, soil_way), place.xz, left);
    if (any_lamps())
        ground += lamps_on_soil(place, left);
    pixel = vec4(shown_of(ground * pigment * pigment + haze), 1.0);
}
