#include "solver/state/state.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "solver/contact/contact_law.h"
#include "solver/math/bits.h"
#include "solver/math/copy_values.h"
#include "solver/math/overflow.h"
#include "solver/math/pack.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

/// A choice and its number in checkpoints.
template <class Choice>
struct Stored {
  Choice kind;
  std::int64_t number;
};
constexpr Stored<ModelLevel> k_levels[] = {
    {ModelLevel::rigid, 0}, {ModelLevel::elastic, 1}, {ModelLevel::frame, 2}, {ModelLevel::planar, 3}};
constexpr Stored<LevelReason> k_reasons[] = {
    {LevelReason::asked, 0},     {LevelReason::motion, 1},   {LevelReason::stress, 2},
    {LevelReason::blow, 3},      {LevelReason::yield, 4},    {LevelReason::deformation, 5},
    {LevelReason::near, 6},      {LevelReason::calm, 7},     {LevelReason::bending, 8},
    {LevelReason::neighbour, 9}, {LevelReason::fall, 10},    {LevelReason::plane, 11},
    {LevelReason::held, 12},     {LevelReason::contact, 13}, {LevelReason::jammed, 14},
    {LevelReason::solid, 15}};
constexpr Stored<planar::Mode> k_block_modes[] = {{planar::Mode::rest, 0},
                                                  {planar::Mode::slide, 1},
                                                  {planar::Mode::rock, 2},
                                                  {planar::Mode::slide_rock, 3},
                                                  {planar::Mode::flight, 4}};
constexpr Stored<planar::Side> k_sides[] = {{planar::Side::left, 0}, {planar::Side::right, 1}};
constexpr Stored<int> k_slips[] = {{0, 0}, {1, 1}, {-1, -1}};
constexpr Stored<bool> k_flags[] = {{false, 0}, {true, 1}};
constexpr Stored<Hinge> k_hinges[] = {{Hinge::none, 0},   {Hinge::first, 1},  {Hinge::second, 2},
                                      {Hinge::broken, 3}, {Hinge::middle, 4}, {Hinge::both, 7}};
constexpr Stored<AnchorHold> k_holds[] = {
    {AnchorHold::in_place, 0}, {AnchorHold::away, 1}, {AnchorHold::broken, 2}};

template <class Choice>
double as_number(const Stored<Choice>& row) {
  return static_cast<double>(row.number);
}
double as_number(const Stored<Hinge>& row) {
  return bits_as<double>(row.number);
}
double as_number(const ContactLawTraits& law) {
  return static_cast<double>(law.kind);
}

// Calls f on the number of a choice; one that may change becomes what f makes of the number.
template <class Table, class Choice, class F>
void each_choice(const Table& table, Choice& choice, F& f) {
  double number = as_number(row_of(table, choice));
  f(number);
  if constexpr (!std::is_const_v<Choice>) {
    for (const auto& row : table)
      if (bits_as<std::uint64_t>(as_number(row)) == bits_as<std::uint64_t>(number)) {
        choice = row.kind;
        return;
      }
    throw std::invalid_argument("a checkpoint of another version");
  }
}

// Calls f on every number of the state, in the order of a checkpoint; `step` and counts are handled by the
// callers.
template <class AnyState, class F>
void each_number(AnyState& s, F f) {
  f(s.time);
  const auto each = [&](auto& vectors) {
    for (auto& v : vectors)
      for (int k = 0; k < 3; ++k) f(v[k]);
  };
  each(s.position);
  for (auto& q : s.rotation)
    for (int k = 0; k < 4; ++k) f(q.coeffs()[k]);
  each(s.velocity);
  each(s.angular_velocity);
  each(s.acceleration);
  each(s.angular_acceleration);
  each(s.algorithmic_acceleration);
  each(s.algorithmic_angular_acceleration);
  each(s.stick);
  for (auto& b : s.bodies) {
    each_choice(k_levels, b.level, f);
    each_choice(k_reasons, b.reason, f);
    f(b.calm_since);
    f(b.substep);
    for (auto* v : {&b.position, &b.velocity, &b.angular_velocity, &b.force, &b.moment})
      for (int k = 0; k < 3; ++k) f((*v)[k]);
    for (int k = 0; k < 4; ++k) f(b.rotation.coeffs()[k]);
    for (auto* v : {&b.amplitude, &b.rate, &b.load})
      for (int k = 0; k < k_modes; ++k) f((*v)[k]);
  }
  for (auto& e : s.elements) {
    each_choice(k_hinges, e.hinge, f);
    for (auto* strain : {&e.offset.gamma, &e.offset.kappa})
      for (int k = 0; k < 3; ++k) f((*strain)[k]);
  }
  for (int k = 0; k < 3; ++k) f(s.floor_displacement[k]);
  for (int k = 0; k < 3; ++k) f(s.floor_velocity[k]);
  f(s.step_size);
  f(s.load_factor);
  f(s.candidate_margin);
  each_choice(contact_laws(), s.law, f);
  auto& e = s.energy;
  for (auto* number :
       {&e.input, &e.kinetic, &e.strain, &e.gravity, &e.contact, &e.friction, &e.normal_damping, &e.numerical,
        &e.plastic, &e.damping, &e.model_switch, &e.start_total, &e.largest})
    f(*number);
  if (s.anchors.empty()) return;  // a checkpoint of a model without anchors has no place for them
  f(e.anchor);
  f(e.released);
  for (auto& anchor : s.anchors) {
    f(anchor.length);
    each_choice(k_holds, anchor.hold, f);
  }
}

