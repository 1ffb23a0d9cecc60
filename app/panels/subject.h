// Members, bodies and anchors that can be inspected, and their values.
#pragma once

#include <compare>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/live/player.h"
#include "app/support/language.h"

namespace topple::app {

struct Subject {
  enum class Kind { member, body, anchor };
  Kind kind;
  std::size_t index;  ///< into Model::members, bodies or anchors
  auto operator<=>(const Subject&) const = default;
};

/// "free/post-1", "free", "strap".
std::string name_of(const Model& model, const Subject& subject);
/// The body that it is, belongs to, or holds.
std::size_t body_of(const Model& model, const Subject& subject);

/// Marks it to be outlined in the picture.
void highlight(const Model& model, const Subject& subject, render::SceneFrame& frame);

/// From BODY or BODY/MEMBER. Throws io::InputError that says what there is.
Subject subject_named(const Model& model, const std::string& name);

/// A recorded frame and, for differences in time, its neighbours; null: there is none.
struct FrameContext {
  const Model& model;
  const Vec3& gravity;              ///< m/s^2
  std::span<const Bearer> bearers;  ///< bearers_of the scene
  const io::FrameRow& row;
  const io::FrameRow* before = nullptr;
  const io::FrameRow* after = nullptr;
  const io::FrameRow* further = nullptr;      ///< beyond the only neighbour
  std::span<const double> anchor_peaks = {};  ///< N, Player::anchor_peaks()
  bool moves = true;                          ///< false: of a static run, in which nothing has a velocity
};
/// `row` between its neighbours among the recorded frames.
FrameContext frame_context(const Player& player, const io::FrameRow& row);

/// One number of a subject, in `unit`; NaN where it is not defined. Of a member the greatest magnitude along
/// it, with its sign.
struct SubjectValue {
  Phrase name;
  const char* unit;
  double (*at)(const FrameContext& frame, std::size_t index);
};
std::span<const SubjectValue> values_of(Subject::Kind kind);
/// What it is, in a line or two.
std::vector<std::string> about(const FrameContext& frame, const Subject& subject);

/// Of the values of a member: its stress, and N, the first of the components.
inline constexpr std::size_t k_stress_value = 0, k_first_component_value = 2;

/// "0.013", "12.3", "1234", "1.23e+08", "0" of what rounding makes, or a dash for what is not a number.
std::string value_text(double value);

/// Whether section forces of the member are rough at `row`: a contact force acts on the middle node of a pair
/// of its elements, and bending within the pair is not resolved.
bool is_approximate(const Model& model, const io::FrameRow& row, std::size_t member);

/// Values at all frames of Player::way(), extended as the run goes on.
class Histories {
 public:
  /// One for each row of Player::way().
  const std::vector<float>& of(const Player& player, const Subject& subject, std::size_t value);

 private:
  struct History {
    std::vector<float> samples;
    RowPtr first, last;  // rows of the first and the last sample
  };
  std::map<std::pair<Subject, std::size_t>, History> histories_;
};

}  // namespace topple::app
