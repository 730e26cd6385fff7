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

// Filtered up: by Catmull-Rom's cubic across, in 3 samples of 2 texels, and evenly up. Grass is lines that stand upright.
vec4 sharp(vec2 place) {
    vec2 unit = 1.0 / vec2(textureSize(picture, 0)), last = vec2(size) - 0.5;
    float middle = floor(place.x - 0.5) + 0.5, part = place.x - middle;
    float first = part * (-0.5 + part * (1.0 - 0.5 * part)), fourth = part * part * (-0.5 + 0.5 * part);
    float third = part * (0.5 + part * (2.0 - 1.5 * part)), inner = 1.0 - first - fourth;
    vec3 across = clamp(vec3(middle - 1.0, middle + third / inner, middle + 2.0), 0.5, last.x) * unit.x;
    float up = clamp(place.y, 0.5, last.y) * unit.y;
    vec4 sum = texture(picture, vec2(across.x, up)) * first
        + texture(picture, vec2(across.y, up)) * inner
        + texture(picture, vec2(across.z, up)) * fourth;
    return clamp(sum, 0.0, 1.0);
}