// The same of a body on the level planar; its time is that of the state.
template <class AnyBlock, class F>
void each_block_number(AnyBlock& b, F f) {
  auto& m = b.motion;
  each_choice(k_block_modes, m.mode, f);
  each_choice(k_sides, m.side, f);
  each_choice(k_slips, m.slip, f);
  each_choice(k_flags, m.undecided, f);
  for (auto* number :
       {&m.x, &m.z, &m.tilt, &m.x_velocity, &m.z_velocity, &m.rate, &b.static_friction, &b.kinetic_friction})
    f(*number);
  for (auto* v : {&b.along, &b.floor})
    for (int k = 0; k < 3; ++k) f((*v)[k]);
}

// Pairs of elements as numbers of eight bytes, as in a checkpoint.
double as_number(const ElementPair& pair) {
  return bits_as<double>(pair.key());
}

ElementPair as_pair(double number) {
  const auto bits = bits_as<std::int64_t>(number);
  return {static_cast<int>(bits >> 32), static_cast<int>(bits & 0xffffffff)};
}

// Calls f on the counts and entries of what touches, which differ from state to state, on the blocks and on
// the peak stresses; before these stand the indices of their bodies, of the latter behind those of all.
template <class F>
void each_touching(const State& s, F f) {
  f(bits_as<double>(static_cast<std::int64_t>(s.candidate_pairs.size())));
  for (const ElementPair& pair : s.candidate_pairs) f(as_number(pair));
  f(bits_as<double>(static_cast<std::int64_t>(s.member_sticks.size())));
  for (const MemberStick& stick : s.member_sticks) {
    f(as_number(stick.elements));
    f(bits_as<double>(static_cast<std::int64_t>(stick.place)));
    for (int k = 0; k < 3; ++k) f(stick.stick[k]);
  }
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    if (traits(s.bodies[b].level).has_block) {
      f(bits_as<double>(static_cast<std::int64_t>(b)));
      each_block_number(s.blocks[b], f);
    }
    if (s.bodies[b].peak_stress > 0) {
      f(bits_as<double>(static_cast<std::int64_t>(s.bodies.size() + b)));
      f(s.bodies[b].peak_stress);
    }
  }
}

// Inverse of each_touching; false when there are too few or too many numbers.
bool read_touching(std::span<const double> numbers, const Model& model, State& s) {
  std::size_t next = 0;
  const auto read = [&] { return next < numbers.size() ? numbers[next++] : (next = numbers.size() + 1, 0.); };
  const auto read_count = [&](std::size_t width) {
    const auto count = bits_as<std::int64_t>(read());
    const bool fits = count >= 0 && next <= numbers.size() &&
                      static_cast<std::size_t>(count) <= (numbers.size() - next) / width;
    if (!fits) next = numbers.size() + 1;
    return fits ? static_cast<std::size_t>(count) : 0;
  };
  const int elements = static_cast<int>(model.elements.size()),
            parts = elements + static_cast<int>(model.panels.size());
  const auto is_pair = [&](const ElementPair& pair) {
    return pair.a >= 0 && pair.a < elements && pair.b >= 0 && pair.b < parts;
  };
  std::vector<ElementPair> pairs(read_count(1));
  for (ElementPair& pair : pairs) {
    pair = as_pair(read());
    if (!is_pair(pair)) return false;
  }
  s.candidate_pairs = std::move(pairs);
  s.member_sticks.resize(read_count(5));
  for (MemberStick& stick : s.member_sticks) {
    stick.elements = as_pair(read());
    const auto place = bits_as<std::int64_t>(read());
    if (!is_pair(stick.elements) || place < 0 || place > 4) return false;
    stick.place = static_cast<int>(place);
    for (int k = 0; k < 3; ++k) stick.stick[k] = read();
  }
  while (next < numbers.size()) {
    const std::size_t index = bits_as<std::uint64_t>(read()), bodies = s.bodies.size();
    if (index >= 2 * bodies) return false;
    if (index >= bodies)
      s.bodies[index - bodies].peak_stress = read();
    else
      each_block_number(s.blocks[index], [&](double& x) { x = read(); });
  }
  return next == numbers.size();
}

