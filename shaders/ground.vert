uniform mat4 u_view_projection;
uniform vec3 u_centre;
uniform vec3 u_along;
uniform vec3 u_across;
uniform vec2 u_half;
out vec3 v_position;
out vec2 v_plane;

void main() {
  v_plane = u_half * vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - u_half;
  v_position = u_centre + v_plane.x * u_along + v_plane.y * u_across;
  gl_Position = u_view_projection * vec4(v_position, 1.0);
}
