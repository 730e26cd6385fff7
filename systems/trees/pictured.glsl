// What the picture of a twig shows at a place of its card.
uniform sampler2DArray tree_cards;  // of each picture tone, wood, nothing, cover; the normal in the card's own axes, and cover

const float FINER_BY = -0.3;  // level of a card's picture: cards are seen askew, which would blur them

struct Pictured {
    float tone;
    float wood;
    float cover;
    vec3 lies;  // how its leaves lie, in the card's own axes: shorter where they lie in several ways
};

// `on` is across from -1 to 1, and up from 0 to 1. Leaves are thinner than a pixel: an edge around them would make one leaf of all.
Pictured pictured(vec2 on, float picture) {
    vec2 at = vec2(0.5 + 0.5 * on.x, on.y);
    vec4 texel = texture(tree_cards, vec3(at, 2.0 * picture), FINER_BY), lie = texture(tree_cards, vec3(at, 2.0 * picture + 1.0), FINER_BY);
    float whole = 1.0 / max(texel.a, LEAST_COVER);
    return Pictured(texel.r * whole, texel.g * whole, texel.a, (2.0 * lie.rgb - lie.a) * whole);
}