void resize(const Model& model, State& state) {
  const std::size_t n = model.node_position.size();
  for (auto* array : {&state.position, &state.velocity, &state.angular_velocity, &state.acceleration,
                      &state.angular_acceleration, &state.algorithmic_acceleration,
                      &state.algorithmic_angular_acceleration})
    array->assign(n, Vec3::Zero());
  state.rotation.assign(n, Quat::Identity());
  state.stick.assign(model.contact_points.size() * model.planes.size(), Vec3::Zero());
  state.elements.assign(model.elements.size(), {});
  state.bodies.assign(model.bodies.size(), {});
  state.blocks.assign(model.bodies.size(), {});
  for (const Anchor& anchor : model.anchors) state.anchors.push_back({.length = anchor.length});
}

}  // namespace

State start_state(const Model& model, const std::vector<BodyStart>& starts) {
  State state;
  resize(model, state);
  for (int i = 0; i < model.node_total(); ++i) {
    const BodyStart& start = starts[model.node_body[i]];
    const Quat turn = exp_quaternion(start.rotation);
    const auto moved = [&](const Vec3& x) { return Vec3(start.pivot + turn * (x - start.pivot)); };
    const Vec3 centre = moved(model.bodies[model.node_body[i]].centre_of_gravity);
    state.position[i] = moved(model.node_position[i]);
    state.rotation[i] = turn;
    state.velocity[i] = start.velocity + start.angular_velocity.cross(state.position[i] - centre);
    state.angular_velocity[i] = turn.conjugate() * start.angular_velocity;
  }
  for (const Support& support : model.supports)
    for (int k = 0; k < 3; ++k) {
      if (support.fixed >> k & 1) state.velocity[support.node][k] = 0;
      if (support.fixed >> (3 + k) & 1) {
        Vec3 omega = state.rotation[support.node] * state.angular_velocity[support.node];
        omega[k] = 0;
        state.angular_velocity[support.node] = state.rotation[support.node].conjugate() * omega;
      }
    }
  return state;
}

std::vector<double> pack(const State& state) {
  std::vector<double> numbers;
  numbers.reserve(25 * state.position.size() + 3 * state.stick.size() + 7 * state.elements.size() +
                  (23 + 3 * k_modes) * state.bodies.size() + state.candidate_pairs.size() +
                  5 * state.member_sticks.size() + 2 * state.anchors.size() + 26);
  numbers.push_back(bits_as<double>(state.step));
  each_number(state, [&](double x) { numbers.push_back(x); });
  each_touching(state, [&](double x) { numbers.push_back(x); });
  return numbers;
}

State unpack(const Model& model, std::span<const double> numbers) {
  State state;
  resize(model, state);
  std::size_t count = 1;
  each_number(state, [&](double&) { ++count; });
  if (count > numbers.size() || !read_touching(numbers.subspan(count), model, state))
    throw std::invalid_argument("a checkpoint of another model");
  state.step = bits_as<std::int64_t>(numbers[0]);
  std::size_t next = 1;
  each_number(state, [&](double& x) { x = numbers[next++]; });
  for (BlockState& block : state.blocks) block.motion.time = state.time;
  return state;
}

