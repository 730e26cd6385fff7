// The carpet in a shadow map: a surface over the top of the grass, whose pixels have the depth at which light is stopped.
#include "lib/light.glsl"
#include "systems/show/carpet/laid.glsl"

uniform vec3 light;  // place that it comes from [m]

const float LEAST_AREA = 1e-4;  // least leaf area that divides

out vec3 place;
out float mesh_share;     // the carpet's share of the grass, in [0, 1]
out float grass_height;   // height of the grass [m]
out float optical_depth;  // of the grass, in leaves, for light down to the ground

void main() {
    place = on_ground(on_mesh());
    ByKind densities = density_at(place.xz);
    float cut_height = anything_is_cut() ? cut_height_about(place.xz, tile.z) : tallest_grass;
    float up = max(dot(lie_at(place.xz).normal, normalize(light - place)), 0.0), sum = 0.0;
    ByKind area = leaf_areas(densities), stays = leaf_area_left(cut_height);
    grass_height = optical_depth = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        float leaves = OF(area, kind) * OF(stays, kind);
        grass_height += leaves * min(OF(crown, kind), cut_height);
        optical_depth += leaves * sun_extinction(kind, up);
        sum += leaves;
    }
    grass_height /= max(sum, LEAST_AREA);
    mesh_share = lowest_share(place.xz);
    place.y += grass_height;
    gl_Position = clip * vec4(place, 1.0);
}
