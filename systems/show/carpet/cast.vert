// The carpet in a shadow map: a sheet over the top of the grass, whose pixels lie where light is stopped on its way down.
#include "lib/light.glsl"
#include "systems/show/carpet/laid.glsl"

uniform vec3 light;  // where it comes from [m]

const float LEAST_TOLD = 1e-4;  // leaf area that divides at least

out vec3 place;
out float mesh_share;  // how much of what is seen is carpet's
out float high;    // of the grass [m]
out float stops;   // leaves that light meets on its way to the ground

void main() {
    place = on_ground(on_mesh());
    ByKind grows = grows_at(place.xz);
    float left = anything_is_cut() ? left_about(place.xz, tile.z) : tallest_grass;
    float up = max(dot(lie_at(place.xz).normal, normalize(light - place)), 0.0), sum = 0.0;
    ByKind area = areas(grows), stays = leaves_left(left);
    high = stops = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        float leaves = OF(area, kind) * OF(stays, kind);
        high += leaves * min(OF(crown, kind), left);
        stops += leaves * sun_way(kind, up);
        sum += leaves;
    }
    high /= max(sum, LEAST_TOLD);
    mesh_share = lowest_share(place.xz);
    place.y += high;
    gl_Position = clip * vec4(place, 1.0);
}
