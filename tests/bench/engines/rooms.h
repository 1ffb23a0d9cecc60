// Rooms of many boxes: scenes of topple, and the same boxes in a rigid-body engine.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/run/run.h"

namespace topple::bench {

struct Room {
  std::string name, about;
  Setup setup;
  const char* reference;              ///< what errors are measured from
  Setup (*refine)(const Setup& own);  ///< the setup of the reference
};
std::vector<Room> rooms();

/// One engine with one setting in one room, at t = 0.
class RoomSimulation {
 public:
  virtual ~RoomSimulation() = default;
  virtual bool advance() = 0;               ///< takes one step; false: the engine gave up
  virtual double time() const = 0;          ///< s
  virtual long steps() const = 0;           ///< since t = 0
  virtual double tilt(int body) const = 0;  ///< rad, of its vertical axis, 0..pi
  virtual std::string failure() const = 0;  ///< why it gave up
  /// What it says itself about its error, over the critical angle.
  virtual std::optional<double> estimate() const { return {}; }
};

struct RoomSetting {
  std::string engine, version, words;
  double step;  ///< s; 0: the scene's
  std::function<std::unique_ptr<RoomSimulation>(const Setup&)> start;
};
RoomSetting topple_room_setting();
RoomSetting topple_room_reference(const Room& room);
/// Bouncing as the scene does, too, where it does.
std::vector<RoomSetting> mujoco_room_settings(const Setup& setup);

/// All settings in each room, or in the one that is named. Writes FOLDER/rooms.csv and prints a table of
/// each.
void run_rooms(const std::filesystem::path& folder, const std::string& only);

}  // namespace topple::bench
