// A placeholder without wind: `systems/wind/twin.py` replaces this file by the twins of a prairie's winds.

void blow(inout Claims claims, vec2 place, int kind, int receiver) {
}
