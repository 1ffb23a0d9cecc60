// What a picture is made of: plain arrays that the bridge in app/ fills, for live frames and for
// recordings alike.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace topple::render {

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

/// Closed outline of a cross-section in the local y-z plane of a beam, m, counter-clockwise seen
/// from the +x end. Drawn with flat facets (box) or smooth normals (pipe).
struct Profile {
  std::vector<std::array<float, 2>> outline;
  bool smooth = false;
};

/// One point of a beam's centre line. Consecutive stations of a tube are joined.
struct Station {
  Float3 position;  ///< m, in the picture's frame (z up)
  Float4 rotation;  ///< unit quaternion (w, x, y, z): local axes (x along the beam) to the picture's frame
  float value;      ///< the coloured quantity, in the legend's unit
};

/// A beam drawn as its real section swept along its stations.
struct Tube {
  std::uint32_t first_station = 0;
  std::uint32_t station_count = 0;
  std::uint32_t profile = 0;  ///< index into SceneFrame::profiles
  std::uint32_t member = 0;   ///< what picking reports
  std::uint32_t body = 0;
  float lead = 0;        ///< m, how far the section is drawn on before its first station: closes a corner
  float trail = 0;       ///< m, the same after its last station
  float torn_first = 0;  ///< m, depth of the teeth where it broke off before its first station; 0: whole
  float torn_last = 0;   ///< m, the same after its last station
  Float4 colour = {0, 0, 0, 0};  ///< its own; alpha 0: by the value of its stations
};

/// A translucent sheet of a cabinet: a quadrilateral, corners in order.
inline constexpr std::uint32_t k_no_body = 0xffffffff;
struct Panel {
  std::array<Float3, 4> corners;
  std::uint32_t body = 0;  ///< Tube::body; k_no_body: a door
};

/// A floor or wall: a rectangle with a metric grid (1 m bold, 0.1 m faint). `normal` points to the
/// side on which bodies live; `along` is one in-plane direction.
struct Ground {
  Float3 centre;
  Float3 normal;
  Float3 along;
  float half_length = 0;  ///< m, in the direction of `along`
  float half_width = 0;   ///< m, across it
  bool is_floor = false;
};

/// An arrow, m. Seen through everything else, and without a shadow.
struct Arrow {
  Float3 from;
  Float3 to;
  Float4 colour;
};

/// A ring about an axis, m: marks a hinge and the plane in which it turns.
struct Ring {
  Float3 centre;
  Float3 axis;  ///< need not be a unit
  float radius = 0;
  Float4 colour;
  bool turns = false;  ///< open, with an arrow head: right-handed about `axis`
};

/// A path, m, drawn as a line that is seen from everywhere.
struct Trail {
  std::vector<Float3> points;
  std::vector<float> strength;  ///< of each point, 0 (not seen) to 1
  Float4 colour;
};

/// A translucent band between two lines with as many points, m, such as a diagram of forces along a member.
/// Seen through everything else.
struct Band {
  std::vector<Float3> base, edge;
  Float4 colour;
};

/// Words at a place, beside which they are written.
struct Label {
  Float3 at;
  std::string words;
};

/// Colour scale of Station::value.
struct Legend {
  std::string quantity;      ///< "von Mises stress"
  std::string unit;          ///< "MPa"
  std::string range_policy;  ///< "whole run"
  float minimum = 0;
  float maximum = 1;
  bool is_signed = false;    ///< diverging map, symmetric range
  float mark = 0;            ///< value of the mark (yield); drawn when mark_label is not empty
  std::string mark_label;    ///< "yield 235 MPa"
  bool square_root = false;  ///< colours go with the root of the share of the range: small values stay apart
  std::vector<std::string> notes{};  ///< below the range policy: what else is to be known of the picture
};

/// A trace of one quantity over the run, drawn small in a corner with a cursor.
struct Trace {
  std::string label;         ///< "floor acceleration, gal"
  std::string unit = "s";    ///< of `at`
  bool whole = false;        ///< `at` counts: written without decimals
  std::vector<float> at;     ///< increasing
  std::vector<float> value;  ///< same length
  float cursor = 0;          ///< in `at`
};

/// Words of the picture.
struct Caption {
  std::string title;               ///< top left, large
  std::vector<std::string> lines;  ///< below the title: time, excitation, what is happening
  std::string note;                ///< bottom, small: assumptions
  int most_lines = 0;              ///< that `lines` may become over a run: bodies stay off as many
};

/// One recorded instant as a renderer needs it.
struct SceneFrame {
  std::vector<Profile> profiles;
  std::vector<Station> stations;
  std::vector<Tube> tubes;
  std::vector<Panel> panels;
  std::vector<Ground> grounds;
  std::vector<Arrow> arrows;
  std::vector<Ring> rings;
  std::vector<Trail> trails;
  std::vector<Band> bands;
  std::vector<Label> labels;
  std::int64_t highlighted_member = -1;  ///< Tube::member that is outlined; -1: none
  std::int64_t highlighted_body = -1;    ///< Tube::body likewise
  std::vector<Station> ghost_stations;   ///< of another run, for comparison; their value does not count
  std::vector<Tube> ghost_tubes;         ///< drawn translucent grey, without a shadow
  bool dark = false;                     ///< light words on a dark ground
  Legend legend;
  Trace trace;
  Caption caption;
  Float3 bounds_min{-1, -1, 0};  ///< box that holds the bodies over the whole run: the camera fits it
  Float3 bounds_max{1, 1, 2};
};

}  // namespace topple::render
