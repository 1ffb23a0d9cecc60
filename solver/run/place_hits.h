// What falls on people.
#pragma once

#include <span>
#include <vector>

#include "solver/model/model.h"
#include "solver/model/room.h"

namespace topple {

/// m: how high a person is whom something hits.
inline constexpr double k_person_height = 1.7;

/// Who hit the person of one place so far.
struct PlaceOutcome {
  struct Hit {
    int body;
    double time;  ///< s, when it first overlapped the person in plan, below k_person_height
  };
  std::vector<Hit> hits;  ///< each body once
};

/// Takes in an instant. position: per node of the model, m, floor's frame; places: one per place of the room.
void observe_hits(const Room& room, const Model& model, std::span<const Vec3> position, double time,
                  std::vector<PlaceOutcome>& places);

}  // namespace topple
