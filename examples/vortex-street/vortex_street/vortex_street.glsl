// The twin of the vortex street: what it reads are fields of the wind, and what its `twin_values` names.

float mask(vec2 place, Street street) {
    float across = place.x / (2.5 * street.rock), along = place.y / (2.5 * street.rock);
    return clamp(2.0 * min(min(-along, 10.0 + along), 1.0 - abs(across)), 0.0, 1.0);
}

vec2 action(vec2 place, Street street) {
    float rock = street.rock, side = street.side;
    vec2 message = vec2(0.0, -0.2);
    for (int number = 0; number < 10; ++number) {
        float age = (street.age + float(number)) / 10.0;
        vec2 away = (place - vec2(0.7 * side * rock, -25.0 * rock * age)) / (rock * (0.6 + 0.8 * age));
        float turn = side * street.strength * min(10.0 * age, 1.0 - age * age) * exp(0.5 - 0.5 * dot(away, away));
        message += turn * vec2(away.y, -away.x);
        side = -side;
    }
    return message / max(1.0, length(message));
}
