// A triangle over all of the target.
out vec2 v_at;  // 0..1

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  v_at = 0.5 + 0.5 * corner;
  gl_Position = vec4(corner, 0.0, 1.0);
}