namespace {

// FNV-1a over numbers of eight bytes, the lowest byte first.
class Hash {
 public:
  void mix(double number) {
    const auto bits = bits_as<std::uint64_t>(number);
    for (int shift = 0; shift < 64; shift += 8) {
      sum_ ^= bits >> shift & 0xff;
      sum_ *= 1099511628211ull;
    }
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 14695981039346656037ull;
};

}  // namespace

double EnergyLedger::balance_error() const {
  return largest > 0 ? std::abs(unexplained()) / largest : 0;
}

void EnergyLedger::open(const BodyEnergy& held) {
  kinetic = held.kinetic;
  strain = held.strain;
  contact = held.contact;
  anchor = held.anchor;
  start_total = held.sum();
  largest = std::max(kinetic, strain + contact + anchor);
}

void EnergyLedger::close(const StepEnergy& exchanged, const BodyEnergy& held) {
  input += exchanged.input;
  gravity += exchanged.gravity;
  friction += exchanged.friction;
  normal_damping += exchanged.normal_damping;
  numerical += exchanged.numerical;
  plastic += exchanged.plastic;
  damping += exchanged.damping;
  kinetic = held.kinetic;
  strain = held.strain;
  contact = held.contact;
  anchor = held.anchor;
  largest = std::max({largest, std::abs(input), kinetic, std::abs(gravity), strain + contact + anchor});
}

std::uint64_t hash(const State& state) {
  Hash hash;
  hash.mix(bits_as<double>(state.step));
  each_number(state, [&](double x) { hash.mix(x); });
  each_touching(state, [&](double x) { hash.mix(x); });
  return hash.sum();
}

std::uint64_t hash(std::span<const double> packed) {
  Hash hash;
  for (const double number : packed) hash.mix(number);
  return hash.sum();
}

namespace {

// Sums that are finite when all their numbers are, and not too large; four, as each waits for itself.
class Finiteness {
 public:
  void look(const double* x, std::size_t count) {
    std::size_t k = 0;
    for (; k + 16 <= count; k += 16) {
      look_at(load(x + k), 0);
      look_at(load(x + k + 4), 1);
      look_at(load(x + k + 8), 2);
      look_at(load(x + k + 12), 3);
    }
    for (; k + 4 <= count; k += 4) look_at(load(x + k), 1);
    for (; k < count; ++k) look_at(Four(x[k]), 2);
  }
  void look(const BodyState& b, bool modes) {
    static_assert(k_modes % 4 == 0);
    for (int k = 0; modes && k < k_modes; k += 4) {
      look_at(load(b.amplitude.data() + k), 1);
      look_at(load(b.rate.data() + k), 2);
      look_at(load(b.load.data() + k), 3);
    }
    look_at(load(b.rotation.coeffs().data()), 0);
    look_at(b.calm_since, b.substep, total(b.position), total(b.velocity), 1);
    look_at(total(b.angular_velocity), total(b.force), total(b.moment), b.peak_stress, 2);
  }
  void look(const BlockState& b) {
    const planar::State& m = b.motion;
    look_at(m.x, m.z, m.tilt, m.rate, 0);
    look_at(m.x_velocity, m.z_velocity, b.static_friction, b.kinetic_friction, 1);
    look_at(total(b.along), total(b.floor), m.time, 0, 2);
  }
  void look_at_rest(const State& s) {
    static_assert(sizeof(EnergyLedger) == 15 * sizeof(double));
    look(&s.energy.input, 15);
    look_at(total(s.floor_displacement), total(s.floor_velocity), s.time + s.step_size,
            s.load_factor + s.candidate_margin, 0);
    for (const MemberStick& stick : s.member_sticks) look_at(Four(total(stick.stick)), 0);
    for (const AnchorState& anchor : s.anchors) look_at(Four(anchor.length), 0);
    for (std::size_t b = 0; b < s.blocks.size(); ++b)
      if (traits(s.bodies[b].level).has_block) look(s.blocks[b]);
  }
  bool all() const {
    const Four all = (sums_[0] + sums_[1]) + (sums_[2] + sums_[3]);
    return !any_above(all - all, 0);
  }

 private:
  static double total(const Vec3& v) { return v.x() + v.y() + v.z(); }
  void look_at(Four x, int k) { sums_[k] = mul_add(x, Four(k_overflow), sums_[k]); }
  void look_at(double a, double b, double c, double d, int k) { look_at(Four(Four::Vector{a, b, c, d}), k); }

