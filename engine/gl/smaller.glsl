// A picture with fewer pixels than the host's, and how it is read in the host's. All places go from 0 to 1.

uniform sampler2D before;   // how deep the host's pixels were before anything was drawn here
uniform sampler2D picture;  // what was drawn smaller, premultiplied
uniform sampler2D deep;     // and how deep that is
uniform vec2 size;          // pixels of the smaller picture
uniform vec2 unit;          // how large each of them is
uniform float farthest;     // depth where nothing has been drawn, 1 or 0
uniform ivec2 corner;       // of the viewport in the host's framebuffer [pixels]

in vec2 at;

// The middle of the smaller picture's pixel.
vec2 middle_of(vec2 place) {
    return (floor(place * size) + 0.5) * unit;
}

// How much farther off one depth is than another.
float behind(float one, float other) {
    return farthest > 0.5 ? one - other : other - one;
}

// How deep the host's pixel was.
float depth_before() {
    return texelFetch(before, ivec2(gl_FragCoord.xy) - corner, 0).r;
}

// Whether the host had drawn something so deep.
bool has_host(float depth) {
    return depth != farthest;
}

const float CUBIC = 1.5;  // what Catmull-Rom's cubic is steepest by

// By how much of its difference to each neighbour across a texel is drawn out: pictures keep a sixth more of their contrast, and
// are as near to the truth (FLIP of three cameras, drawn with 0.6 to 0.8 of the pixels across).
const float SHARPENED = 0.1;

// Filtered up: by that cubic across, in 3 samples of 2 texels, and evenly up. Grass is lines that stand upright.
vec4 sharp(vec2 place) {
    float middle = floor(place.x * size.x - 0.5) + 0.5, part = place.x * size.x - middle;
    float first = part * (-0.5 + part * (1.0 - 0.5 * part)), fourth = part * part * (-0.5 + 0.5 * part);
    float third = part * (0.5 + part * (2.0 - CUBIC * part)), inner = 1.0 - first - fourth;
    vec3 across = vec3(middle - 1.0, middle + third / inner, middle + 2.0) * unit.x;
    vec4 sum = texture(picture, vec2(across.x, place.y)) * (first - SHARPENED)
        + texture(picture, vec2(across.y, place.y)) * (inner + 2.0 * SHARPENED)
        + texture(picture, vec2(across.z, place.y)) * (fourth - SHARPENED);
    return clamp(sum, 0.0, 1.0);
}
