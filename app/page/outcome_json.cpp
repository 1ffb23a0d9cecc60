#include "app/page/outcome_json.h"

#include <cmath>

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

Json maybe_json(const std::optional<double>& x) {
  return x && std::isfinite(*x) ? Json(*x) : Json(nullptr);
}

std::optional<double> maybe(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

}  // namespace

Json ends_json(const std::vector<BodyEnd>& ends) {
  Json list = Json::array();
  for (const BodyEnd& end : ends)
    list.push_back({{"name", end.name},
                    {"overturn_time_s", maybe_json(end.overturned)},
                    {"peak_tilt_deg", maybe_json(end.peak_tilt)},
                    {"critical_tilt_deg", maybe_json(end.critical)}});
  return list;
}

std::vector<BodyEnd> ends_from(const Json& list) {
  std::vector<BodyEnd> ends;
  for (const Json& one : list)
    ends.push_back({one.at("name").get<std::string>(), maybe(one.at("overturn_time_s")),
                    maybe(one.at("peak_tilt_deg")).value_or(0), maybe(one.at("critical_tilt_deg"))});
  return ends;
}

Json hits_json(const std::vector<PlaceOutcome>& places) {
  Json list = Json::array();
  for (std::size_t p = 0; p < places.size(); ++p)
    for (const PlaceOutcome::Hit& hit : places[p].hits)
      list.push_back({{"place", p}, {"body", hit.body}, {"time_s", hit.time}});
  return list;
}

std::vector<PlaceOutcome> hits_from(const Json& list, std::size_t places) {
  std::vector<PlaceOutcome> out(places);
  for (const Json& one : list)
    out.at(one.at("place").get<std::size_t>())
        .hits.push_back({one.at("body").get<int>(), one.at("time_s").get<double>()});
  return out;
}

}  // namespace topple::app