  Four sums_[4]{0., 0., 0., 0.};
};

}  // namespace

bool is_finite(const State& s, bool nodes) {
  Finiteness found;
  if (nodes) {
    for (const auto* array :
         {&s.position, &s.velocity, &s.angular_velocity, &s.acceleration, &s.angular_acceleration,
          &s.algorithmic_acceleration, &s.algorithmic_angular_acceleration})
      if (!array->empty()) found.look(array->front().data(), 3 * array->size());
    static_assert(sizeof(Quat) == 4 * sizeof(double) && sizeof(ElementState) == 7 * sizeof(double));
    if (!s.rotation.empty()) found.look(s.rotation.front().coeffs().data(), 4 * s.rotation.size());
    if (!s.elements.empty())  // load() may alias
      found.look(reinterpret_cast<const double*>(s.elements.data()), 7 * s.elements.size());
  }
  for (const BodyState& b : s.bodies) found.look(b, true);
  if (!s.stick.empty()) found.look(s.stick.front().data(), 3 * s.stick.size());
  found.look_at_rest(s);
  return found.all();
}

bool moves_finite(const State& s) {
  Finiteness found;
  for (const BodyState& b : s.bodies) found.look(b, traits(b.level).has_modes);
  found.look_at_rest(s);
  return found.all();
}

int body_not_finite(const Model& model, const State& s) {
  const auto is_odd = [](const auto& numbers) {
    return !(numbers.array().abs() <= k_largest_number).all();  // nor is NaN below it
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyState& own = s.bodies[b];
    if (is_odd(own.position) || is_odd(own.rotation.coeffs()) || is_odd(own.velocity) ||
        is_odd(own.angular_velocity) || is_odd(own.force) || is_odd(own.moment) || is_odd(own.amplitude) ||
        is_odd(own.rate) || is_odd(own.load))
      return static_cast<int>(b);
    if (const planar::State& m = s.blocks[b].motion;
        traits(own.level).has_block &&
        is_odd(Eigen::Array<double, 6, 1>{m.x, m.z, m.tilt, m.x_velocity, m.z_velocity, m.rate}))
      return static_cast<int>(b);
    const Body& body = model.bodies[b];
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      if (is_odd(s.position[i]) || is_odd(s.rotation[i].coeffs()) || is_odd(s.velocity[i]) ||
          is_odd(s.angular_velocity[i]) || is_odd(s.acceleration[i]) || is_odd(s.angular_acceleration[i]) ||
          is_odd(s.algorithmic_acceleration[i]) || is_odd(s.algorithmic_angular_acceleration[i]))
        return static_cast<int>(b);
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
      if (is_odd(s.elements[e].offset.gamma) || is_odd(s.elements[e].offset.kappa))
        return static_cast<int>(b);
  }
  return -1;
}

namespace {

template <class T>
void copy_array(const std::vector<T>& from, std::vector<T>& to) {
  if (from.size() != to.size()) to.resize(from.size());
  copy_values(from.data(), from.size(), to.data());
}

// Calls f(member) for the arrays that a step changes where no node moves.
template <class F>
void each_moved_array(F f) {
  f(&State::bodies);
  f(&State::blocks);
  f(&State::stick);
  f(&State::member_sticks);
  f(&State::anchors);
}

// For those that one changes where nodes move.
template <class F>
void each_node_array(F f) {
  f(&State::position);
  f(&State::rotation);
  f(&State::velocity);
  f(&State::angular_velocity);
  f(&State::acceleration);
  f(&State::angular_acceleration);
  f(&State::algorithmic_acceleration);
  f(&State::algorithmic_angular_acceleration);
  f(&State::elements);
}

// And for the rest.
template <class F>
void each_moved_number(F f) {
  f(&State::time);
  f(&State::step);
  f(&State::candidate_pairs);
  f(&State::candidate_margin);
  f(&State::floor_displacement);
  f(&State::floor_velocity);
  f(&State::step_size);
  f(&State::load_factor);
  f(&State::law);
  f(&State::energy);
}

}  // namespace

void copy(const State& from, State& to, bool nodes) {
  const auto array = [&](auto member) { copy_array(from.*member, to.*member); };
  if (nodes) each_node_array(array);
  each_moved_array(array);
  each_moved_number([&](auto member) { to.*member = from.*member; });
}

void take(State& from, State& to, bool nodes) {
  if (nodes) {
    std::swap(from, to);
    return;
  }
  const auto exchange = [&](auto member) { std::swap(from.*member, to.*member); };
  each_moved_array(exchange);
  each_moved_number(exchange);
}

}  // namespace topple
