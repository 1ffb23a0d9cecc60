#include <algorithm>

#include "bench/engines/rooms.h"

namespace topple::bench {
namespace {

class ToppleRoom : public RoomSimulation {
 public:
  explicit ToppleRoom(const Setup& setup) : setup_(setup) {}

  bool advance() override { return run_.status().ok() && run_.advance().ok(); }
  double time() const override { return run_.time(); }
  long steps() const override { return run_.step(); }
  double tilt(int body) const override { return run_.outcome().bodies()[body].tilt; }
  std::string failure() const override { return run_.status().message(setup_.model); }
  std::optional<double> estimate() const override {
    std::optional<double> greatest;
    for (const BodyOutcome& body : run_.outcome().bodies())
      for (const LevelChange& change : body.level_changes)
        greatest = std::max(greatest.value_or(0), change.error_estimate);
    return greatest;
  }

 private:
  Setup setup_;
  Run run_{setup_};
};

}  // namespace

RoomSetting topple_room_setting() {
  return {"topple", TOPPLE_VERSION, "as the program runs it", 0,
          [](const Setup& setup) { return std::make_unique<ToppleRoom>(setup); }};
}

RoomSetting topple_room_reference(const Room& room) {
  return {"topple", TOPPLE_VERSION, std::string("reference: ") + room.reference, 0,
          [refine = room.refine](const Setup& setup) { return std::make_unique<ToppleRoom>(refine(setup)); }};
}

}  // namespace topple::bench
