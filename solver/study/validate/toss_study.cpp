#include "solver/study/validate/toss_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/common/errors.h"
#include "solver/study/common/axis.h"

namespace topple::study {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t k_toss_folds = 10;
constexpr std::uint64_t k_toss_draws = 400;
constexpr double k_in_degrees = 180 / k_pi;

double six_digits(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

ordered_json list_of(const std::vector<double>& values) {
  ordered_json out = ordered_json::array();
  for (const double value : values) out.push_back(six_digits(value));
  return out;
}

double cost_of(const std::optional<TossErrors>& errors) {
  return errors ? std::min(errors->position / (2 * TossedCube::half_edge) + errors->angle, k_astray)
                : k_astray;
}

ordered_json quantile_json(const TossScores& scores, double Quantiles::*which) {
  return {{"place_m", six_digits(scores.place.*which)},
          {"place_share", six_digits(scores.place_share.*which)},
          {"yaw_deg", six_digits(scores.yaw.*which)},
          {"rest_s", six_digits(scores.rest.*which)},
          {"position_m", six_digits(scores.position.*which)},
          {"angle_deg", six_digits(scores.angle.*which)}};
}

double number_in(const ordered_json& json, const char* key, double least, double most) {
  const double value = json.at(key).get<double>();
  if (!(value >= least && value <= most))
    throw io::InputError(fmt::format("{}: {:g} is outside {:g}..{:g}", key, value, least, most));
  return value;
}

}  // namespace

const std::vector<CubeContact>& contact_grid() {
  static const std::vector<CubeContact> grid = [] {
    std::vector<CubeContact> all;
    for (int friction = 12; friction <= 24; ++friction)
      for (const double restitution : {0., 0.05, 0.1, 0.125, 0.15, 0.2, 0.25, 0.3})
        all.push_back({friction / 100., restitution});
    return all;
  }();
  return grid;
}

std::string run_toss_case(const std::vector<Toss>& tosses, const CubeContact& contact, double offset,
                          const std::function<bool()>& give_up) {
  ordered_json row = ordered_json::array();
  for (const Toss& toss : tosses) {
    const std::vector<CubePose> computed = computed_toss(toss, contact, offset, give_up);
    if (give_up()) return "";
    if (computed.empty()) {
      row.push_back(nullptr);
      continue;
    }
    const TossErrors e = errors_of(toss, computed);
    row.push_back({six_digits(e.place), six_digits(e.place_share), e.face, six_digits(e.yaw),
                   six_digits(e.rest), six_digits(e.position), six_digits(e.angle), list_of(e.position_at),
                   list_of(e.angle_at)});
  }
  return row.dump();
}

TossOutcomes outcomes_in(const std::string& row) {
  TossOutcomes out;
  for (const ordered_json& one : ordered_json::parse(row)) {
    out.emplace_back();
    if (one.is_null()) continue;
    out.back() = TossErrors{one[0],
                            one[1],
                            one[2],
                            one[3],
                            one[4],
                            one[5],
                            one[6],
                            one[7].get<std::vector<double>>(),
                            one[8].get<std::vector<double>>()};
  }
  return out;
}

std::size_t best_contact(const std::vector<TossOutcomes>& grid, const std::vector<double>& weight) {
  std::vector<double> cost(grid.size());
  for (std::size_t k = 0; k < grid.size(); ++k)
    for (std::size_t i = 0; i < weight.size(); ++i)
      if (weight[i] > 0) cost[k] += weight[i] * cost_of(grid[k][i]);
  return static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
}

/// Bootstrap: B. Efron, Annals of Statistics 7, 1979, 1-26.
TossFit fit_tosses(const std::vector<TossOutcomes>& grid, double offset) {
  const std::size_t count = grid.front().size();
  TossFit fit;
  fit.offset = offset, fit.tosses = static_cast<int>(count);
  fit.contact = contact_grid()[best_contact(grid, std::vector<double>(count, 1))];
  std::vector<double> friction, restitution;
  for (std::uint64_t n = 0; n < k_toss_draws; ++n) {
    std::vector<double> weight(count);
    for (std::uint64_t i = 0; i < count; ++i)
      ++weight[static_cast<std::size_t>(scattered(n, i) * static_cast<double>(count))];
    const CubeContact& best = contact_grid()[best_contact(grid, weight)];
    friction.push_back(best.friction), restitution.push_back(best.restitution);
  }
  const auto set = [](std::vector<double>& values, double& low, double& high) {
    std::ranges::sort(values);
    low = values[values.size() / 40], high = values[values.size() - 1 - values.size() / 40];
  };
  set(friction, fit.low.friction, fit.high.friction);
  set(restitution, fit.low.restitution, fit.high.restitution);
  return fit;
}

TossOutcomes cross_validated(const std::vector<TossOutcomes>& grid) {
  const std::size_t count = grid.front().size();
  TossOutcomes out(count);
  for (std::size_t fold = 0; fold < k_toss_folds; ++fold) {
    std::vector<double> weight(count, 1);
    for (std::size_t i = fold; i < count; i += k_toss_folds) weight[i] = 0;
    const TossOutcomes& best = grid[best_contact(grid, weight)];
    for (std::size_t i = fold; i < count; i += k_toss_folds) out[i] = best[i];
  }
  return out;
}

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return std::lerp(values[low], values[high], place - static_cast<double>(low));
  };
  return {at(0.5), at(0.9)};
}

