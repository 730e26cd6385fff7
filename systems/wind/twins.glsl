// No wind at all: `systems/wind/twin.py` puts what blows in a prairie in place of this.

void blow(inout Claims claims, vec2 place, int kind, int receiver) {
}
