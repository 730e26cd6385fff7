// One instance is one square tile of the ground; its grid slides into the next coarser one with distance, so that
// tiles of different fineness meet without cracks.
#include "lib/light.glsl"
#include "lib/terrain.glsl"

in vec2 corner;  // of the grid, 0 .. GRID
in vec4 tile;    // x, z [m]; spacing [m]; distance at which the next coarser spacing has taken over [m]

uniform sampler2D shares;  // by patch, wrapping round: how much the carpet shows
uniform float raised;      // height of the carpet above the ground [m]
uniform ivec4 window;      // viewer's cell; half the window's side; 1 if the carpet is drawn

out vec3 place;
out vec3 soil_color;
out float carpet;

float share_at(ivec2 cell) {
    ivec2 apart = abs(cell - window.xy);
    if (max(apart.x, apart.y) > window.z)
        return 1.0;
    ivec2 side = textureSize(shares, 0);
    return texelFetch(shares, (cell + 4096 * side) % side, 0).r;
}

void main() {
    vec2 flat_at = tile.xy + corner * tile.z;
    float slide = clamp(distance(flat_at, eye.xz) / tile.w * 4.0 - 3.0, 0.0, 1.0);
    flat_at -= fract(corner * 0.5) * 2.0 * tile.z * slide;
    flat_at = clamp(flat_at, terrain.xy, terrain.xy + field.xy);
    place = vec3(flat_at, height_at(flat_at)).xzy;
    carpet = 0.0;
    if (window.w == 1) {
        ivec2 low = ivec2(floor((flat_at - 0.01) / soil.w)), high = ivec2(floor((flat_at + 0.01) / soil.w));
        carpet = min(min(share_at(low), share_at(high)), min(share_at(ivec2(low.x, high.y)), share_at(ivec2(high.x, low.y))));
    }
    place.y += raised * carpet;
    soil_color = soil_light(flat_at);
    gl_Position = clip * vec4(place, 1.0);
}
