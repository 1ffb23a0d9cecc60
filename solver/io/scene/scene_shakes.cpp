// [[shake]] of a scene.
#include <algorithm>
#include <cmath>

#include "solver/io/accelerogram/accelerogram_file.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/scene_file.h"
#include "solver/io/scene/scene_read.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

void read_taper(const Entry& entry, Shake& shake) {
  shake.taper = entry.number("taper");
  const double cycles =
      traits(shake.kind).sweeps ? shake_turns(shake, shake.start + shake.duration) : shake.cycles;
  if (cycles > 0 && 2 * shake.taper > cycles)
    entry.fail("taper", "rise and fall together are longer than the cycles");
}

void read_frequency(const Entry& entry, Shake& shake) {
  const std::vector<double> frequency = entry.numbers("frequency");
  if (traits(shake.kind).sweeps) {
    if (frequency.size() != 2) entry.fail("frequency", "expected [first, last], the frequencies of a sweep");
    if (frequency[0] == frequency[1]) entry.fail("frequency", "does not change; write type = \"sine\"");
    shake.last_frequency = frequency[1];
  } else if (frequency.size() != 1) {
    entry.fail("frequency", "a sine has one; a sweep goes from one to another");
  }
  shake.frequency = frequency[0];
}

double seconds(const AccelerogramComponent& component) {
  return static_cast<double>(component.samples.size()) * component.interval;
}

// The same length, or the same time from the first sample to the last, to half of the longer interval.
bool equally_long(const AccelerogramComponent& a, const AccelerogramComponent& b) {
  const double difference = seconds(a) - seconds(b), slack = std::max(a.interval, b.interval) / 2;
  return std::abs(difference) < slack || std::abs(difference - a.interval + b.interval) < slack;
}

std::string length_text(const AccelerogramComponent& component) {
  return short_number(seconds(component)) + " s (" + std::to_string(component.samples.size()) +
         " samples every " + short_number(component.interval) + " s)";
}

// The components of all files, in their order, along the directions.
std::vector<AccelerogramComponent> read_components(const Entry& entry, const ReadSceneFile& read,
                                                   std::vector<SceneFile>& files) {
  AccelerogramNotes notes{entry.text("unit"), std::nullopt};
  if (entry.has("dt")) notes.interval = entry.number("dt");
  const bool keep_mean = entry.has("mean") && entry.word("mean") == "kept";
  const bool without_mean = entry.word("mean") == "removed", parabola = entry.word("baseline") == "parabola";
  const std::vector<std::string> names = entry.texts("files");
  std::vector<AccelerogramComponent> components;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const int part = static_cast<int>(k);
    AccelerogramFile file;
    try {
      file = read_accelerogram(bytes_of(names[k], read, files), names[k], notes);
    } catch (const InputError& error) {
      entry.fail("files", error.what(), part);
    }
    if (keep_mean && file.format == AccelerogramFile::Format::knet)
      entry.fail("mean", "the counts of a K-NET file have an offset, so that their mean is always removed");
    for (std::vector<double>& samples : file.components) {
      if (without_mean) remove_mean(samples);
      if (parabola && samples.size() < 4) entry.fail("baseline", names[k] + " has fewer than 4 samples");
      if (parabola) subtract_parabola(samples);
      components.push_back({Vec3::UnitX(), file.interval, std::move(samples)});
      if (!equally_long(components.front(), components.back()))
        entry.fail("files",
                   names[k] + " lasts " + length_text(components.back()) + ", " + names[0] + " " +
                       length_text(components.front()) + "; the components of a record are equally long",
                   part);
    }
  }
  return components;
}

// The floor of a building whose ground moves as the shake, which is read but for this.
void read_building(const Entry& entry, Shake& shake) {
  const Entry building = entry.entry("building");
  std::vector<BuildingMode> modes;
  int storey = 0, of = 0;
  if (building.present()) {
    storey = building.integer("storey"), of = building.integer("of");
    if (storey > of)
      building.fail("storey", std::to_string(storey) + " is above the roof, floor " + std::to_string(of));
    if (entry.has("modes")) entry.fail("modes", "`building` says them; one of the two");
    modes = shear_building(storey, of, building.number("period"), building.number("damping"));
  }
  for (const Entry& mode : entry.entries("modes"))
    modes.push_back({mode.number("period"), mode.number("damping"), mode.number("factor")});
  if (modes.empty()) return;
  if (!put_in_building(std::move(modes), storey, of, shake))
    entry.fail(building.present() ? "building" : "modes",
               "its vibration takes more than " + std::to_string(k_most_floor_intervals) +
                   " intervals of time; less time, more damping or longer periods");
}

void read_record(const Entry& entry, const ReadSceneFile& read, Scene& scene, Shake& shake) {
  std::vector<AccelerogramComponent> components = read_components(entry, read, scene.files);
  const std::size_t count = components.size();
  if (count > 3) entry.fail("files", "hold " + std::to_string(count) + " components, a record has at most 3");
  std::vector<Vec3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (entry.has("directions")) {
    directions = entry.vectors("directions");
    if (directions.size() != count)
      entry.fail("directions", "found " + std::to_string(directions.size()) + ", the files hold " +
                                   std::to_string(count) + (count == 1 ? " component" : " components"));
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double length = directions[k].stableNorm();
    if (!(length > 0)) entry.fail("directions", "a zero vector has no direction", static_cast<int>(k));
    components[k].direction = directions[k] / length;
  }
  shake.record = make_accelerogram(std::move(components));
  shake.direction = shake.record->strongest;
  shake.scale = entry.number("scale");
}

}  // namespace

void read_shakes(const Entry& root, const ReadSceneFile& read, Scene& scene) {
  for (const Entry& entry : root.entries("shake")) {
    Shake shake;
    shake.kind = entry.chosen("type", shake_kinds());
    const ShakeTraits& uses = traits(shake.kind);
    shake.start = entry.number("start");
    shake.on = entry.flag("on");
    if (uses.has_amplitude) {
      shake.amplitude = entry.number("amplitude");
      shake.direction = entry.direction("direction");
    }
    if (uses.has_frequency) read_frequency(entry, shake);
    if (uses.steady && entry.has("cycles")) shake.cycles = entry.number("cycles");
    if (uses.steady) shake.initial_velocity = entry.chosen("initial_velocity", k_shake_starts);
    if (uses.has_duration) shake.duration = entry.number("duration");
    if (uses.has_frequency) read_taper(entry, shake);
    if (uses.has_shape) shake.shape = entry.chosen("shape", pulse_shapes());
    if (uses.has_record) read_record(entry, read, scene, shake);
    read_building(entry, shake);
    scene.setup.parameters.shakes.push_back(std::move(shake));
  }
}

}  // namespace topple::io
