// A picture with fewer pixels than the host's, and how it is read in the host's.

uniform sampler2D before;   // how deep the host's pixels were before anything was drawn here
uniform sampler2D picture;  // what was drawn smaller, premultiplied
uniform sampler2D deep;     // and how deep that is
uniform ivec2 size;         // pixels of the smaller picture
uniform vec2 shrunk;        // how many of them there are for each of the host's, across and up
uniform ivec2 corner;       // the host's first pixel

// How deep the host was where the middle of one of the smaller picture's pixels is.
float depth_before(ivec2 texel) {
    return texelFetch(before, ivec2((vec2(texel) + 0.5) / shrunk), 0).r;
}

// Where the middle of the host's pixel is in the smaller picture.
vec2 place_in_it() {
    return (gl_FragCoord.xy - vec2(corner)) * shrunk;
}

// Catmull-Rom's cubic over 4 by 4 texels, in 5 samples: the corners count next to nothing and are left out.
vec4 sharp(vec2 place) {
    vec2 unit = 1.0 / vec2(textureSize(picture, 0)), last = vec2(size) - 0.5;
    vec2 middle = floor(place - 0.5) + 0.5, part = place - middle;
    vec2 first = part * (-0.5 + part * (1.0 - 0.5 * part)), fourth = part * part * (-0.5 + 0.5 * part);
    vec2 third = part * (0.5 + part * (2.0 - 1.5 * part)), inner = 1.0 - first - fourth;
    vec2 low = max(middle - 1.0, 0.5) * unit, high = min(middle + 2.0, last) * unit;
    vec2 within = clamp(middle + third / inner, vec2(0.5), last) * unit;
    vec4 five = texture(picture, within) * (inner.x * inner.y)
        + texture(picture, vec2(low.x, within.y)) * (first.x * inner.y)
        + texture(picture, vec2(high.x, within.y)) * (fourth.x * inner.y)
        + texture(picture, vec2(within.x, low.y)) * (inner.x * first.y)
        + texture(picture, vec2(within.x, high.y)) * (inner.x * fourth.y);
    float all = inner.x * inner.y + (first.x + fourth.x) * inner.y + inner.x * (first.y + fourth.y);
    return clamp(five / all, 0.0, 1.0);
}