TossScores scored_tosses(const TossOutcomes& outcomes) {
  TossScores out;
  out.tosses = static_cast<int>(outcomes.size());
  std::vector<double> place, share, yaw, rest, position, angle;
  std::array<std::vector<double>, k_instants.size()> position_at, angle_at;
  for (const std::optional<TossErrors>& one : outcomes) {
    if (!one) {
      ++out.failed;
      continue;
    }
    out.face_right += one->face;
    place.push_back(one->place), share.push_back(one->place_share), rest.push_back(one->rest);
    position.push_back(one->position), angle.push_back(one->angle * k_in_degrees);
    if (one->face) yaw.push_back(one->yaw * k_in_degrees);
    for (std::size_t n = 0; n < one->position_at.size(); ++n)
      position_at[n].push_back(one->position_at[n]), angle_at[n].push_back(one->angle_at[n] * k_in_degrees);
  }
  out.face_interval = wilson(out.face_right, out.tosses);
  out.place = quantiles_of(place), out.place_share = quantiles_of(share), out.yaw = quantiles_of(yaw);
  out.rest = quantiles_of(rest), out.position = quantiles_of(position), out.angle = quantiles_of(angle);
  for (std::size_t n = 0; n < k_instants.size(); ++n)
    if (!position_at[n].empty())
      out.over_time.push_back({k_instants[n], static_cast<int>(position_at[n].size()),
                               quantiles_of(position_at[n]), quantiles_of(angle_at[n])});
  return out;
}

ordered_json scores_json(const TossScores& scores) {
  ordered_json over_time = ordered_json::array();
  for (const TossScores::Instant& at : scores.over_time)
    over_time.push_back({{"time_s", at.time},
                         {"tosses", at.tosses},
                         {"position_m", {six_digits(at.position.median), six_digits(at.position.ninetieth)}},
                         {"angle_deg", {six_digits(at.angle.median), six_digits(at.angle.ninetieth)}}});
  return {{"median", quantile_json(scores, &Quantiles::median)},
          {"face_right", six_digits(static_cast<double>(scores.face_right) / scores.tosses)},
          {"face_interval", {six_digits(scores.face_interval.low), six_digits(scores.face_interval.high)}},
          {"ninetieth", quantile_json(scores, &Quantiles::ninetieth)},
          {"failed", scores.failed},
          {"over_time", over_time}};
}

