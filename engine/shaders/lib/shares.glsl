// The carpet's share on each patch: its cover there.
uniform sampler2D shares;  // by patch of a window around the viewer, wrapping round

// The carpet's share on a cell. Beyond the window it is the same on all the terrain; beyond the terrain it is 1.
float share_at(ivec2 cell) {
    vec2 apart = abs(vec2(cell) - carpet_window.xy);
    if (max(apart.x, apart.y) > carpet_window.z) {
        vec2 inside = abs((vec2(cell) + 0.5) * patch_side - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size;
        return max(inside.x, inside.y) > 0.0 ? 1.0 : carpet_window.w;
    }
    return textureLod(shares, (vec2(cell) + 0.5) * windows_per_patch, 0.0).r;
}
