// A mark of the overlay, its colour multiplied by its opacity.
out vec4 pixel;

#ifdef PAPER
in vec2 at;
uniform sampler2D sheet;

void main() {
    vec4 drawn = texture(sheet, at);
    pixel = vec4(drawn.rgb * drawn.a, drawn.a);
}
#else
in vec4 shade;
#ifdef LINE
noperspective in float across;
flat in float half_width;
#endif

void main() {
    float opacity = shade.a;
#ifdef LINE
    opacity *= clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
#endif
    pixel = vec4(shade.rgb * opacity, opacity);
}
#endif
