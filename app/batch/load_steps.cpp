#include "app/batch/load_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/support/terms.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json finite(double x) {
  return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

/// Words of a loss of stability: in summaries, and for people.
struct LossWords {
  Stability::Loss loss;
  const char *word, *words;
};
constexpr LossWords k_losses[] = {
    {Stability::Loss::limit_point, "limit-point", "past a limit point"},
    {Stability::Loss::buckling, "buckling", "buckles, sideways to its loads"},
    {Stability::Loss::mechanism, "mechanism", "a mechanism"},
    {Stability::Loss::fracture, "fracture", "a section breaks, the rest does not carry"}};

}  // namespace

ordered_json load_steps_json(const Run& run) {
  ordered_json list = ordered_json::array();
  const Model& model = run.setup().model;
  for (const LoadStep& step : run.load_steps()) {
    const Stability& s = step.stability;
    const bool known = s.negative_pivots >= 0;
    ordered_json one{{"factor", finite(step.factor)},
                     {"converged", step.converged},
                     {"stable", known ? ordered_json(s.stable()) : nullptr},
                     {"negative_pivots", known ? ordered_json(s.negative_pivots) : nullptr},
                     {"loss", nullptr},
                     {"mode", nullptr}};
    const auto* const words = std::ranges::find(k_losses, s.loss, &LossWords::loss);
    if (words != std::end(k_losses)) one["loss"] = words->word;
    if (s.node >= 0) {
      const int body = model.node_body[s.node];
      const Member* const within = member_within(model, s.node);
      one["mode"] = {
          {"body", model.bodies[body].name},
          {"node", s.node - model.bodies[body].first_node},
          {"within", within == nullptr ? ordered_json(nullptr) : ordered_json(within->name)},
          {"direction", {finite(s.direction.x()), finite(s.direction.y()), finite(s.direction.z())}}};
    }
    list.push_back(one);
  }
  return list;
}

std::string loss_in_words(const ordered_json& step) {
  if (step["loss"].is_null()) return "";
  const std::string word = step["loss"].get<std::string>();
  const LossWords& loss =
      *std::ranges::find(k_losses, word, [](const LossWords& w) { return std::string(w.word); });
  const int pivots = step["negative_pivots"].is_null() ? 0 : step["negative_pivots"].get<int>();
  std::string out =
      pivots > 0 ? fmt::format(", unstable in {} direction{}", pivots, pivots > 1 ? "s" : "") : "";
  out += std::string(": ") + loss.words;
  if (loss.loss == Stability::Loss::mechanism && !step["converged"].get<bool>())
    out += ", or its path is nearly flat";
  if (const ordered_json& mode = step["mode"]; !mode.is_null()) {
    const ordered_json within = mode.value("within", ordered_json());
    const std::string place = within.is_null() ? fmt::format("node {}", mode["node"].get<int>())
                                               : "the inside of member \"" + within.get<std::string>() + "\"";
    const auto part = [&](int k) { return std::round(100 * mode["direction"][k].get<double>()) / 100 + 0.; };
    out += fmt::format("; {} of \"{}\" moves most, along ({:.2f}, {:.2f}, {:.2f})", place,
                       mode["body"].get<std::string>(), part(0), part(1), part(2));
  }
  return out;
}

namespace {

/// Of an object; NaN: it has no such number.
double number_at(const ordered_json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? at->get<double>() : std::nan("");
}

Stability stability_in(const ordered_json& step, const Model& model) {
  Stability out;
  if (const double pivots = number_at(step, "negative_pivots"); pivots >= 0 && pivots < 1e9)
    out.negative_pivots = static_cast<int>(pivots);
  const std::string word =
      step.value("loss", ordered_json()).is_string() ? step["loss"].get<std::string>() : "";
  for (const LossWords& words : k_losses)
    if (word == words.word) out.loss = words.loss;
  const ordered_json mode = step.value("mode", ordered_json());
  if (!mode.is_object()) return out;
  const double node = number_at(mode, "node");
  for (const Body& body : model.bodies)
    if (mode.value("body", ordered_json()) == body.name && node >= 0 && node < body.node_count)
      out.node = body.first_node + static_cast<int>(node);
  return out;
}

}  // namespace

std::vector<LoadStep> load_steps_in(const std::string& summary, const Model& model) {
  std::vector<LoadStep> out;
  const ordered_json json = ordered_json::parse(summary, nullptr, false);
  const ordered_json steps = json.is_object() ? json.value("static", ordered_json()) : ordered_json();
  if (!steps.is_array()) return out;
  for (const ordered_json& step : steps) {
    if (!step.is_object()) return {};
    out.push_back({number_at(step, "factor"), step.value("converged", ordered_json()) == true,
                   stability_in(step, model)});
  }
  return out;
}

std::vector<Stability> stabilities(std::span<const LoadStep> steps) {
  std::vector<Stability> out;
  for (const LoadStep& step : steps) {
    if (step.converged) {
      out.push_back(step.stability);
    } else if (!out.empty() && step.stability.loss != Stability::Loss::none) {
      const int pivots = out.back().negative_pivots;
      out.back() = step.stability;
      out.back().negative_pivots = pivots;
    }
  }
  return out;
}

}  // namespace topple::app