ordered_json tosses_json(const TossFit& fit, const TossResults& results) {
  ordered_json out{
      {"tosses", results.of_fitted.tosses}, {"fitted_here", results.fitted_here}, {"fitted_on", fit.tosses}};
  out.update(scores_json(results.of_fitted));
  out["friction"] = fit.contact.friction, out["restitution"] = fit.contact.restitution;
  out["offset_m"] = six_digits(fit.offset);
  out["published"] = scores_json(results.of_published);
  out["published"]["friction"] = k_published.friction;
  out["published"]["restitution"] = k_published.restitution;
  return out;
}

ordered_json toss_rows(const std::vector<Toss>& tosses, const TossResults& results) {
  ordered_json rows = ordered_json::array();
  for (const auto& [name, outcomes] :
       {std::pair{"fitted", &results.fitted}, std::pair{"published", &results.published}})
    for (std::size_t i = 0; i < tosses.size(); ++i) {
      const std::optional<TossErrors>& e = (*outcomes)[i];
      const auto cell = [&](double TossErrors::*which, double unit) {
        return e ? ordered_json(six_digits((*e).*which * unit)) : ordered_json(nullptr);
      };
      rows.push_back({{"parameters", name},
                      {"toss", tosses[i].number},
                      {"place_m", cell(&TossErrors::place, 1)},
                      {"place_share", cell(&TossErrors::place_share, 1)},
                      {"face_right", e ? ordered_json(int{e->face}) : ordered_json(nullptr)},
                      {"yaw_deg", cell(&TossErrors::yaw, k_in_degrees)},
                      {"rest_s", cell(&TossErrors::rest, 1)},
                      {"position_m", cell(&TossErrors::position, 1)},
                      {"angle_deg", cell(&TossErrors::angle, k_in_degrees)}});
    }
  return rows;
}

ordered_json fit_as_json(const TossFit& fit) {
  return {
      {"kind", "tosses"},
      {"rule",
       fmt::format(
           "least mean over the tosses of position over the edge plus angle in rad, both means over time, {} "
           "at most, over a grid; the offset is the median of the last heights over half an edge",
           k_astray)},
      {"tosses", fit.tosses},
      {"friction", fit.contact.friction},
      {"friction_95", {fit.low.friction, fit.high.friction}},
      {"restitution", fit.contact.restitution},
      {"restitution_95", {fit.low.restitution, fit.high.restitution}},
      {"offset_m", six_digits(fit.offset)}};
}

TossFit toss_fit_from_json(const std::string& text, const std::string& name) {
  try {
    const ordered_json json = ordered_json::parse(text);
    if (json.at("kind") != "tosses") throw io::InputError("kind: is not tosses");
    TossFit fit;
    fit.tosses = json.at("tosses").get<int>();
    fit.contact = {number_in(json, "friction", 0, 1.5), number_in(json, "restitution", 0, 1)};
    fit.offset = number_in(json, "offset_m", -0.1, 0.1);
    return fit;
  } catch (const ordered_json::exception& error) {
    throw io::InputError(fmt::format("{}: is no file of a fit: {}", name, error.what()));
  } catch (const io::InputError& error) {
    throw io::InputError(fmt::format("{}: {}", name, error.what()));
  }
}

std::string fingerprint(const std::vector<Toss>& tosses) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
  };
  for (const Toss& toss : tosses) {
    add(toss.number);
    for (const double value :
         {toss.velocity.x(), toss.velocity.y(), toss.velocity.z(), toss.angular_velocity.x(),
          toss.angular_velocity.y(), toss.angular_velocity.z()})
      add(value);
    for (const CubePose& row : toss.rows)
      for (const double value : {row.time, row.place.x(), row.place.y(), row.place.z(), row.rotation.w(),
                                 row.rotation.x(), row.rotation.y(), row.rotation.z()})
        add(value);
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace topple::study
