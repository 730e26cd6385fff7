// How much the carpet shows on a patch.
uniform sampler2D shares;  // by patch, wrapping round
uniform ivec3 window;      // viewer's cell, half the window's side
uniform float beyond;      // how much it shows on the terrain beyond the window; beyond the terrain all is carpet

float share_at(ivec2 cell) {
    ivec2 apart = abs(cell - window.xy);
    if (max(apart.x, apart.y) > window.z) {
        vec2 inside = abs((vec2(cell) + 0.5) * patch_side - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size;
        return max(inside.x, inside.y) > 0.0 ? 1.0 : beyond;
    }
    return textureLod(shares, (vec2(cell) + 0.5) / vec2(textureSize(shares, 0)), 0.0).r;
}
