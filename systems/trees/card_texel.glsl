// The picture of a twig on its card.
uniform sampler2DArray tree_cards;  // layers of tone, normal across and along in the card's own axes, coverage

// Bias of the mip level from the card's longer axis: cards face all ways, so the other axis is shorter by 0.7 of a level in the mean.
const float CARD_LEVEL_BIAS = -0.7;

struct CardTexel {
    float tone;
    float cover;
    vec3 normal;  // normal of its leaves, in the card's own axes
};

// `on` is across from -1 to 1, and up from 0 to 1. Leaves are thinner than a pixel: a sharpened edge would merge them into one leaf.
CardTexel card_texel(vec2 on, float picture) {
    vec2 at = vec2(0.5 + 0.5 * on.x, on.y);
    vec4 texel = texture(tree_cards, vec3(at, picture), CARD_LEVEL_BIAS);
    float whole = 1.0 / max(texel.a, LEAST_COVER);
    vec2 normal = (2.0 * texel.gb - texel.a) * whole;
    return CardTexel(texel.r * whole, texel.a, vec3(normal, sqrt(max(1.0 - dot(normal, normal), 0.0))));
}
