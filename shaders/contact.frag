// How near to the floor: one channel that only sees millimetres, one that sees centimetres.
in float v_height;
out vec2 o_nearness;

void main() {
  float height = max(v_height, 0.0);
  o_nearness = exp(-height / vec2(0.005, 0.060));
}
