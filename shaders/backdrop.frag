in float v_height;
out vec4 o_colour;

void main() {
  o_colour = vec4(mix(vec3(0.988, 0.988, 0.984), vec3(0.938, 0.950, 0.962), smoothstep(0.1, 1.0, v_height)), 1.0);
}
