// How much the carpet shows on a patch.
uniform sampler2D shares;  // by patch, wrapping round
uniform ivec3 window;      // viewer's cell, half the window's side; all is carpet beyond

float share_at(ivec2 cell) {
    ivec2 apart = abs(cell - window.xy);
    if (max(apart.x, apart.y) > window.z)
        return 1.0;
    return textureLod(shares, (vec2(cell) + 0.5) / vec2(textureSize(shares, 0)), 0.0).r;
}
